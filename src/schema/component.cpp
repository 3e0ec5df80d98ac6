// SPDX-License-Identifier: Apache-2.0
#include "schema/component.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"

namespace gischt {

namespace {

std::string in_table(const std::string& path) {
    return path.empty() ? " at the top level" : fmt::format(" in [{}]", path);
}

std::string named(std::string_view key, const std::string& path) {
    return path.empty() ? fmt::format("'{}'", key) : fmt::format("'{}' in [{}]", key, path);
}

[[noreturn]] void fail_at(const Location& at, std::string fact, std::string hint = {}) {
    throw Error(ErrorKind::Usage, at.text(), std::move(fact), std::move(hint));
}

[[noreturn]] void fail_string(const Value& value, std::string_view key, const std::string& path) {
    fail_at(value.at,
            fmt::format("{} must be a string, not {}", named(key, path), value.describe()));
}

std::string missing(std::string_view key, const std::string& path) {
    return fmt::format("key '{}' is missing{}", key, in_table(path));
}

std::vector<std::string> words_of(const std::vector<Alternative>& alternatives) {
    std::vector<std::string> words;
    for (const Alternative& a : alternatives) words.push_back(a.word);
    return words;
}

void refuse_unknown_keys(const Component& component, const Value& table, const std::string& path,
                         const std::vector<std::string>& also_allowed) {
    std::vector<std::string> valid;
    for (const Parameter& p : component.parameters) valid.push_back(p.key);
    for (const std::string& key : also_allowed) {
        if (!component.find(key)) valid.push_back(key);
    }
    for (const Value::Member& m : table.members()) {
        if (std::find(valid.begin(), valid.end(), m.key) != valid.end()) continue;
        fail_at(m.key_at, fmt::format("unknown key '{}'{}", m.key, in_table(path)),
                hint_for(m.key, valid));
    }
}

void read_parameters(const Component& component, void* object, const Value& table,
                     const std::string& path) {
    for (const Parameter& p : component.parameters) {
        if (const Value* value = table.find(p.key)) {
            p.read(object, *value, Place{path, p});
        } else if (p.options.required) {
            fail_at(table.at, missing(p.key, path), p.options.help);
        }
    }
}

// The alternative that the selector names or, without it, the one that the object holds.
const Alternative& choose(const Component& component, const void* object, const Value& table,
                          const std::string& path) {
    if (const Value* word = table.find(component.selector)) {
        if (!word->is_string()) fail_string(*word, component.selector, path);
        if (const Alternative* a = component.find_alternative(word->string())) return *a;
        fail_at(
            word->at,
            fmt::format("unknown {} '{}'{}", component.selector, word->string(), in_table(path)),
            hint_for(word->string(), words_of(component.alternatives)));
    }
    for (const Alternative& a : component.alternatives) {
        if (a.held(object)) return a;
    }
    throw Error(ErrorKind::Internal, component.name, "its default is none of its alternatives");
}

void refuse_equal_names(const std::vector<const Value*>& elements, const std::string& path) {
    std::map<std::string, Location> names;
    for (const Value* element : elements) {
        const Value* name = element->find("name");
        if (!name) continue;
        if (!name->is_string()) fail_string(*name, "name", path);
        const auto [first, is_new] = names.emplace(name->string(), name->at);
        if (is_new) continue;
        fail_at(name->at,
                fmt::format("there are two of the name '{}'{}", name->string(), in_table(path)),
                "the first is at " + first->second.text());
    }
}

}  // namespace

void Place::fail(const Location& at, std::string_view fact, std::string hint) const {
    fail_at(at, fmt::format("{} {}", named(parameter.key, table), fact), std::move(hint));
}

void Fail::operator()(std::string_view key, std::string_view fact, std::string hint) const {
    const Value* value = key.empty() ? nullptr : table_.find(key);
    const std::string subject = key.empty() ? fmt::format("[{}]", path_) : named(key, path_);
    fail_at(value ? value->at : table_.at, fmt::format("{} {}", subject, fact), std::move(hint));
}

const Parameter* Component::find(std::string_view key) const {
    for (const Parameter& p : parameters) {
        if (p.key == key) return &p;
    }
    return nullptr;
}

const Alternative* Component::find_alternative(std::string_view word) const {
    for (const Alternative& a : alternatives) {
        if (a.word == word) return &a;
    }
    return nullptr;
}

void Component::append(Parameter parameter) {
    if (find(parameter.key)) {
        throw Error(ErrorKind::Internal, name, "key '" + parameter.key + "' is declared twice");
    }
    parameters.push_back(std::move(parameter));
}

void Component::adopt(const Component& part, std::function<void*(void*)> piece_of) {
    const auto const_piece_of = [piece_of](const void* object) -> const void* {
        return piece_of(const_cast<void*>(object));
    };
    for (Parameter p : part.parameters) {
        p.read = [inner = p.read, piece_of](void* object, const Value& value, const Place& place) {
            inner(piece_of(object), value, place);
        };
        p.write = [inner = p.write, const_piece_of](const void* object) {
            return inner(const_piece_of(object));
        };
        append(std::move(p));
    }
    for (const auto& inner : part.checks) {
        checks.push_back([inner, const_piece_of](const void* object, const Fail& fail) {
            inner(const_piece_of(object), fail);
        });
    }
}

void read_component(const Component& component, void* object, const Value& value,
                    const std::string& path, const std::vector<std::string>& also_allowed) {
    if (!value.is_table()) {
        fail_at(value.at, fmt::format("'{}' must be a table, not {}", path, value.describe()));
    }
    if (!component.alternatives.empty()) {
        const Alternative& chosen = choose(component, object, value, path);
        std::vector<std::string> allowed = also_allowed;
        allowed.push_back(component.selector);
        read_component(*chosen.component, chosen.select(object), value, path, allowed);
        return;
    }
    refuse_unknown_keys(component, value, path, also_allowed);
    read_parameters(component, object, value, path);
    for (const auto& check : component.checks) check(object, Fail(value, path));
}

Value write_component(const Component& component, const void* object) {
    Value table;
    for (const Alternative& a : component.alternatives) {
        const void* held = a.held(object);
        if (!held) continue;
        table = write_component(*a.component, held);
        Value::Members& members = table.members();
        members.insert(members.begin(), {component.selector, Value(a.word), {}});
    }
    for (const Parameter& p : component.parameters) {
        if (std::optional<Value> value = p.write(object)) table.set(p.key, std::move(*value));
    }
    return table;
}

std::vector<const Value*> list_elements(const Value& value, const Place& place) {
    std::vector<const Value*> elements;
    if (value.is_table()) {
        elements.push_back(&value);
    } else if (value.is_array()) {
        for (const Value& element : value.array()) elements.push_back(&element);
    } else {
        place.fail(value.at, fmt::format("must be a list of tables, not {}", value.describe()));
    }
    const Component& component = *place.parameter.component;
    const std::string path = join_path(place.table, place.parameter.key);
    for (const Value* element : elements) {
        if (!element->is_table()) {
            place.fail(element->at,
                       fmt::format("must be a list of tables, not of {}", element->describe()));
        }
        if (!component.alternatives.empty() && !element->find(component.selector)) {
            fail_at(element->at, missing(component.selector, path),
                    hint_for("", words_of(component.alternatives)));
        }
    }
    refuse_equal_names(elements, path);
    return elements;
}

std::string join_path(std::string_view table, std::string_view key) {
    return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

}  // namespace gischt
