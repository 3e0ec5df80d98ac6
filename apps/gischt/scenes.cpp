// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/error.h"
#include "commands.h"
#include "scene/builtin.h"
#include "scene/load.h"

namespace gischt {

int print_scenes(const std::string& name) {
    if (name.empty()) {
        for (const BuiltinScene& b : builtin_scenes()) {
            fmt::print("{:<12} {}\n", b.name, load_scene(b.name, "", {}).scene.description);
        }
        return 0;
    }
    const BuiltinScene* scene = find_builtin(name);
    if (!scene) {
        std::vector<std::string> names;
        for (const BuiltinScene& b : builtin_scenes()) names.push_back(b.name);
        throw Error(ErrorKind::Usage, "scenes", fmt::format("no built-in scene '{}'", name),
                    hint_for(name, names));
    }
    fmt::print("{}", scene->text);
    return 0;
}

}  // namespace gischt
