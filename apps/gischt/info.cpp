// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"
#include "commands.h"
#include "io/film_file.h"
#include "io/image_file.h"
#include "io/ply.h"
#include "io/vdb.h"
#include "scene/load.h"
#include "studio/cache.h"

namespace gischt {
namespace fs = std::filesystem;
namespace {

void print_volume(const std::string& path, Job& job) {
    const VdbInfo info = list_vdb(path, job);
    fmt::print("{}: OpenVDB file, format {}, library {}\n", path, info.format, info.library);
    for (const auto& [key, value] : info.metadata) fmt::print("  {} = {}\n", key, value);
    for (const VdbGridInfo& g : info.grids) {
        if (g.points >= 0) {
            fmt::print("  {:<14} {} points with {}\n", g.name, g.points,
                       fmt::join(g.attributes, ", "));
            continue;
        }
        fmt::print("  {:<14} {}{}, {}, {} active voxels", g.name, g.type,
                   g.is_half ? " (half)" : "", g.grid_class, g.active_voxels);
        if (g.active_voxels > 0) {
            fmt::print(", {}x{}x{} at {:g} m", g.hi[0] - g.lo[0] + 1, g.hi[1] - g.lo[1] + 1,
                       g.hi[2] - g.lo[2] + 1, g.voxel_size[0]);
        }
        if (g.min <= g.max) fmt::print(", {:g} to {:g}", g.min, g.max);
        fmt::print("{}\n", g.is_readable ? "" : "; left out: " + g.note);
    }
}

void print_particles(const std::string& path) {
    const Particles p = read_ply_particles(path);
    fmt::print("{}: {} points{}{}{}\n", path, p.size(), p.color.empty() ? "" : ", coloured",
               p.opacity.empty() ? "" : ", with opacity",
               p.temperature.empty() ? "" : ", with temperature");
    if (p.is_empty()) return;
    const Box3d b = p.bounds();
    fmt::print("  {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g} m\n", b.lo.x, b.lo.y, b.lo.z, b.hi.x,
               b.hi.y, b.hi.z);
}

void print_image(const std::string& path) {
    const Image image = read_image(path);
    fmt::print("{}: {}x{}, channels", path, image.width, image.height);
    for (const Channel& p : image.planes) fmt::print(" {}", p.name);
    fmt::print("\n");
    for (const auto& [key, value] : image.metadata.entries) fmt::print("  {} = {}\n", key, value);
}

void print_film(const std::string& path) {
    const FilmFile file = read_film(path);
    const Film& film = *file.state.film;
    fmt::print("{}: film of {}x{} pixels, samples {}{}\n", path, film.width(), film.height(),
               to_text(file.state.ranges), file.state.is_complete() ? "" : " (not all pixels)");
    fmt::print("  channels R G B A Z");
    for (const std::string& name : film.extra_names()) fmt::print(" {}", name);
    fmt::print("\n  noise {:.4g}, {} samples rejected\n", film.noise(), film.rejected());
    for (const auto& [key, value] : file.metadata.entries) fmt::print("  {} = {}\n", key, value);
}

void print_scene(const std::string& target) {
    const LoadedScene s = load_scene(target, "", {});
    fmt::print("{}: {}\n", s.name, s.scene.description);
    fmt::print("  frames {} to {} at {:g} per second, {} fluids, {} solids, {} lights\n",
               s.scene.frames.x, s.scene.frames.y, s.scene.fps, s.scene.fluids.size(),
               s.scene.solids.size(), s.scene.lights.size());
    fmt::print("  {}x{} pixels by {}, scene hash {}\n", s.scene.film.width, s.scene.film.height,
               s.scene.render.method, s.hash);
}

void print_cache(const fs::path& folder) {
    const LoadedScene scene = load_scene((folder / "scene.toml").string(), "", {});
    fmt::print("{}: frames of the scene {}\n", folder.string(), cache_name(folder));
    const std::vector<std::string> names = fluid_names(scene.scene);
    for (std::size_t f = 0; f < names.size(); ++f) {
        int count = 0;
        std::uintmax_t bytes = 0;
        for (const fs::directory_entry& e : fs::directory_iterator(folder)) {
            if (e.path().extension() != ".vdb" ||
                !e.path().stem().string().starts_with(names[f] + "_"))
                continue;
            ++count;
            bytes += e.file_size();
        }
        fmt::print("  {:<14} {} frames, {:.1f} MB\n", names[f], count,
                   static_cast<double>(bytes) * 1e-6);
    }
}

}  // namespace

int print_info(const std::string& target, Job& job) {
    const std::string extension = fs::path(target).extension().string();
    if (extension == ".vdb" || extension == ".nvdb")
        print_volume(target, job);
    else if (extension == ".ply")
        print_particles(target);
    else if (is_image_file(target))
        print_image(target);
    else if (is_film_file(target))
        print_film(target);
    else if (is_cache(target))
        print_cache(target);
    else
        print_scene(target);
    return 0;
}

}  // namespace gischt
