// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "grid/frame.h"
#include "io/vdb.h"
#include "scene/file_points.h"
#include "schema/table.h"

namespace gischt {

// A fluid that was made elsewhere: one VDB file, or one per frame; or particles in PLY files.
struct FileParams {
    std::string file;  // '####' or '%04d' stands for the frame number; a name with a number that
                       // exists stands for itself
    int frame_offset = 0;  // added to the scene's frame number
    HalfVoxel half_voxel = HalfVoxel::Auto;
    FilePoints points;
};

const Table<FileParams>& file_table();

// The file of a frame: the pattern filled in. Where the file is not there, the path all the same.
std::string file_of_frame(const FileParams& params, int frame);

// Reads the frame; one of particles without fields gets those that they make. Throws as read_vdb()
// or read_ply_particles(), and as splat_file_points().
Frame read_file_frame(const FileParams& params, int frame, Job& job);

}  // namespace gischt
