// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gischt {

// A scene that the program carries: scenes/NAME.toml, put in by the build.
struct BuiltinScene {
    std::string name;
    std::string text;  // TOML
};

std::span<const BuiltinScene> builtin_scenes();
// Null when there is none of that name.
const BuiltinScene* find_builtin(std::string_view name);

}  // namespace gischt
