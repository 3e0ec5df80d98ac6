// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/load.h"

namespace gischt {

// A volume that is to be looked at without a scene.
struct BareRequest {
    std::string file;    // .vdb, or a pattern with #### or %04d
    std::string preset;  // "" lets the fields choose: fire where a flame burns, else cloud or smoke
                         // by the density's look
    int frame = 1;       // the one by which camera and medium are chosen
    std::vector<std::string> overrides;
    bool exposure_given = false;
};

// Makes a scene around a volume: a camera that frames what is there, sun and sky, an extinction
// with which the 90th percentile of the optical depth along the view is 8, approximate multiple
// scattering, and an exposure that fits what glows. Tells the job what it assumed. Every choice is
// a key that the overrides may change. Throws as read_vdb(), and Error{Input} for a file without a
// field that could be a density.
LoadedScene load_bare(const BareRequest& request, Job& job);

}  // namespace gischt
