// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "math/transform.h"

namespace gischt {

enum class TurbulenceKind {
    Fbm,     // sum of gradient noises: clouds, haze
    Billow,  // sum of their absolute values, "turbulence" of Perlin 1985: round heaps, sharp
             // creases
    Ridged,  // sum of (1 - |noise|)^2 (Musgrave in Ebert et al. 2003): filaments, flames
    Cells,   // minus the distance to the nearest point (Worley 1996): packed balls
    Walls,   // minus the difference of the two nearest distances: foam, cracks
};

struct TurbulenceShape {
    TurbulenceKind kind = TurbulenceKind::Fbm;
    int octaves = 5;
    double lacunarity = 2;  // from one octave to the next features are so many times finer
    double gain = 0.5;      // and so many times as strong
    std::uint64_t seed = 1;
};

// A sum of octaves of noise over space and time. The first octave has features of size 1; each
// further one is turned against the last, so that no lattice direction shows, and changes in the
// time that an eddy of its size takes to turn over, which falls as size^(2/3) (Kolmogorov 1941).
class Turbulence {
  public:
    explicit Turbulence(const TurbulenceShape& shape);

    // At p, in units of the largest features, and w, in units of the time in which those change.
    // Scaled by the statistics of the kind to mean 0 and standard deviation 1 over all space (to
    // 2 %); high values are inside of heaps, filaments, cells and walls.
    double value(const Vec3d& p, double w) const;
    // The same, but where it is at most `low` or at least `high`, any other such value: the octaves
    // that cannot change that are spared.
    double value_within(const Vec3d& p, double w, double low, double high) const;
    // No value is outside of these: 0 is between them.
    double least() const { return least_; }
    double most() const { return most_; }

  private:
    struct Octave {
        Transform place;  // from p to the octave's lattice
        double rate;      // of time
        double weight;
        std::uint64_t seed;
        double rest_least = 0, rest_most = 0;  // that this and later octaves add
    };
    TurbulenceKind kind_;
    std::vector<Octave> octaves_;
    double least_ = 0, most_ = 0;
};

// p moved by gradient noise, `amount` being the standard deviation of each component in units of
// the noise's features: domain warping, which folds a pattern as a flow would (Perlin 1985).
Vec3d warped(const Vec3d& p, double w, double amount, std::uint64_t seed);

}  // namespace gischt
