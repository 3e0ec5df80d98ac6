// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/job.h"
#include "grid/frame.h"
#include "schema/table.h"

namespace gischt {

// A cumulus made on the spot: a heap of spheres grown on one another, as the towers of a cumulus
// grow, whose surface is pushed outwards by billowed noise (Ebert et al. 2003, "Texturing and
// Modeling", chapter 9; Schpok et al. 2003).
struct CloudParams {
    int resolution = 160;                             // cells along the longest edge
    Vec3d min{-640, -640, 600}, max{640, 640, 1240};  // m, the box that the cloud fills
    int towers = 7;                                   // large spheres on the base
    int generations = 3;      // how often smaller spheres grow on the last ones
    double lumpiness = 0.35;  // height of the billows, as a share of their size
    int octaves = 5;          // of the billows, each half as large
    double edge = 0.02;       // share of the box's height over which density rises to 1
    double flatness = 0.12;   // share of the box's height in which the base evaporates
    double evolution = 2.0;   // m/s at which the billows rise through the cloud
    std::int64_t seed = 1;
};

const Table<CloudParams>& cloud_table();

// The field `density` (1 inside) at a time in seconds, on sparse tiles. `up` is a unit axis. The
// cost is that of the noise in the shell around the surface. Throws Error{Usage} for an empty box.
Frame make_cloud(const CloudParams& params, const Vec3d& up, double time, Job& job);

}  // namespace gischt
