// SPDX-License-Identifier: Apache-2.0
#include "schema/toml.h"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/error.h"

namespace gischt {

namespace {

// Deeper than any scene, and far from what would exhaust the stack of a recursive reader.
constexpr int deepest = 100;

struct Converter {
    const std::string& name;

    Location place(const toml::source_region& source) const {
        return {name, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
    }

    [[noreturn]] void fail(const toml::source_region& source, const char* what) const {
        throw Error(ErrorKind::Usage, place(source).text(), what);
    }

    // toml++ sorts keys; their places in the text give the order back.
    Value table(const toml::table& from, int depth) const {
        Value::Members members;
        for (const auto& [key, node] : from) {
            members.push_back(
                {std::string(key.str()), convert(node, depth + 1), place(key.source())});
        }
        std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
            return std::pair(a.key_at.line, a.key_at.column) <
                   std::pair(b.key_at.line, b.key_at.column);
        });
        return members;
    }

    Value array(const toml::array& from, int depth) const {
        Value::Array elements;
        for (const toml::node& node : from) elements.push_back(convert(node, depth + 1));
        return elements;
    }

    Value convert(const toml::node& node, int depth) const {
        if (depth > deepest) fail(node.source(), "nested too deeply");
        Value value = content(node, depth);
        value.at = place(node.source());
        return value;
    }

    Value content(const toml::node& node, int depth) const {
        if (const auto* t = node.as_table()) return table(*t, depth);
        if (const auto* a = node.as_array()) return array(*a, depth);
        if (const auto* b = node.as_boolean()) return Value(b->get());
        if (const auto* i = node.as_integer()) return Value(i->get());
        if (const auto* d = node.as_floating_point()) return Value(d->get());
        if (const auto* s = node.as_string()) return Value(s->get());
        fail(node.source(), "dates and times have no use here");
    }
};

// toml++ limits how deeply brackets nest but not dotted keys, and would exhaust the stack on a
// long one. Counts dots outside strings and comments since the last character that ends a key.
void refuse_long_keys(std::string_view text, const std::string& name) {
    Location at{name, 1, 0};
    int dots = 0;
    char quote = 0;  // the quotation mark that ends the string we are in; 0 outside
    bool in_comment = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        ++at.column;
        if (c == '\n') {
            at = {name, at.line + 1, 0};
            dots = 0;
            quote = 0;
            in_comment = false;
        } else if (in_comment) {
            continue;
        } else if (quote) {
            if (c == quote) quote = 0;
            if (c == '\\' && quote == '"') ++i;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '#') {
            in_comment = true;
        } else if (std::string_view(",=[]{}").find(c) != std::string_view::npos) {
            dots = 0;
        } else if (c == '.' && ++dots > deepest) {
            throw Error(ErrorKind::Usage, at.text(), "nested too deeply");
        }
    }
}

}  // namespace

Value parse_toml(std::string_view text, const std::string& name) {
    refuse_long_keys(text, name);
    try {
        const toml::table document = toml::parse(text, std::string_view(name));
        Value root = Converter{name}.convert(document, 0);
        root.at = {name, 1, 1};
        return root;
    } catch (const toml::parse_error& e) {
        const Location at = Converter{name}.place(e.source());
        throw Error(ErrorKind::Usage, at.text(), std::string(e.description()));
    }
}

Value read_toml(const std::filesystem::path& path) {
    std::error_code ignored;
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path, ignored)) {
        throw Error(ErrorKind::Usage, path.string(), "cannot be opened",
                    "no such scene file, or no right to read it");
    }
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    if (file.bad()) throw Error(ErrorKind::Usage, path.string(), "cannot be read");
    return parse_toml(text, path.string());
}

}  // namespace gischt
