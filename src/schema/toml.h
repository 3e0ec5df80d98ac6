// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "schema/value.h"

namespace gischt {

// TOML 1.0 to a table whose keys are in the order of the text. `name` stands in every Location.
// Throws Error{Usage, "name:line:column"} for bad syntax, a key given twice, dates (nothing here
// takes one) and nesting beyond 100 levels.
Value parse_toml(std::string_view text, const std::string& name);

// The file's content; the path as given stands in every Location. Throws Error{Usage} also when the
// file cannot be read: a scene that is not there is a bad scene.
Value read_toml(const std::filesystem::path& path);

// A table as TOML text: plain keys first, then [tables] and [[arrays of tables]]. parse_toml() of
// it gives an equal table, except that a table's plain keys move before its sub-tables.
std::string to_toml(const Value& table);

// Any value on one line: `5`, `[1, 2]`, `{ t = [0, 1] }`.
std::string to_inline_toml(const Value& value);

}  // namespace gischt
