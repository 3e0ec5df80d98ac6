// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/job.h"
#include "optics/medium_depth.h"
#include "optics/sun_depth.h"
#include "optics/view.h"
#include "render/march/aimed_sky.h"
#include "render/march/irradiance_map.h"
#include "render/march/march_params.h"
#include "render/march/octave.h"
#include "render/march/point_depth.h"
#include "render/march/sky_grid.h"

namespace gischt {

// Light that comes from one direction at each point: a sun, a point, a spot.
struct NarrowLight {
    const Light* light = nullptr;
    bool is_infinite = false;
    Vec3d direction;  // unit, towards an infinite light's centre
    Vec3f weight;     // W/m^2 of an infinite light
};

// A medium with what was computed for it once per frame.
struct MarchMedium {
    const Medium* medium = nullptr;
    Vec3f extinction, scattering;  // 1/m at density 1
    double feature = 1;            // metres: a voxel, or 1/64 of a homogeneous medium
    std::vector<Octave> octaves;
    bool octaves_halve = false;  // the extinction halves from octave to octave
    // Towards each narrow light: the one or the other, by whether it is at infinity, or neither.
    std::vector<std::unique_ptr<const SunDepth>> sun_depth;
    std::vector<std::unique_ptr<const PointDepth>> point_depth;
    std::unique_ptr<const SkyGrid> sky;  // of the broad lights; null without cache
};

// Voxels between the nodes of a grid over a medium, such that it has at most `most` nodes.
double grid_spacing(const Medium& medium, double least, std::int64_t most);

// A view made ready to march through.
struct MarchScene {
    // With a depth above 1 multiple scattering is computed: octaves, its approximation, are left
    // out, and the job is told.
    MarchScene(const View& the_view, const MarchParams& the_params, Job& job, int the_depth = 1);

    const View& view;
    const MarchParams& params;
    int depth;  // most scattering events of a light path
    std::vector<MarchMedium> media;
    std::vector<NarrowLight> narrow;
    std::vector<const Light*> broad;  // from all of the sky
    // Of these, for surfaces: what draws directions, and the irradiance where nothing blocks.
    std::vector<AimedSky> aimed_sky;
    std::vector<IrradianceMap> open_sky;
    bool is_grey = false;  // all channels of all media have the same extinction

    // Optical depth from a point in medium `inside` towards a narrow light, which `sample` is of,
    // through all media; from the grids where there are some.
    Vec3f depth_to(std::size_t light, const Vec3d& point, const LightSample& sample,
                   std::size_t inside) const;
    DepthSteps shadow_steps() const { return {params.shadow_step, 16}; }
    DepthSteps deep_steps() const { return {params.shadow_step * params.deep_step, 10}; }

  private:
    void make_depth_grids(MarchMedium& m, Job& job) const;
};

}  // namespace gischt
