// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/transform.h"
#include "optics/camera.h"
#include "optics/surface.h"
#include "render/march/octave.h"
#include "render/march/sky_directions.h"

namespace gischt {

// A grid through which light is swept in planes across one axis: its values are stored plane by
// plane, u running fastest. The three of them hold the same nodes in different order.
struct SweepGrid {
    int axis = 2, u = 0, v = 1;  // of the grid (i, j, k)
    int nu = 0, nv = 0, planes = 0;
    Transform to_world;  // from (i, j, k) to metres
    // Extinction in 1/m at the nodes, one channel if the media are grey, else three.
    std::vector<std::vector<float>> extinction;
    std::vector<std::uint8_t> is_opaque;  // a surface passes through the node; empty: none does
    struct Range {
        int begin = 0, end = 0;
    };
    std::vector<Range> needed;  // per row: the nodes at which the light is asked for

    std::size_t row(int v_index, int plane) const {
        return static_cast<std::size_t>(v_index) +
               static_cast<std::size_t>(nv) * static_cast<std::size_t>(plane);
    }
    std::size_t size() const {
        return static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv) *
               static_cast<std::size_t>(planes);
    }
    Vec3d position(double i_u, double i_v, double plane) const {
        Vec3d q;
        q[axis] = plane;
        q[u] = i_u;
        q[v] = i_v;
        return to_world.point(q);
    }
};

// What the sweeps add up at every node.
struct SweepSums {
    std::vector<float> single[3];   // radiance, transmittance and phase function
    std::vector<float> phase;       // the phase function alone
    std::vector<float> octaves[3];  // radiance of the further octaves; empty without them

    SweepSums(std::size_t nodes, bool with_octaves);
};

// Sweeps light of single directions through a grid.
class SkySweep {
  public:
    SkySweep(const SweepGrid& grid, const Camera& camera, std::span<const Octave> octaves,
             const SurfaceSet& surfaces);

    // Adds the light of one part of the sky; `arriving` is the share of it, per channel, that
    // reaches the grid's box. The direction's largest component, in cells, is that across the
    // planes.
    void add(const SkyDirection& sky, const Vec3f& arriving, SweepSums& sums);

  private:
    void enter_plane(int plane, const Vec3d& towards, const Vec3f& arriving);
    void move_light(int plane, float half_length);
    void scatter(int plane, const SkyDirection& sky, SweepSums& sums);
    void scatter_row(std::size_t first, int count, const SkyDirection& sky, SweepSums& sums);
    std::size_t padded(int i, int j) const {
        return static_cast<std::size_t>(i + 1) +
               static_cast<std::size_t>(grid_.nu + 2) * static_cast<std::size_t>(j + 1);
    }

    const SweepGrid& grid_;
    const Camera& camera_;
    std::span<const Octave> octaves_;
    const SurfaceSet& surfaces_;
    std::size_t channels_;
    // The plane before, with a frame of one node: the light that leaves it; and the light at the
    // nodes of this plane.
    std::vector<float> upwind_[3], here_[3];
    float fraction_u_ = 0, fraction_v_ = 0;
    int shift_u_ = 0, shift_v_ = 0;
    std::vector<float> cosine_, weight_, term_, log_[3];
};

}  // namespace gischt
