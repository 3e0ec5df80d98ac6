// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gischt {

// A scene with where it came from.
struct LoadedScene {
    std::string name;  // the file's stem or the built-in's name: names the output files
    Scene scene;
    std::string hash;          // of the whole scene, defaults spelled out
    std::string picture_hash;  // of all but what a finished film can still be given another:
                               // samples, exposure, tone, the range of frames
    std::string motion_hash;   // of what the simulation depends on: a cache belongs to it
    std::string toml;          // the scene with overrides, as a file
};

// Reads a scene file, or the built-in scene of that name where no such file is; applies a preset
// ("" for none) and then the overrides KEY=VALUE. `file` keys in a scene file count from its
// folder. Throws Error{Usage}.
LoadedScene load_scene(const std::string& file_or_name, const std::string& preset,
                       const std::vector<std::string>& overrides);

// The same from a tree of values that stands for a scene file, as of a bare volume.
LoadedScene load_scene_tree(const std::string& name, Value tree, const std::string& preset,
                            const std::vector<std::string>& overrides);

}  // namespace gischt
