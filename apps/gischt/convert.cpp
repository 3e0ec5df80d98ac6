// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"
#include "commands.h"
#include "console.h"
#include "io/ply.h"
#include "io/vdb.h"
#include "scene/file_source.h"
#include "studio/frame_range.h"

namespace gischt {
namespace {

// Throws Error{Usage} for another extension than those of volumes.
std::string volume_extension(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    const std::vector<std::string> known{".vdb", ".ply"};
    if (extension == known[0] || extension == known[1]) return extension;
    throw Error(ErrorKind::Usage, path, "has no extension that tells a format of particles",
                hint_for(extension, known));
}

const Particles& only_particles(const Frame& frame, const std::string& path) {
    if (frame.particles.size() == 1) return frame.particles.begin()->second;
    throw Error(ErrorKind::Input, path,
                fmt::format("has {} sets of particles; a .ply holds one", frame.particles.size()),
                "see gischt info");
}

void convert_frame(const FileParams& from, int number, const std::string& to, Job& job) {
    const Frame frame = read_file_frame(from, number, job);
    if (volume_extension(to) == ".ply") {
        write_ply_particles(to, only_particles(frame, file_of_frame(from, number)));
    } else {
        write_vdb(to, frame, {}, job);
    }
    fmt::print("{}\n", to);
}

}  // namespace

int convert_volume(const ConvertOptions& options, CommandContext& context) {
    const Console console(context);
    volume_extension(options.from);
    volume_extension(options.to);
    FileParams from;
    from.file = options.from;
    from.points.cell_size = options.cell_size;
    from.points.foreign = options.foreign;
    if (options.frames.empty()) {
        convert_frame(from, 1, options.to, context.job);
        return 0;
    }
    const FrameRange frames = parse_frame_range(options.frames);
    for (int i = 0; i < frames.count(); ++i) {
        convert_frame(from, frames[i], frame_path(options.to, frames[i]).string(), context.job);
    }
    return 0;
}

}  // namespace gischt
