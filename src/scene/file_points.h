// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "grid/frame.h"
#include "schema/table.h"

namespace gischt {

// How the particles of a file become a density, where the file has no fields of its own.
struct FilePoints {
    double cell_size = 0;    // m; 0: 1/256 of the longest edge of the box around them
    double density = 1;      // of the field inside of a particle
    double splat_scale = 1;  // radius of the kernel against the particle's
    bool foreign = false;    // also points in VDB files of other programs
};

const Table<FilePoints>& file_points_table();

// Adds the fields of splat_particles() for the frame's one set of particles, on a lattice that
// holds them with their kernels. Throws Error{Usage} for cells so small that there would be more
// than 2^31, Error{Input} for several sets.
void splat_file_points(const FilePoints& params, Frame& frame, Job& job);

}  // namespace gischt
