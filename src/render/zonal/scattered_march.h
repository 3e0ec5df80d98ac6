// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/path/media_walk.h"
#include "render/path/path_scene.h"
#include "render/zonal/scattered_source.h"

namespace gischt {

struct GatherParams {
    double step = 1;          // largest step in voxels
    double step_depth = 0.5;  // largest optical depth of a step
};

// Marches camera rays for the light of all scatterings but the first.
class ScatteredMarch {
  public:
    ScatteredMarch(const PathScene& scene, const ScatteredSource& source,
                   const GatherParams& params)
        : scene_(scene), source_(source), params_(params) {}

    // W/(m^2 sr). `jitter` in [0,1) places the points in their steps.
    Vec3f operator()(Ray ray, float jitter);

    std::int64_t lookups = 0;

  private:
    // What a ray has gathered so far, and the optical depths that it has passed.
    struct Gathered {
        Vec3f radiance, depth, reduced_depth;
    };
    void march_run(const MediaRun& run, const Ray& ray, float jitter, Gathered& so_far);
    void step(const MediaRun& run, const Ray& ray, double t, float ds, Gathered& so_far);

    const PathScene& scene_;
    const ScatteredSource& source_;
    GatherParams params_;
};

}  // namespace gischt
