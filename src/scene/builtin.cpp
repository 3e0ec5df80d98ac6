// SPDX-License-Identifier: Apache-2.0
#include "scene/builtin.h"

#include <algorithm>

#include "scene/builtin_texts.h"

namespace gischt {

std::span<const BuiltinScene> builtin_scenes() {
    return builtin_texts();
}

const BuiltinScene* find_builtin(std::string_view name) {
    const auto scenes = builtin_scenes();
    const auto found = std::ranges::find(scenes, name, &BuiltinScene::name);
    return found == scenes.end() ? nullptr : &*found;
}

}  // namespace gischt
