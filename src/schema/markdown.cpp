// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "schema/describe.h"
#include "schema/doc.h"

namespace gischt {

namespace {

// A cell of a Markdown table: no bar may end it early.
std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '|') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out;
}

std::string code(std::string_view text) {
    return text.empty() ? "" : fmt::format("`{}`", cell(text));
}

std::string meaning(const Parameter& p) {
    std::string text = p.options.help;
    for (const ChoiceInfo& c : p.choices) {
        text += fmt::format("{}{}{}", text.empty() ? "" : "; ", code(c.word),
                            c.help.empty() ? "" : ": " + c.help);
    }
    return cell(text);
}

std::string row(const Component& component, const Parameter& p) {
    std::string type = p.form.type == ParameterForm::Type::Choice ? "word" : type_text(p);
    std::string standard;
    if (p.component) {
        type += fmt::format(" [{0}](#{0})", p.component->name);
        if (p.options.required) standard = "required";
    } else {
        standard = default_text(component, p);
        if (standard != "unset" && standard != "required") standard = code(standard);
    }
    return fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(p.key), type, cell(p.options.unit),
                       standard, range_text(p.options), meaning(p));
}

std::string section(const Component& component) {
    std::string out = fmt::format("## {}\n\n", component.name);
    if (!component.help.empty()) out += component.help + ".\n\n";
    if (!component.alternatives.empty()) {
        out += fmt::format("| {} | keys | meaning |\n|---|---|---|\n", code(component.selector));
        for (const Alternative& a : component.alternatives) {
            out += fmt::format("| {0} | [{1}](#{1}) | {2} |\n", code(a.word), a.component->name,
                               cell(a.component->help));
        }
        return out;
    }
    out += "| key | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
    for (const Parameter& p : component.parameters) out += row(component, p);
    return out;
}

}  // namespace

std::string markdown(const Component& root) {
    std::string out;
    for (const Component* c : all_components(root)) {
        if (!out.empty()) out += "\n";
        out += section(*c);
    }
    return out;
}

}  // namespace gischt
