// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "input.h"
#include "io/mesh_file.h"
#include "io/ply.h"
#include "io/vdb.h"
#include "readers.h"

namespace gischt {

// Corners beyond the points would be read from anywhere.
static void check_whole(const Mesh& mesh) {
    const int count = static_cast<int>(mesh.points.size());
    for (const Vec3i& t : mesh.triangles) {
        if (min_component(t) < 0 || max_component(t) >= count) std::abort();
    }
}

void fuzz_vdb(std::string_view bytes) {
    static const ThreadLimit one(1);  // so that a finding comes again
    const InputFile file(bytes, ".vdb");
    VdbReadOptions options;
    options.max_values = 1 << 18;
    Job job;
    expect_read_or_refused([&] { read_vdb(file.path(), options, job); });
    expect_read_or_refused([&] { list_vdb(file.path(), job); });
}

void fuzz_obj(std::string_view bytes) {
    const InputFile file(bytes, ".obj");
    Job job;
    expect_read_or_refused([&] { check_whole(read_mesh(file.path(), job).mesh); });
}

void fuzz_ply(std::string_view bytes) {
    const InputFile file(bytes, ".ply");
    expect_read_or_refused([&] { check_whole(read_ply(file.path())); });
    expect_read_or_refused([&] { read_ply_particles(file.path()); });
}

}  // namespace gischt
