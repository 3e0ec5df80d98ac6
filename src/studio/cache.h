// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/load.h"
#include "studio/cache_lock.h"

namespace gischt {

// A folder that keeps what a simulation yields: NAME_0001.vdb per frame and fluid, NAME.state to go
// on from, and scene.toml, the scene with its overrides, whose first line names the motion that the
// frames belong to.
class Cache {
  public:
    // Opens or makes the folder. Frames of the same motion are kept and used; `restart` removes
    // them. Throws Error{Usage} when the folder holds frames of another motion, Error{Resource}
    // when it cannot be written. With `keeps_scene` the scene that lies in it stays: who looks at a
    // cache in another light does not change it, and shares it with others until a frame is
    // missing. Else the cache is this process's alone from here on: Error{Usage} while another one
    // has it.
    Cache(std::filesystem::path folder, const LoadedScene& scene, bool restart,
          bool keeps_scene = false);

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path vdb(std::size_t fluid, int frame) const;
    std::filesystem::path state(std::size_t fluid) const;

    // To be called before anything is written: makes the cache this process's alone while this
    // object lives, and removes what killed processes left half written. Throws what CacheLock()
    // does.
    void claim() const;

  private:
    std::filesystem::path folder_;
    mutable CacheLock lock_;
    std::vector<std::string> names_;  // of the fluids, unique
};

// Whether the folder is a cache: holds a scene.toml.
bool is_cache(const std::filesystem::path& folder);

// The name of the scene that a cache was made from.
std::string cache_name(const std::filesystem::path& folder);

// Unique names for the fluids of a scene: their own, else "fluid", "fluid2" ...
std::vector<std::string> fluid_names(const Scene& scene);

}  // namespace gischt
