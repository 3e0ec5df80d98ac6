// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "scene_options.h"

namespace gischt {

// Reads the command line into the context, whose `action` then runs the sub-command. A value is
// the exit status of what is done already: --help, --version. Throws Error{Usage}.
std::optional<int> parse(int argc, char** argv, CommandContext& context);

struct MergeOptions {
    std::vector<std::string> films, outputs;
};
struct CompareOptions {
    std::string a, b;
    std::optional<double> tolerance;  // of the RMSE
};
struct DenoiseOptions {
    std::string from, to;
    double exposure = 0;  // stops, of a .png
};
struct ConvertOptions {
    std::string from, to;
    std::string frames;    // of patterns
    double cell_size = 0;  // m, of particles that become a density; 0 chooses
    bool foreign = false;  // take points that other programs wrote
};
struct FlipbookOptions {
    SceneOptions scene;
    std::string grid, cell;  // AxB
    int loop = 0;
    std::vector<std::string> layers;
    bool premultiplied = false, fit = false;
    double light_scale = 1;
};
struct LadderOptions {
    SceneOptions scene;
    std::vector<std::string> methods;
    std::string reference = "path";
    int reference_spp = 0;
};
struct DocOptions {
    std::string address;
    bool markdown = false, json_schema = false;
};

// The sub-commands, each in a file of its own; they return the exit status.
int run_scene(const SceneOptions& options, CommandContext& context);
int simulate_scene(const SceneOptions& options, CommandContext& context);
int render_target(const SceneOptions& options, CommandContext& context);
int make_flipbook(const FlipbookOptions& options, CommandContext& context);
int make_ladder(const LadderOptions& options, CommandContext& context);
int check_scene(const SceneOptions& options, CommandContext& context);
int open_window(const SceneOptions& options, const CommandContext& context);
int print_info(const std::string& target, Job& job);
int merge_films(const MergeOptions& options, CommandContext& context);
int denoise_image(const DenoiseOptions& options, CommandContext& context);
int convert_volume(const ConvertOptions& options, CommandContext& context);
int compare_images(const CompareOptions& options);
int print_scenes(const std::string& name);
int print_doc(const DocOptions& options);
int print_methods();

}  // namespace gischt
