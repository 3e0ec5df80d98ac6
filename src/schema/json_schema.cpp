// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "schema/doc.h"

namespace gischt {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Value& value) {
    switch (value.kind()) {
        case Value::Kind::Boolean:
            return value.boolean();
        case Value::Kind::Integer:
            return value.integer();
        case Value::Kind::Real:
            return value.number();
        case Value::Kind::String:
            return value.string();
        case Value::Kind::Array:
            break;
        case Value::Kind::Table:
            break;
    }
    if (value.is_array()) {
        Json out = Json::array();
        for (const Value& element : value.array()) out.push_back(to_json(element));
        return out;
    }
    Json out = Json::object();
    for (const Value::Member& m : value.members()) out[m.key] = to_json(m.value);
    return out;
}

Json array_of(const Json& items) {
    return {{"type", "array"}, {"items", items}};
}

Json number_schema(const Parameter& p) {
    const ParameterOptions& o = p.options;
    Json out = {{"type", p.form.type == ParameterForm::Type::Integer ? "integer" : "number"}};
    if (std::isfinite(o.min)) out[o.min_open ? "exclusiveMinimum" : "minimum"] = o.min;
    if (std::isfinite(o.max)) out[o.max_open ? "exclusiveMaximum" : "maximum"] = o.max;
    return out;
}

Json scalar_schema(const Parameter& p) {
    switch (p.form.type) {
        case ParameterForm::Type::Boolean:
            return {{"type", "boolean"}};
        case ParameterForm::Type::Integer:
        case ParameterForm::Type::Real:
            return number_schema(p);
        case ParameterForm::Type::String:
            return {{"type", "string"}};
        case ParameterForm::Type::Choice:
            break;
        case ParameterForm::Type::Table:
            break;
    }
    Json words = Json::array();
    for (const ChoiceInfo& c : p.choices) words.push_back(c.word);
    return {{"enum", words}};
}

// A vector, or with `broadcast` also one number.
Json vector_schema(const Parameter& p) {
    const Json scalar = scalar_schema(p);
    if (p.form.count == 1) return scalar;
    Json out = array_of(scalar);
    out["minItems"] = out["maxItems"] = p.form.count;
    if (p.options.broadcast) out = {{"anyOf", {scalar, out}}};
    return out;
}

Json keyframes_schema(const Json& element) {
    return {{"type", "object"},
            {"properties",
             {{"t", array_of({{"type", "number"}})},
              {"v", array_of(element)},
              {"interpolation", {{"enum", {"step", "linear", "smooth"}}}}}},
            {"required", {"t", "v"}},
            {"additionalProperties", false}};
}

// Collects one definition per component, and a second one with `name` for elements of lists.
class Writer {
  public:
    Json document(const Component& root) {
        Json out = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
        out.update(reference(root, false));
        out["$defs"] = definitions_;
        return out;
    }

  private:
    Json reference(const Component& component, bool is_element) {
        const auto key = std::pair(&component, is_element);
        auto found = names_.find(key);
        if (found == names_.end()) {
            std::string name = component.name + (is_element ? "_element" : "");
            while (definitions_.contains(name)) name += "_";
            definitions_[name] = Json::object();
            found = names_.emplace(key, name).first;
            Json made = definition(component, is_element);
            definitions_[name] = std::move(made);
        }
        return {{"$ref", "#/$defs/" + found->second}};
    }

    Json definition(const Component& component, bool is_element) {
        if (component.alternatives.empty()) return object_schema(component, is_element);
        Json options = Json::array();
        for (const Alternative& a : component.alternatives) {
            Json option = object_schema(*a.component, is_element);
            option["properties"][component.selector] = {{"const", a.word}};
            if (is_element) option["required"].push_back(component.selector);
            options.push_back(std::move(option));
        }
        return {{"description", component.help}, {"anyOf", options}};
    }

    Json object_schema(const Component& component, bool is_element) {
        Json properties = Json::object(), required = Json::array();
        if (is_element) properties["name"] = {{"type", "string"}};
        const std::shared_ptr<void> defaults = component.make();
        for (const Parameter& p : component.parameters) {
            properties[p.key] = parameter_schema(p, defaults.get());
            if (p.options.required) required.push_back(p.key);
        }
        return {{"type", "object"},
                {"description", component.help},
                {"properties", properties},
                {"required", required},
                {"additionalProperties", false}};
    }

    Json parameter_schema(const Parameter& p, const void* defaults) {
        Json out;
        if (p.component) {
            const Json one = reference(*p.component, p.form.list);
            out = p.form.list ? Json{{"anyOf", {array_of(one), one}}} : one;
        } else {
            out = vector_schema(p);
            if (p.form.list) out = array_of(out);
            if (p.form.keyframable) out = {{"anyOf", {out, keyframes_schema(out)}}};
        }
        std::string help = p.options.help;
        if (!p.options.unit.empty()) {
            help += fmt::format("{}[{}]", help.empty() ? "" : " ", p.options.unit);
        }
        if (!help.empty()) out["description"] = help;
        if (p.component || p.options.required) return out;
        if (const std::optional<Value> value = p.write(defaults)) out["default"] = to_json(*value);
        return out;
    }

    std::map<std::pair<const Component*, bool>, std::string> names_;
    Json definitions_ = Json::object();
};

}  // namespace

std::string json_schema(const Component& root) {
    return Writer().document(root).dump(2) + "\n";
}

}  // namespace gischt
