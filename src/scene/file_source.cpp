// SPDX-License-Identifier: Apache-2.0
#include "scene/file_source.h"

#include <fmt/format.h>

#include "base/error.h"
#include "io/ply.h"

namespace gischt {

const Table<FileParams>& file_table() {
    using P = FileParams;
    static const Table<P> table =
        Table<P>("file", "VDB files made elsewhere, or by gischt; or particles in PLY files")
            .add("file", &P::file,
                 {.help =
                      "Path of the .vdb or .ply file; '####' or '%04d' stands for the frame number",
                  .required = true})
            .add("frame_offset", &P::frame_offset, {.help = "Added to the scene's frame number"})
            .choice("half_voxel", &P::half_voxel,
                    {{"auto", HalfVoxel::Auto, "centre for Blender's fluid caches, else follow"},
                     {"follow", HalfVoxel::Follow,
                      "the transform places sample (i,j,k), as OpenVDB defines it"},
                     {"center", HalfVoxel::Center,
                      "the transform places cell corners: samples lie half a voxel further"}},
                    {.help = "Where the file's samples lie"})
            .sub("points", &P::points, file_points_table(), {.help = "Particles in it"});
    return table;
}

// Replaces the `length` characters at `at` by the number with leading zeros.
static std::string filled(const std::string& pattern, std::size_t at, std::size_t length,
                          std::size_t digits, int number) {
    return pattern.substr(0, at) + fmt::format("{:0{}}", number, digits) +
           pattern.substr(at + length);
}

std::string file_of_frame(const FileParams& params, int frame) {
    const std::string& p = params.file;
    const int number = frame + params.frame_offset;
    if (const std::size_t at = p.find('#'); at != std::string::npos) {
        const std::size_t end = p.find_first_not_of('#', at);
        const std::size_t digits = (end == std::string::npos ? p.size() : end) - at;
        return filled(p, at, digits, digits, number);
    }
    if (const std::size_t at = p.find('%'); at != std::string::npos) {
        const std::size_t end = p.find('d', at);
        if (end != std::string::npos && end - at <= 3) {
            const std::string width = p.substr(at + 1, end - at - 1);
            return filled(p, at, end - at + 1,
                          width.empty() ? 1 : static_cast<std::size_t>(std::atoi(width.c_str())),
                          number);
        }
    }
    return p;
}

Frame read_file_frame(const FileParams& params, int frame, Job& job) {
    const std::string path = file_of_frame(params, frame);
    Frame out;
    if (path.ends_with(".ply")) {
        out.particles["particles"] = read_ply_particles(path);
    } else {
        VdbReadOptions options;
        options.half_voxel = params.half_voxel;
        options.foreign_points = params.points.foreign;
        out = read_vdb(path, options, job);
    }
    if (out.fields.empty()) splat_file_points(params.points, out, job);
    out.number = frame;
    return out;
}

}  // namespace gischt
