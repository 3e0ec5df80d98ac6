// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "command.h"
#include "scene/builtin.h"
#include "scene/load.h"

namespace gischt {

// gischt scenes [NAME]
void add_scenes(CLI::App& app, CommandContext& context) {
    auto name = std::make_shared<std::string>();
    CLI::App* sub =
        app.add_subcommand("scenes", "List the built-in scenes, or print one as a starting point");
    sub->add_option("NAME", *name, "A built-in scene");
    sub->callback([name, &context] {
        context.action = [name] {
            if (name->empty()) {
                for (const BuiltinScene& b : builtin_scenes()) {
                    fmt::print("{:<12} {}\n", b.name, load_scene(b.name, "", {}).scene.description);
                }
                return 0;
            }
            const BuiltinScene* scene = find_builtin(*name);
            if (!scene) {
                std::vector<std::string> names;
                for (const BuiltinScene& b : builtin_scenes()) names.push_back(b.name);
                throw Error(ErrorKind::Usage, "scenes",
                            fmt::format("no built-in scene '{}'", *name), hint_for(*name, names));
            }
            fmt::print("{}", scene->text);
            return 0;
        };
    });
}

}  // namespace gischt
