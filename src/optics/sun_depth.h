// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "optics/medium.h"

namespace gischt {

// The integral of a medium's density from any point to a light at infinity, stored on a lattice
// whose planes are those of the voxels and whose columns are the light's rays: a sweep away from
// the light adds one step per node along its own ray, so nothing is smeared, and a look-up
// interpolates along the ray and across. (Shearing the grid to the light is the idea of shear-warp
// rendering, Lacroute & Levoy 1994.) Along the ray the interpolation is cubic, its slopes being the
// densities, for depth is strongly curved where light enters a dense medium; across it is linear.
class SunDepth {
  public:
    // `towards`: unit vector to the light. A node lies on every `spacing`-th voxel; half voxels are
    // fine. Costs two density look-ups and 8 bytes per node of the medium's box.
    SunDepth(const Medium& medium, const Vec3d& towards, double spacing, Job& job);

    // Metres times density from a point in metres to the light; 0 outside of the shadow.
    float operator()(const Vec3d& point) const { return find(point).depth; }
    // The same with the range of the depths that it was interpolated from, across the light.
    struct Found {
        float depth = 0, range = 0;
    };
    Found find(const Vec3d& point) const;
    std::size_t bytes() const { return nodes_.size() * sizeof(Node); }

  private:
    struct Node {
        float depth = 0;  // metres times density
        float slope = 0;  // density times the length of a step
    };
    struct Plane {
        float shift_u, shift_v;  // of the columns, in [0,1)
        int step_u, step_v;      // columns that the ray has moved since the plane before
    };

    void make_planes();
    void sweep(const Medium& medium, int plane);
    struct Mixed {
        float depth = 0, slope = 0, range = 0;
    };
    Mixed at(int plane, float u, float v) const;
    std::size_t index(int plane, int i, int j) const {
        return static_cast<std::size_t>(i) +
               static_cast<std::size_t>(nu_) *
                   (static_cast<std::size_t>(j) +
                    static_cast<std::size_t>(nv_) * static_cast<std::size_t>(plane));
    }
    Vec3d node(double plane, double u, double v) const;

    Transform to_lattice_, to_world_;
    Box3d box_;
    Vec3d towards_;  // in the lattice, its component along axis_ being +-1
    int axis_ = 2, u_ = 0, v_ = 1;
    int sign_ = 1;      // of the way away from the light along axis_
    double first_ = 0;  // coordinate of plane 0 along axis_
    double low_u_ = 0, low_v_ = 0;
    double slope_u_ = 0, slope_v_ = 0;  // of the rays away from the light, per plane
    double step_length_ = 0;            // metres of a ray between planes
    int nu_ = 0, nv_ = 0;
    std::vector<Plane> planes_;
    std::vector<Node> nodes_;
};

}  // namespace gischt
