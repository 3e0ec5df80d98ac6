// SPDX-License-Identifier: Apache-2.0
#include "studio/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "io/atomic_file.h"
#include "studio/frame_range.h"

namespace gischt {
namespace fs = std::filesystem;

// The first lines of a cache's scene.toml.
static const std::string motion_mark = "# motion ", name_mark = "# scene ";

std::vector<std::string> fluid_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const FluidSection& f : scene.fluids) {
        std::string name = common_of(f).name.empty() ? "fluid" : common_of(f).name;
        const std::string base = name;
        for (int n = 2; std::ranges::find(names, name) != names.end(); ++n)
            name = base + std::to_string(n);
        names.push_back(name);
    }
    return names;
}

bool is_cache(const fs::path& folder) {
    std::error_code ignored;
    return fs::is_regular_file(folder / "scene.toml", ignored);
}

// What stands behind a mark at the head of a cache's scene.toml; empty where the mark is missing.
static std::string marked(const fs::path& folder, const std::string& mark) {
    std::ifstream in(folder / "scene.toml");
    for (std::string line; std::getline(in, line) && line.starts_with('#');) {
        if (line.starts_with(mark)) return line.substr(mark.size());
    }
    return "";
}

std::string cache_name(const fs::path& folder) {
    const std::string name = marked(folder, name_mark);
    return name.empty() ? "scene" : name;
}

// Removes frames and states of the scene's fluids, and nothing else.
static void remove_frames(const fs::path& folder, const std::vector<std::string>& names) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string(),
                          stem = entry.path().stem().string();
        for (const std::string& name : names) {
            const bool is_frame =
                extension == ".vdb" && stem.starts_with(name + "_") &&
                stem.find_first_not_of("0123456789", name.size() + 1) == std::string::npos;
            if (is_frame || (extension == ".state" && stem == name)) {
                fs::remove(entry.path());
                break;
            }
        }
    }
}

Cache::Cache(fs::path folder, const LoadedScene& scene, bool restart, bool keeps_scene)
    : folder_(std::move(folder)), names_(fluid_names(scene.scene)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error)
        throw Error(ErrorKind::Resource, folder_.string(),
                    "cannot make this folder: " + error.message());
    if (!keeps_scene || restart || !is_cache(folder_)) claim();
    if (is_cache(folder_)) {
        const std::string motion = marked(folder_, motion_mark);
        if (restart) {
            remove_frames(folder_, names_);
        } else if (motion != scene.motion_hash) {
            throw Error(ErrorKind::Usage, folder_.string(), "holds frames of another simulation",
                        "give another folder, or --restart to replace them");
        } else if (keeps_scene) {
            return;
        }
    }
    AtomicFile file((folder_ / "scene.toml").string());
    const std::string text =
        motion_mark + scene.motion_hash + "\n" + name_mark + scene.name + "\n" + scene.toml;
    file.write(std::span<const char>(text));
    file.commit();
}

void Cache::claim() const {
    if (lock_.is_held()) return;
    lock_ = CacheLock(folder_);
    remove_orphans(folder_);
}

fs::path Cache::vdb(std::size_t fluid, int frame) const {
    return frame_path(folder_ / (names_[fluid] + ".vdb"), frame);
}

fs::path Cache::state(std::size_t fluid) const {
    return folder_ / (names_[fluid] + ".state");
}

}  // namespace gischt
