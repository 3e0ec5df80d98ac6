// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace gischt {

// Where something was written: a line and column of a file (both from 1), or only a source such as
// "--set a.b=5" when line is 0.
struct Location {
    std::string file;
    int line = 0, column = 0;

    // "plume.toml:14:9", or the source alone; empty for a value made by the program.
    std::string text() const;
};

// What a scene file is before anybody gives it a meaning: a tree of plain values, each of which
// knows where it was written. A table keeps the order of its keys.
class Value {
  public:
    enum class Kind { Boolean, Integer, Real, String, Array, Table };
    struct Member;
    using Array = std::vector<Value>;
    using Members = std::vector<Member>;

    Value();  // an empty table
    Value(bool value);
    Value(int value);
    Value(std::int64_t value);
    Value(double value);
    Value(const char* value);
    Value(std::string value);
    Value(Array elements);
    Value(Members members);

    Kind kind() const { return static_cast<Kind>(data_.index()); }
    bool is_number() const { return kind() == Kind::Integer || kind() == Kind::Real; }
    bool is_string() const { return kind() == Kind::String; }
    bool is_array() const { return kind() == Kind::Array; }
    bool is_table() const { return kind() == Kind::Table; }
    // "a whole number", "a string", "a list": for messages.
    std::string_view describe() const;

    // The content; std::bad_variant_access when the kind is another. number() takes both kinds.
    bool boolean() const { return std::get<bool>(data_); }
    std::int64_t integer() const { return std::get<std::int64_t>(data_); }
    double number() const;
    const std::string& string() const { return std::get<std::string>(data_); }
    const Array& array() const { return std::get<Array>(data_); }
    Array& array() { return std::get<Array>(data_); }
    const Members& members() const { return std::get<Members>(data_); }
    Members& members() { return std::get<Members>(data_); }

    // The member of a table; null when there is none or this is no table.
    const Member* member(std::string_view key) const;
    const Value* find(std::string_view key) const;
    Value* find(std::string_view key);
    // Replaces or appends a member of a table.
    Value& set(std::string_view key, Value value, Location key_at = {});

    // Gives this value and all below it, keys included, one location.
    void relocate(const Location& place);

    // Equal content in equal order, wherever it was written; 1 and 1.0 differ.
    bool operator==(const Value& other) const;

    Location at;

  private:
    std::variant<bool, std::int64_t, double, std::string, Array, Members> data_;
};

struct Value::Member {
    std::string key;
    Value value;
    Location key_at;

    bool operator==(const Member& other) const { return key == other.key && value == other.value; }
};

}  // namespace gischt
