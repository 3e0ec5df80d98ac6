// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "optics/phase.h"
#include "render/zonal/enclosure.h"

namespace gischt {

// Directions with weights over the sphere (a product quadrature): Gauss-Legendre in the cosine to
// z, even in the angle around it. It maps onto itself when an axis is mirrored.
class OrdinateSet {
  public:
    // 2 * polar cosines and 4 * azimuth angles.
    OrdinateSet(int polar, int azimuth);

    std::size_t size() const { return direction.size(); }
    // The ordinate whose components are those of `i`, turned round where `flips` has a bit.
    std::size_t flipped(std::size_t i, std::uint8_t flips) const;

    std::vector<Vec3d> direction;
    std::vector<double> weight;  // sr; their sum is 4 pi

  private:
    int cosines_, angles_;
};

// The share of the light of ordinate j that is scattered towards ordinate i, row by row; sum over i
// of weight_i * kernel_ij is 1: rows are scaled such that no light is made or lost, symmetrically
// (Sinkhorn & Knopp 1967). Throws Error{Usage} when the phase function is too sharp for so few
// ordinates, such that its mean cosine is off by more than 2 %.
std::vector<float> scattering_kernel(const OrdinateSet& set, const PhaseFunction& phase);

struct OrdinateLimits {
    double tolerance = 1e-4;  // largest change of a mean radiance, relative to the largest one
    int most_iterations = 1000;
};

struct OrdinateSolution {
    std::vector<Vec3f> radiance;  // of zone z along ordinate m: [z * ordinates + m]
    std::vector<Vec3f> patches;   // irradiance over pi
    std::vector<Vec3f> leaving;   // as ArrivingLight::leaving
    int iterations = 0;
};

// Discrete ordinates (Chandrasekhar 1960; Fiveland 1984) with the exact step in each zone: radiance
// in zones along ordinates in equilibrium. `source` by zone and ordinate, W/(m^3 sr), and
// `patch_source` in W/(m^2 sr) are given; what is scattered by the phase function adds to them
// until nothing changes. Throws Error{Usage} when that takes more iterations than allowed.
OrdinateSolution solve_ordinates(const Enclosure& enclosure, const OrdinateSet& set,
                                 const std::vector<float>& kernel, const std::vector<Vec3f>& source,
                                 const std::vector<Vec3f>& patch_source,
                                 const OrdinateLimits& limits, Job& job);

// Bytes that it takes.
std::int64_t ordinate_bytes(std::size_t zones, std::size_t ordinates);

}  // namespace gischt
