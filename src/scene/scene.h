// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fluid/cloud.h"
#include "fluid/particles/particle_params.h"
#include "fluid/probes/probe_params.h"
#include "fluid/procedural/params.h"
#include "fluid/smoke.h"
#include "image/filter.h"
#include "image/tone_curve.h"
#include "optics/camera.h"
#include "optics/light_params.h"
#include "optics/medium_params.h"
#include "optics/placed_media.h"
#include "optics/surface_params.h"
#include "render/method.h"
#include "render/params.h"
#include "scene/file_source.h"
#include "schema/table.h"

namespace gischt {

enum class UpAxis { Y, Z };

// What every fluid has beside its source.
struct FluidCommon {
    std::string name;
    MediumParams medium;            // what it does to light
    Vec3d translate{0, 0, 0};       // m, applied last
    Vec3d rotate_degrees{0, 0, 0};  // around x, then y, then z, about the origin
    double scale = 1;               // about the origin, applied first
    int blur_moments = 9;           // most moments at which it is taken while the film is exposed

    Transform placement() const;
};

// A fluid whose motion comes from a source with the parameters P.
template <class P>
struct FluidOf {
    FluidCommon common;
    P source;
};
using FluidSection = std::variant<FluidOf<SmokeParams>, FluidOf<FileParams>, FluidOf<CloudParams>,
                                  FluidOf<ProceduralParams>, FluidOf<ParticleParams>>;

FluidCommon& common_of(FluidSection& fluid);
const FluidCommon& common_of(const FluidSection& fluid);

struct FilmParams {
    int width = 960, height = 540;  // pixels
    double exposure = 0;            // stops
    ToneKind tone = ToneKind::Filmic;
    FilterKind filter = FilterKind::BlackmanHarris;
    double filter_radius = 0;  // pixels; 0: the filter's own
    double shutter = 0;        // share of a frame that the film is exposed, centred on its moment
    std::vector<std::string> aovs;  // further layers of an EXR, see render/aov.h
    bool denoise = false;           // see image/denoise.h
};

struct RenderSection {
    std::string method = "march";
    int spp = 8;           // samples per pixel
    int depth = 1;         // most scattering events of a light path
    RenderParams methods;  // one table per method
};

// A world to simulate and look at: the content of a scene file.
struct Scene {
    std::string description;
    UpAxis up = UpAxis::Z;
    double fps = 24;
    Vec2i frames{1, 1};  // first and last
    std::int64_t seed = 0;
    std::optional<Vec3d> gravity;  // m/s^2; unset: 9.80665 downwards
    std::vector<FluidSection> fluids;
    std::vector<PlacedMediumParams> media;  // that do not come from a fluid: fog, air
    std::vector<SurfaceParams>
        solids;                       // seen by the camera, and in the way of every simulated fluid
    std::vector<ProbeParams> probes;  // of simulated smoke
    std::vector<AnyLightParams> lights;
    std::optional<CameraParams> camera;  // unset: frames the fluids from a little above
    FilmParams film;
    RenderSection render;

    Vec3d up_vector() const { return up == UpAxis::Y ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}; }
    Vec3d gravity_vector() const { return gravity ? *gravity : -standard_gravity * up_vector(); }
    // Time of a frame in seconds; frame 1 is the first step after the start.
    double time_of(int frame) const { return frame / fps; }
};

const Table<Scene>& scene_table();

// The probes of a fluid of the scene, by its place among the fluids.
std::vector<ProbeParams> probes_of(const Scene& scene, std::size_t fluid);

// The components that `gischt doc NAME` knows at the top: scene, and each alternative below it.
std::vector<const Component*> documented_components();

}  // namespace gischt
