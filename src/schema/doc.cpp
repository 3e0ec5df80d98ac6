// SPDX-License-Identifier: Apache-2.0
#include "schema/doc.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "schema/describe.h"

namespace gischt {

namespace {

constexpr std::size_t columns = 100;

// `text` behind `label`, wrapped to the terminal with a hanging indent.
std::string entry(std::string_view label, std::size_t indent, std::string_view text) {
    std::string out, line = fmt::format("{:<{}}", label, indent);
    bool empty = true;
    while (!text.empty()) {
        const std::size_t space = text.find(' ');
        const std::string_view word = text.substr(0, space);
        if (!empty && line.size() + 1 + word.size() > columns) {
            out += line + "\n";
            line = std::string(indent, ' ');
            empty = true;
        }
        if (!empty) line += ' ';
        line += word;
        empty = false;
        text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    }
    return out + line + "\n";
}

// "number over time, m/s^2, default 1.0, at least 0".
std::string facts(const Component& component, const Parameter& p) {
    std::string text = p.form.type == ParameterForm::Type::Choice ? "word" : type_text(p);
    if (p.component) text += fmt::format(" [{}]", p.component->name);
    if (!p.options.unit.empty()) text += ", " + p.options.unit;
    const std::string standard = default_text(component, p);
    if (!p.component) {
        text += (p.options.required || standard == "unset" ? ", " : ", default ") + standard;
    } else if (p.options.required) {
        text += ", required";
    }
    const std::string range = range_text(p.options);
    return range.empty() ? text : text + ", " + range;
}

std::string key_entry(const Component& component, const Parameter& p, std::size_t indent) {
    std::string out = entry("  " + p.key, indent, facts(component, p));
    if (!p.options.help.empty()) out += entry("", indent, p.options.help);
    std::size_t word_width = 0;
    for (const ChoiceInfo& c : p.choices) word_width = std::max(word_width, c.word.size());
    for (const ChoiceInfo& c : p.choices) {
        const std::string label = fmt::format("{:<{}}{}", "", indent + 2, c.word);
        out += entry(label, indent + 2 + word_width + 2, c.help);
    }
    return out;
}

std::string title(const Component& component) {
    return component.help.empty() ? fmt::format("[{}]\n", component.name)
                                  : fmt::format("[{}] {}\n", component.name, component.help);
}

void collect(const Component& component, std::vector<const Component*>& found) {
    if (std::find(found.begin(), found.end(), &component) != found.end()) return;
    found.push_back(&component);
    for (const Alternative& a : component.alternatives) collect(*a.component, found);
    for (const Parameter& p : component.parameters) {
        if (p.component) collect(*p.component, found);
    }
}

std::string overview(const Component& root) {
    std::size_t indent = 0;
    for (const Component* c : all_components(root)) indent = std::max(indent, c->name.size());
    std::string out;
    for (const Component* c : all_components(root))
        out += entry("  " + c->name, indent + 4, c->help);
    return out;
}

// What a word of an address names within a component: a key, or a component's alternative.
struct Found {
    const Component* component{};
    const Parameter* parameter{};  // null: the component itself
};

std::vector<std::string> words_within(const Component& component) {
    std::vector<std::string> words;
    for (const Parameter& p : component.parameters) words.push_back(p.key);
    for (const Alternative& a : component.alternatives) words.push_back(a.word);
    return words;
}

Found within(const Component& component, const std::string& word) {
    if (const Parameter* p = component.find(word)) return {&component, p};
    if (const Alternative* a = component.find_alternative(word)) return {a->component, nullptr};
    for (const Alternative& a : component.alternatives) {
        if (const Found found = within(*a.component, word); found.component) return found;
    }
    return {};
}

// The first word of an address: a component's name before a key of the root.
Found find_start(const Component& root, const std::string& word) {
    const std::vector<const Component*> components = all_components(root);
    for (const Component* c : components) {
        if (c->name == word) return {c, nullptr};
    }
    const Found found = within(root, word);
    if (found.component) return found;
    std::vector<std::string> valid = words_within(root);
    for (const Component* c : components) {
        if (std::find(valid.begin(), valid.end(), c->name) == valid.end()) valid.push_back(c->name);
    }
    throw Error(ErrorKind::Usage, "", fmt::format("no component or key '{}'", word),
                hint_for(word, valid));
}

// The next word of an address, within what was found so far.
Found step(const Found& from, const std::string& word) {
    const Component* table = from.parameter ? from.parameter->component : from.component;
    if (!table) {
        throw Error(ErrorKind::Usage, "", fmt::format("'{}' has no keys", from.parameter->key));
    }
    const Found found = within(*table, word);
    if (found.component) return found;
    throw Error(ErrorKind::Usage, "", fmt::format("no key '{}' in [{}]", word, table->name),
                hint_for(word, words_within(*table)));
}

Found find_address(const Component& root, std::string_view address) {
    Found found;
    for (std::string_view rest = address; !rest.empty();) {
        const std::size_t dot = rest.find('.');
        const std::string word(rest.substr(0, dot));
        rest.remove_prefix(dot == std::string_view::npos ? rest.size() : dot + 1);
        found = found.component ? step(found, word) : find_start(root, word);
    }
    return found;
}

}  // namespace

std::vector<const Component*> all_components(const Component& root) {
    std::vector<const Component*> found;
    collect(root, found);
    return found;
}

std::string document(const Component& component) {
    std::string out = title(component);
    if (!component.alternatives.empty()) {
        std::size_t indent = 0;
        for (const Alternative& a : component.alternatives)
            indent = std::max(indent, a.word.size());
        out += fmt::format("  The key '{}' chooses one of\n", component.selector);
        for (const Alternative& a : component.alternatives) {
            out += entry("    " + a.word, indent + 6, a.component->help);
        }
        for (const Alternative& a : component.alternatives) {
            out += "\n";
            out += document(*a.component);
        }
        return out;
    }
    std::size_t indent = 0;
    for (const Parameter& p : component.parameters) indent = std::max(indent, p.key.size());
    for (const Parameter& p : component.parameters) out += key_entry(component, p, indent + 4);
    return out;
}

std::string document(const Component& root, std::string_view address) {
    if (address.empty()) return overview(root);
    const Found found = find_address(root, address);
    if (!found.parameter) return document(*found.component);
    const Parameter& p = *found.parameter;
    std::string out = key_entry(*found.component, p, p.key.size() + 4);
    if (!p.component) return out;
    out += "\n";
    return out += document(*p.component);
}

}  // namespace gischt
