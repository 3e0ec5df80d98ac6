// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/realtime/gl_camera.h"

namespace gischt {

// Sorts points by their depth along the view axis, the farthest first, on the device: a radix sort
// over the highest 24 bits of the depth as a float, eight bits in each pass (Satish, Harris,
// Garland 2009, "Designing efficient sorting algorithms for manycore GPUs"). Depths that differ by
// less than 1.6e-5 of themselves may count as equal. Stable: equal depths keep their order, and
// what is behind the camera comes last. Each invocation does a run of points, which suits few cores
// too.
class DepthSort {
  public:
    explicit DepthSort(GlDevice& device);

    // `places` holds 4 floats per point, the first three relative to the camera's origin.
    void sort(const GlBuffer& places, int count, const GlCamera& camera);
    // The indices of the points in that order, unsigned integers; of the latest sort.
    const GlBuffer& order() const { return index_[1]; }

  private:
    void resize(int count);

    GlDevice& device_;
    GlProgram keys_, count_, sum_, scatter_;
    GlBuffer key_[2], index_[2], table_;
    int capacity_ = 0;
};

}  // namespace gischt
