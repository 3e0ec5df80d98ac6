// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/photon/photon_tracer.h"
#include "render/photon/photon_tree.h"

namespace gischt {

// The photons of one pass, ready to be gathered.
struct PhotonMap {
    // `pass` counts from 0 and tells how far the radius has shrunk (Knaus & Zwicker 2011,
    // "Progressive photon mapping: a probabilistic approach"): in n dimensions r^n of pass i is
    // that of pass i - 1 times (i + reduction) / (i + 1), so that in the mean over all passes both
    // bias and noise vanish.
    PhotonMap(const PhotonScene& scene, PhotonSet photons, int pass);

    PhotonTree in_media, on_surfaces;
    float shrunk_disc = 1, shrunk_ball = 1;  // factors on the radius in two and three dimensions
    float most = 0;                          // m, the largest radius
};

// r_pass / r_0 in so many dimensions.
double shrunk_radius(int pass, double reduction, int dimensions);

}  // namespace gischt
