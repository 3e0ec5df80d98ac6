// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "optics/medium.h"

namespace gischt {

// What a fluid's medium is while the film is exposed.
struct Exposure {
    double time = 0, shutter = 0;  // s: exposed during [time - shutter / 2, time + shutter / 2]
    int most_parts = 9;            // of which one medium each stands for all moments
};

// The media at the middles of equal parts of the shutter's time, 1, 3, 9, 27 ... of them, so that
// those of several fluids fit together: the frame's fields carried along by its velocity. `middle`
// is the frame as it is. So many parts that nothing moves by more than half a voxel from one to the
// next, but no more than allowed; the job is told where that leaves larger steps. Only `middle`
// where nothing moves by a tenth of a voxel, and without a velocity, of which the job is warned.
std::vector<std::shared_ptr<const Medium>> media_while_exposed(
    const Frame& frame, const std::shared_ptr<const Medium>& middle, const MediumParams& params,
    const Exposure& exposure, Job& job);

}  // namespace gischt
