// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "commands.h"

namespace gischt {
namespace fs = std::filesystem;

// Becomes the program of the window, which lies beside this one; else the shell's path is searched.
int open_window(const SceneOptions& options, const CommandContext& context) {
    std::error_code ignored;
    const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    const fs::path beside = here / "gischt-view";
    const std::string program = fs::exists(beside, ignored) ? beside.string() : "gischt-view";
    std::vector<std::string> words{program, options.target};
    const auto add = [&](const char* flag, const std::string& value) {
        if (!value.empty()) words.insert(words.end(), {flag, value});
    };
    add("--method", options.method);
    add("--preset", options.preset);
    add("--cache", options.cache);
    add("--size", options.size);
    for (const std::string& set : context.sets) add("--set", set);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execvp(program.c_str(), arguments.data());
    throw Error(ErrorKind::Usage, "view",
                std::string("the program gischt-view cannot be started: ") + std::strerror(errno),
                "install it beside gischt; it is built where GLFW and Dear ImGui are");
}

}  // namespace gischt
