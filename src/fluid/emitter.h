// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fluid/advect.h"
#include "fluid/procedural/params.h"
#include "math/keyframes.h"
#include "shape/distance_lattice.h"
#include "shape/shape.h"

namespace gischt {

enum class EmitterKind { Sphere, Box, Mesh };
enum class EmitterMode { Pull, Set };

// Animated noise that multiplies what a source gives by 1 + amplitude noise, noise in [-1,1].
struct EmitterNoise {
    double amplitude = 0;
    double scale = 0.1;  // m, size of the largest features
    double speed = 2;    // 1/s, how often they change entirely
    int octaves = 2;
    std::int64_t seed = 1;
};
const Table<EmitterNoise>& emitter_noise_table();

// A place where a scene's values are imposed on the fluid. What is unset is left alone.
struct EmitterParams {
    EmitterKind kind = EmitterKind::Sphere;
    Keyed<Vec3d> position;           // m, centre; of a mesh its origin
    Keyed<double> radius = 0.25;     // m, sphere
    Keyed<Vec3d> size = Vec3d(0.5);  // m, edges of a box
    MeshShapeParams mesh;
    std::shared_ptr<const MeshDistance> body;  // of a mesh: what `mesh` names, scaled and turned
    double edge = 0;                           // m, width of the soft edge; at least one cell
    std::optional<Keyed<double>> density;      // 1
    std::optional<Keyed<double>> temperature;  // K
    std::optional<Keyed<Vec3d>> velocity;      // m/s
    EmitterMode mode = EmitterMode::Pull;
    Keyed<double> rate = 20.0;  // 1/s, of Pull
    EmitterNoise noise;
};
const Table<EmitterParams>& emitter_table();

// All sources of a fluid. Values approach those of a source with exp(-rate dt), the rate being less
// in the soft edge; Set takes over at once what lies inside, and the edge within a frame. Whatever
// the time steps, the same time gives the same values. Noise animates as blended slices.
class Emitters {
  public:
    // `frame_time`: duration of a frame, s; `cell`: edge of the fluid's cells, m. Throws
    // Error{Usage} on negative rates and sizes, and for a mesh without a body.
    Emitters(std::vector<EmitterParams> emitters, double ambient, double frame_time, double cell);

    // Acts for dt seconds up to `time`. `temperature` is T - T_ambient.
    void apply(const Domain& domain, const BlockMap& blocks, double time, double dt,
               SparseField& density, SparseField& temperature, FaceField& velocity) const;

    // Largest values that any source gives at a time: |density|, |T - T_ambient|, |velocity
    // component|; 0 where none gives any.
    double top_density(double time) const;
    double top_temperature(double time) const;
    double top_speed(double time) const;

  private:
    struct Active;

    std::vector<EmitterParams> emitters_;
    std::vector<DistanceLattice> bodies_;  // one per emitter, of meshes
    double ambient_, frame_time_;
};

}  // namespace gischt
