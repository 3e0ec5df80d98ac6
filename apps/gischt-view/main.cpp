// SPDX-License-Identifier: Apache-2.0
// The window, a program of its own that `gischt view` starts: a machine without a display needs
// none of its libraries.
#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <string_view>

#include "../gischt/scene_options.h"
#include "base/error.h"
#include "window.h"

namespace gischt {
namespace {

struct Arguments {
    SceneOptions scene;
    std::vector<std::string> sets;
    Vec2i size{1280, 720};
};

Vec2i parse_size(const std::string& text) {
    Vec2i size;
    if (std::sscanf(text.c_str(), "%dx%d", &size.x, &size.y) != 2 || size.x < 64 || size.y < 64) {
        throw Error(ErrorKind::Usage, "--size", fmt::format("'{}' is no size of a window", text),
                    "write 1280x720; 64x64 is the least");
    }
    return size;
}

// The flags that `gischt view` hands on.
Arguments read_arguments(int argc, char** argv) {
    Arguments a;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        const auto value = [&]() -> std::string {
            if (i + 1 == argc) {
                throw Error(ErrorKind::Usage, std::string(word), "its value is missing");
            }
            return argv[++i];
        };
        if (word == "--set") {
            a.sets.push_back(value());
        } else if (word == "--method") {
            a.scene.method = value();
        } else if (word == "--preset") {
            a.scene.preset = value();
        } else if (word == "--cache") {
            a.scene.cache = value();
        } else if (word == "--size") {
            a.size = parse_size(value());
        } else if (word.starts_with("--") || !a.scene.target.empty()) {
            throw Error(ErrorKind::Usage, std::string(word), "is not known here",
                        "start it as `gischt view SCENE`; see `gischt view --help`");
        } else {
            a.scene.target = word;
        }
    }
    if (a.scene.target.empty()) {
        throw Error(ErrorKind::Usage, "view", "what to look at is missing",
                    "give a scene, a .vdb file or a cache");
    }
    return a;
}

int run(int argc, char** argv) {
    const Arguments a = read_arguments(argc, argv);
    const std::string method = a.scene.method;
    SceneOptions options = a.scene;
    options.method.clear();
    if (!method.empty()) (void)find_method(method);
    const SceneLoader loader = [options](const std::vector<std::string>& overrides, Job&) {
        CommandContext context;
        context.sets = overrides;
        return resolve(options, context).scene;
    };
    // Wrong names and files are told of here, before a window opens.
    CommandContext context;
    context.sets = a.sets;
    const ResolvedOptions first = resolve(options, context);
    Artist artist;
    Stage stage(loader, first.order.cache);
    if (!a.sets.empty()) stage.set_overrides(a.sets);
    Window window(stage, artist, {a.size, method, a.sets});
    window.run();
    return 0;
}

}  // namespace
}  // namespace gischt

int main(int argc, char** argv) {
    try {
        return gischt::run(argc, argv);
    } catch (const gischt::Error& e) {
        fmt::print(stderr, "{}\n", e.what());
        return e.kind() == gischt::ErrorKind::Usage      ? 2
               : e.kind() == gischt::ErrorKind::Input    ? 3
               : e.kind() == gischt::ErrorKind::Resource ? 4
                                                         : 1;
    } catch (const std::exception& e) {
        fmt::print(stderr, "gischt view: internal error: {}\n", e.what());
        return 1;
    }
}
