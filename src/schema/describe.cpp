// SPDX-License-Identifier: Apache-2.0
#include "schema/describe.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "schema/toml.h"

namespace gischt {

std::string range_text(const ParameterOptions& o) {
    const bool below = std::isfinite(o.min), above = std::isfinite(o.max);
    std::string text;
    if (below && above && !o.min_open && !o.max_open) {
        text = fmt::format("from {} to {}", o.min, o.max);
    } else {
        if (below) text = fmt::format("{} {}", o.min_open ? "above" : "at least", o.min);
        if (below && above) text += " and ";
        if (above) text += fmt::format("{} {}", o.max_open ? "below" : "at most", o.max);
    }
    return text;
}

static std::string element_text(const ParameterForm& form, bool many) {
    switch (form.type) {
        case ParameterForm::Type::Boolean:
            return "true or false";
        case ParameterForm::Type::Integer:
            return many ? "whole numbers" : "whole number";
        case ParameterForm::Type::Real:
            return many ? "numbers" : "number";
        case ParameterForm::Type::String:
            return many ? "strings" : "string";
        case ParameterForm::Type::Choice:
            return "one word";
        case ParameterForm::Type::Table:
            return many ? "tables" : "table";
    }
    return {};
}

std::string type_text(const Parameter& parameter) {
    const ParameterForm& form = parameter.form;
    if (form.type == ParameterForm::Type::Choice) {
        std::string text;
        for (const ChoiceInfo& c : parameter.choices) text += (text.empty() ? "" : ", ") + c.word;
        return "one of " + text;
    }
    std::string text = element_text(form, form.count != 1 || form.list);
    if (form.count > 1) text = fmt::format("{} {}", form.count, text);
    if (form.list) text = (form.count > 1 ? "list of lists of " : "list of ") + text;
    if (parameter.options.broadcast) text += " or one";
    if (form.keyframable) text += " over time";
    return text;
}

std::string default_text(const Component& component, const Parameter& parameter) {
    if (parameter.options.required) return "required";
    const std::shared_ptr<void> object = component.make();
    const std::optional<Value> value = parameter.write(object.get());
    return value ? to_inline_toml(*value) : "unset";
}

}  // namespace gischt
