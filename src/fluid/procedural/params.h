// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/units.h"
#include "fluid/procedural/blobs.h"
#include "math/turbulence.h"

namespace gischt {

enum class ProceduralShape { All, Ball, Box, Slab, Blobs, Mesh };

// The noise that tears a procedural fluid.
struct TurbulenceParams {
    TurbulenceKind kind = TurbulenceKind::Fbm;
    double scale = 0.5;           // m, size of the largest features
    Vec3d stretch{1, 1, 1};       // features are so many times as long along each axis
    int octaves = 6;              // at most; those finer than two cells are left out
    double lacunarity = 2;        // from octave to octave features are so many times finer
    double gain = 0.5;            // and so many times as strong
    Keyed<double> warp = 0;       // m by which noise folds the noise
    Keyed<double> evolution = 0;  // 1/s, how often the largest features change entirely
    std::int64_t seed = 1;
};
const Table<TurbulenceParams>& turbulence_table();

// A closed mesh that is filled, as its file says but for:
struct MeshShapeParams {
    std::string file;
    double scale = 1;      // about its origin, at first
    Vec3d rotate_degrees;  // around x, then y, then z
};
const Table<MeshShapeParams>& mesh_shape_table();

// A fluid whose density is a formula. With d(x) the depth below the surface of the shape (m,
// positive inside, at most the height above the base) and n(x,t) the noise (mean 0, standard
// deviation 1), which the wind carries:
//     rise = smoothstep((d + displacement n) / edge)
//     fill = smoothstep((n - threshold) / softness), 1 without a threshold
//     density = density rise fill exp(-height / falloff)
struct ProceduralParams {
    int resolution = 128;                // cells along the longest edge
    Vec3d min{-1, -1, 0}, max{1, 1, 2};  // m

    ProceduralShape shape = ProceduralShape::All;
    Keyed<Vec3d> position;  // m, middle of a ball or box; on the base of a slab; origin of a mesh
    Keyed<double> radius = 0.5;     // m, ball
    Keyed<Vec3d> size = Vec3d(1);   // m, edges of a box
    Keyed<double> thickness = 0.5;  // m, slab
    std::vector<BlobParams> blobs;
    BlobKernel kernel = BlobKernel::Wyvill;
    double blobbiness = 0.7;  // of Blinn's kernel
    MeshShapeParams mesh;

    Keyed<double> edge = 0.1;                // m over which the density rises
    Keyed<double> displacement = 0;          // m per standard deviation of the noise
    std::optional<Keyed<double>> threshold;  // standard deviations
    Keyed<double> softness = 1.0;            // standard deviations
    std::optional<double> base;              // m along `up`: nothing is below
    std::optional<Keyed<double>> falloff;    // m
    Keyed<double> density = 1;
    std::optional<Keyed<double>> temperature;  // K, in the core
    std::optional<Keyed<double>> flame;        // 1, in the core
    Keyed<double> core = 0.2;                  // m over which heat rises
    bool surface = false;  // a level set where d + displacement n is 0, whatever the noise fills
    double ambient_temperature = gischt::ambient_temperature;  // K
    Keyed<Vec3d> velocity;  // m/s of the wind that carries the noise
    TurbulenceParams noise;
};
const Table<ProceduralParams>& procedural_table();

}  // namespace gischt
