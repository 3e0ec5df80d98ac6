// SPDX-License-Identifier: Apache-2.0
#include "schema/value.h"

#include <fmt/format.h>

#include <array>

namespace gischt {

std::string Location::text() const {
    return line > 0 ? fmt::format("{}:{}:{}", file, line, column) : file;
}

Value::Value() : data_(Members{}) {}
Value::Value(bool value) : data_(value) {}
Value::Value(int value) : data_(std::int64_t{value}) {}
Value::Value(std::int64_t value) : data_(value) {}
Value::Value(double value) : data_(value) {}
Value::Value(const char* value) : data_(std::string(value)) {}
Value::Value(std::string value) : data_(std::move(value)) {}
Value::Value(Array elements) : data_(std::move(elements)) {}
Value::Value(Members members) : data_(std::move(members)) {}

std::string_view Value::describe() const {
    static constexpr std::array<std::string_view, 6> words = {
        "true or false", "a whole number", "a number", "a string", "a list", "a table"};
    return words[data_.index()];
}

double Value::number() const {
    return kind() == Kind::Integer ? static_cast<double>(integer()) : std::get<double>(data_);
}

const Value::Member* Value::member(std::string_view key) const {
    if (!is_table()) return nullptr;
    for (const Member& m : members()) {
        if (m.key == key) return &m;
    }
    return nullptr;
}

const Value* Value::find(std::string_view key) const {
    const Member* m = member(key);
    return m ? &m->value : nullptr;
}

Value* Value::find(std::string_view key) {
    return const_cast<Value*>(static_cast<const Value*>(this)->find(key));
}

Value& Value::set(std::string_view key, Value value, Location key_at) {
    for (Member& m : members()) {
        if (m.key != key) continue;
        m.key_at = std::move(key_at);
        return m.value = std::move(value);
    }
    return members()
        .emplace_back(Member{std::string(key), std::move(value), std::move(key_at)})
        .value;
}

void Value::relocate(const Location& place) {
    at = place;
    if (is_array()) {
        for (Value& element : array()) element.relocate(place);
    } else if (is_table()) {
        for (Member& m : members()) {
            m.key_at = place;
            m.value.relocate(place);
        }
    }
}

bool Value::operator==(const Value& other) const {
    return data_ == other.data_;
}

}  // namespace gischt
