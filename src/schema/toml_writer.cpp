// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "schema/toml.h"

namespace gischt {

namespace {

std::string string_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string key_text(std::string_view key) {
    const auto is_bare = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), is_bare);
    return bare ? std::string(key) : string_text(key);
}

// The shortest text that reads back as the same double, with a point or exponent.
std::string real_text(double number) {
    if (std::isnan(number)) return "nan";
    if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
    std::string text = fmt::format("{}", number);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

template <class List, class TextOf>
std::string joined(const List& list, TextOf text_of) {
    std::string out;
    for (const auto& element : list) out += (out.empty() ? "" : ", ") + text_of(element);
    return out;
}

std::string inline_table(const Value::Members& members) {
    if (members.empty()) return "{}";
    const auto text_of = [](const Value::Member& m) {
        return key_text(m.key) + " = " + to_inline_toml(m.value);
    };
    return fmt::format("{{ {} }}", joined(members, text_of));
}

bool is_list_of_tables(const Value& value) {
    if (!value.is_array() || value.array().empty()) return false;
    return std::all_of(value.array().begin(), value.array().end(),
                       [](const Value& element) { return element.is_table(); });
}

// A value over time: as readable on one line as a number.
bool is_keyframes(const Value& value) {
    return value.is_table() && value.find("t") && value.find("v");
}

bool is_section(const Value& value) {
    return (value.is_table() && !is_keyframes(value)) || is_list_of_tables(value);
}

void write_table(std::string& out, const Value& table, const std::string& path) {
    for (const Value::Member& m : table.members()) {
        if (is_section(m.value)) continue;
        out += key_text(m.key) + " = " + to_inline_toml(m.value) + "\n";
    }
    for (const Value::Member& m : table.members()) {
        if (!is_section(m.value)) continue;
        const std::string name = (path.empty() ? "" : path + ".") + key_text(m.key);
        if (m.value.is_table()) {
            out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", name);
            write_table(out, m.value, name);
        } else {
            for (const Value& element : m.value.array()) {
                out += fmt::format("{}[[{}]]\n", out.empty() ? "" : "\n", name);
                write_table(out, element, name);
            }
        }
    }
}

}  // namespace

std::string to_inline_toml(const Value& value) {
    switch (value.kind()) {
        case Value::Kind::Boolean:
            return value.boolean() ? "true" : "false";
        case Value::Kind::Integer:
            return fmt::format("{}", value.integer());
        case Value::Kind::Real:
            return real_text(value.number());
        case Value::Kind::String:
            return string_text(value.string());
        case Value::Kind::Array:
            return fmt::format("[{}]", joined(value.array(), to_inline_toml));
        case Value::Kind::Table:
            return inline_table(value.members());
    }
    return {};
}

std::string to_toml(const Value& table) {
    std::string out;
    write_table(out, table, "");
    return out;
}

}  // namespace gischt
