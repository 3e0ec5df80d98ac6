// SPDX-License-Identifier: Apache-2.0
#include "schema/override.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>

#include "base/error.h"
#include "schema/toml.h"

namespace gischt {

namespace {

using Words = std::vector<std::string>;

// The words from one index to another with dots between them.
std::string path_text(const Words& words, std::size_t begin, std::size_t end) {
    return fmt::format("{}", fmt::join(words.data() + begin, words.data() + end, "."));
}

bool has(const Words& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
    return first == std::string_view::npos ? "" : std::string(text.substr(first, last + 1 - first));
}

bool has_name(const Value& member, const std::string& word) {
    const Value* name = member.find("name");
    return name && name->is_string() && name->string() == word;
}

// The name by which a member of a list is addressed: its own, or its index.
std::string member_word(const Value& member, std::size_t index) {
    const Value* name = member.find("name");
    return name && name->is_string() ? name->string() : std::to_string(index);
}

std::optional<std::size_t> index_of(const std::string& word) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return index;
}

// One assignment "a.b.c=VALUE" on its way into a tree.
class Override {
  public:
    explicit Override(std::string_view assignment);

    void apply(Value& scene, const Addressing& addressing);

  private:
    [[noreturn]] void fail(std::string fact, std::string hint = {}) const {
        throw Error(ErrorKind::Usage, source_.file, std::move(fact), std::move(hint));
    }
    void split(std::string_view path);
    void parse(std::string_view text);
    void prepend_implied_root(const Value& scene, const Addressing& addressing);
    bool belongs_to(const Value* members, const Addressing::Implied& implied) const;
    // The element of a list that words_[i] means; advances i when the word was spent on it.
    Value& element(Value& list, std::size_t& i) const;
    Value& only_element(Value& list, std::size_t i) const;

    Location source_;
    Words words_;
    Value value_;
};

Override::Override(std::string_view assignment) : source_{"--set " + std::string(assignment)} {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string_view::npos) fail("no '=' in an override", "write a.b.c=VALUE");
    split(assignment.substr(0, equals));
    parse(assignment.substr(equals + 1));
}

void Override::split(std::string_view path) {
    for (;;) {
        const std::size_t dot = path.find('.');
        words_.push_back(trimmed(path.substr(0, dot)));
        if (words_.back().empty()) fail("an empty word in the path", "write a.b.c=VALUE");
        if (dot == std::string_view::npos) return;
        path.remove_prefix(dot + 1);
    }
}

void Override::parse(std::string_view text) {
    const std::string word = trimmed(text);
    value_ = Value(word);
    const bool is_structure = word.find_first_of("[{\"'") == 0;
    const bool is_one_line = word.find('\n') == std::string::npos;
    if (!word.empty() && is_one_line) {
        try {
            value_ = *parse_toml("v = " + word, source_.file).find("v");
        } catch (const Error& e) {
            if (is_structure) fail(e.fact(), "the value is TOML: 5, [1, 2], \"text\", { t = [0] }");
        }
    }
    value_.relocate(source_);
}

bool Override::belongs_to(const Value* members, const Addressing::Implied& implied) const {
    if (has(implied.keys, words_.front())) return true;
    if (!members || words_.size() < 2) return false;
    const std::span<const Value> all =
        members->is_array() ? std::span(members->array()) : std::span(members, 1);
    return std::any_of(all.begin(), all.end(),
                       [&](const Value& member) { return has_name(member, words_.front()); });
}

void Override::prepend_implied_root(const Value& scene, const Addressing& addressing) {
    // A list of the scene's that it does not have gives way to a key of the same name in a member.
    const bool is_absent = has(addressing.lists, words_.front()) && !scene.find(words_.front());
    if (has(addressing.roots, words_.front()) && !is_absent) return;
    Words valid = addressing.roots;
    for (const Addressing::Implied& implied : addressing.implied) {
        const Value* members = scene.find(implied.root);
        if (belongs_to(members, implied)) {
            if (!members) {
                fail(fmt::format("'{}' belongs to a {}, and the scene has none", words_.front(),
                                 implied.root));
            }
            words_.insert(words_.begin(), implied.root);
            return;
        }
        valid.insert(valid.end(), implied.keys.begin(), implied.keys.end());
    }
    if (is_absent) return;
    fail(fmt::format("unknown key '{}'", words_.front()), hint_for(words_.front(), valid));
}

Value& Override::only_element(Value& list, std::size_t i) const {
    Value::Array& all = list.array();
    const std::string path = path_text(words_, 0, i);
    Words names;
    for (std::size_t k = 0; k < all.size(); ++k) names.push_back(member_word(all[k], k));
    if (all.size() == 1 && all[0].is_table()) return all[0];
    if (all.empty()) fail(fmt::format("'{}' is an empty list", path));
    if (!all[0].is_table()) {
        fail(fmt::format("'{}' is a list, and '{}' no index of it", path, words_[i]),
             fmt::format("valid: 0 to {}", all.size() - 1));
    }
    const std::string near = nearest_word(words_[i], names);
    fail(fmt::format("'{}' has {} members, and '{}' is the name of none", path, all.size(),
                     words_[i]),
         near.empty() ? fmt::format("write {}.NAME.{}, where NAME is one of {}", path,
                                    path_text(words_, i, words_.size()), fmt::join(names, ", "))
                      : fmt::format("did you mean '{}'?", near));
}

Value& Override::element(Value& list, std::size_t& i) const {
    Value::Array& all = list.array();
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (!has_name(all[k], words_[i])) continue;
        ++i;
        return all[k];
    }
    const std::optional<std::size_t> index = index_of(words_[i]);
    if (!index) return only_element(list, i);
    if (*index >= all.size()) {
        fail(fmt::format("'{}' has no member {}", path_text(words_, 0, i), *index),
             all.empty() ? "it is empty" : fmt::format("valid: 0 to {}", all.size() - 1));
    }
    ++i;
    return all[*index];
}

void Override::apply(Value& scene, const Addressing& addressing) {
    prepend_implied_root(scene, addressing);
    Value* node = &scene;
    for (std::size_t i = 0; i < words_.size();) {
        if (node->is_array()) {
            node = &element(*node, i);
            continue;
        }
        if (!node->is_table()) {
            fail(fmt::format("'{}' is {} and has no '{}'", path_text(words_, 0, i),
                             node->describe(), words_[i]));
        }
        // [fluid] is a list of one: its own name, or 0, may stand before its keys.
        const bool is_last = i + 1 == words_.size();
        Value* next = node->find(words_[i]);
        const bool names_itself =
            i > 0 && !is_last && !next && (has_name(*node, words_[i]) || words_[i] == "0");
        if (!names_itself) {
            if (!next) {
                next = &node->set(words_[i], Value(), source_);
                next->at = source_;
            }
            node = next;
        }
        ++i;
    }
    *node = value_;
}

void add_keys(Words& keys, const Component& component) {
    for (const Parameter& p : component.parameters) {
        if (!has(keys, p.key)) keys.push_back(p.key);
    }
    if (!component.alternatives.empty()) keys.push_back(component.selector);
    for (const Alternative& a : component.alternatives) add_keys(keys, *a.component);
}

}  // namespace

Addressing addressing_of(const Component& scene, const std::vector<std::string>& implied_roots) {
    Addressing addressing;
    add_keys(addressing.roots, scene);
    for (const Parameter& p : scene.parameters) {
        if (p.form.list && p.component) addressing.lists.push_back(p.key);
    }
    for (const std::string& root : implied_roots) {
        Words keys;
        const Parameter* p = scene.find(root);
        if (p && p->component) add_keys(keys, *p->component);
        addressing.implied.push_back({root, keys});
    }
    return addressing;
}

void apply_override(Value& scene, std::string_view assignment, const Addressing& addressing) {
    Override(assignment).apply(scene, addressing);
}

}  // namespace gischt
