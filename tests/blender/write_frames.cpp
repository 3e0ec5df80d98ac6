// SPDX-License-Identifier: Apache-2.0
// write_frames DIR: three frames with an asymmetric pattern, and expected.json with what a reader
// must find in them. Input of check_interchange.py.
#include <fmt/format.h>

#include <cstdio>
#include <fstream>

#include "io/vdb.h"

using namespace gischt;

namespace {

constexpr double h = 0.125;
const Vec3d origin{1, -2, 0.5};
const Vec3i cells{40, 24, 20};

// A smooth bump of radius 4 cells around `center` (cells), which leaves the field's border empty:
// then Sum f h^3 is the integral of any renderer that interpolates linearly, and the mean place of
// the cells' centres its centre.
float bump(const Vec3d& center, const Vec3i& c) {
    const double r = length(Vec3d(c) + Vec3d(0.5) - center) / 4;
    return r < 1 ? static_cast<float>((1 - r * r) * (1 - r * r)) : 0.0f;
}

// Two bumps, the second half as strong, so that no mirror image is alike.
float pattern(int frame, const Vec3i& c) {
    const double x = 7 + 4.0 * frame;
    return bump({x, 9, 6}, c) + 0.5f * bump({x + 9, 14, 11}, c);
}

template <class F>
Field make(int components, F&& value) {
    Field field;
    field.to_world = Transform::scale_translate(h, origin);
    const auto map = TileMap::box(cells);
    for (int a = 0; a < components; ++a) {
        field.component.emplace_back(map);
        for (int k = 0; k < cells.z; ++k) {
            for (int j = 0; j < cells.y; ++j) {
                for (int i = 0; i < cells.x; ++i) {
                    field.component.back().ref({i, j, k}) = value({i, j, k}, a);
                }
            }
        }
    }
    return field;
}

Frame make_frame(int number) {
    Frame frame;
    frame.number = number;
    frame.dt = 1 / 24.0;
    frame.time = (number - 1) * frame.dt;
    frame.metadata["scene_hash"] = "0123456789abcdef";
    const auto at = [number](const Vec3i& c, int) { return pattern(number, c); };
    frame.fields["density"] = make(1, at);
    frame.fields["flame"] = make(1, [&](const Vec3i& c, int a) { return 0.5f * at(c, a); });
    frame.fields["temperature"] = make(1, [&](const Vec3i& c, int a) { return 1000 * at(c, a); });
    frame.fields["velocity"] =
        make(3, [&](const Vec3i& c, int a) { return static_cast<float>(a + 1) * at(c, a); });
    return frame;
}

// Integral over space and centre of the first component.
std::string expected(const std::string& name, const Field& field) {
    double sum = 0;
    Vec3d moment;
    for (int k = 0; k < cells.z; ++k) {
        for (int j = 0; j < cells.y; ++j) {
            for (int i = 0; i < cells.x; ++i) {
                const double f = field.component[0].get({i, j, k});
                sum += f;
                moment += f * field.to_world.point(Vec3d(i + 0.5, j + 0.5, k + 0.5));
            }
        }
    }
    const Vec3d center = moment / sum;
    return fmt::format(R"("{}": {{"channels": {}, "integral": {}, "center": [{}, {}, {}]}})", name,
                       field.component.size(), sum * h * h * h, center.x, center.y, center.z);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: write_frames DIR\n", stderr);
        return 2;
    }
    const std::string folder = argv[1];
    Job job;
    std::string frames;
    for (int number = 1; number <= 3; ++number) {
        const Frame frame = make_frame(number);
        write_vdb(fmt::format("{}/frame_{:04}.vdb", folder, number), frame, {}, job);
        VdbWriteOptions corners;
        corners.half_voxel = false;
        write_vdb(fmt::format("{}/corner_{:04}.vdb", folder, number), frame, corners, job);
        std::string grids;
        for (const auto& [name, field] : frame.fields) {
            grids += (grids.empty() ? "" : ", ") + expected(name, field);
        }
        frames += fmt::format("{}\n  {{{}}}", number > 1 ? "," : "", grids);
    }
    std::ofstream(folder + "/expected.json")
        << fmt::format("{{\"voxel_size\": {}, \"first_center\": [{}, {}, {}], \"frames\": [{}]}}\n",
                       h, origin.x + h / 2, origin.y + h / 2, origin.z + h / 2, frames);
    return 0;
}
