// SPDX-License-Identifier: Apache-2.0
#include "math/turbulence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "math/noise.h"

namespace gischt {
namespace {

// Of the 4-D gradient noise: (3/4) 64 A^3 B with A = int fade^2, B = int fade(t)^2 (1-t)^2 dt on
// [0,1], from the covariance 3/4 of the gradients.
constexpr double noise_deviation = 0.29275;

// Of one octave: what is subtracted, the standard deviation, and the least and the largest value.
// The first line follows from the noise; the other means and deviations were measured on some 10^6
// points. The point of a cell is at most its diagonal away, a neighbour's at most sqrt(4.25).
struct KindStatistics {
    double mean, deviation, least, most;
};
KindStatistics statistics_of(TurbulenceKind kind) {
    switch (kind) {
        case TurbulenceKind::Fbm:
            return {0, noise_deviation, -1.7321, 1.7321};
        case TurbulenceKind::Billow:
            return {0.2379, 0.1709, 0, 1.7321};
        case TurbulenceKind::Ridged:
            return {0.6100, 0.2412, 0, 1};
        case TurbulenceKind::Cells:
            return {-0.5321, 0.1808, -1.7321, 0};
        case TurbulenceKind::Walls:
            return {-0.1872, 0.1552, -2.0616, 0};
    }
    return {};
}

double octave_value(TurbulenceKind kind, const Vec3d& p, double w, std::uint64_t seed) {
    if (kind == TurbulenceKind::Cells || kind == TurbulenceKind::Walls) {
        const CellDistances d = cell_distances(p, w, seed);
        return static_cast<double>(kind == TurbulenceKind::Cells ? -d.first : d.first - d.second);
    }
    const auto n = static_cast<double>(gradient_noise(p, w, seed));
    if (kind == TurbulenceKind::Fbm) return n;
    if (kind == TurbulenceKind::Billow) return std::abs(n);
    const double crest = std::max(0.0, 1 - std::abs(n));
    return crest * crest;
}

}  // namespace

Turbulence::Turbulence(const TurbulenceShape& shape) : kind_(shape.kind) {
    if (shape.octaves < 1 || !(shape.lacunarity > 1) || !(shape.gain >= 0)) {
        throw Error(ErrorKind::Usage, "turbulence",
                    "needs at least one octave, a lacunarity above 1 and no negative gain");
    }
    // An axis whose components are a Pythagorean quadruple, and one radian, which no power returns.
    const Transform turn = Transform::rotation({0.36, 0.48, 0.8}, 1.0);
    Transform place;
    double weight = 1, squares = 0, sum = 0, rate = 1;
    for (int o = 0; o < shape.octaves; ++o) {
        octaves_.push_back(
            {place, rate, weight, random_key(shape.seed, static_cast<std::uint64_t>(o))});
        squares += weight * weight;
        sum += weight;
        weight *= shape.gain;
        rate *= std::cbrt(shape.lacunarity * shape.lacunarity);
        place = Transform::scale_translate(shape.lacunarity, {17.37, 31.71, 23.53}) * turn * place;
    }
    // Octaves are independent: their variances add.
    const KindStatistics kind = statistics_of(kind_);
    const double scale = 1 / (kind.deviation * std::sqrt(squares));
    double rest = sum * scale;
    least_ = (kind.least - kind.mean) * rest;
    most_ = (kind.most - kind.mean) * rest;
    for (Octave& o : octaves_) {
        o.weight *= scale;
        o.rest_least = (kind.least - kind.mean) * rest;
        o.rest_most = (kind.most - kind.mean) * rest;
        rest -= o.weight;
    }
}

double Turbulence::value(const Vec3d& p, double w) const {
    return value_within(p, w, -std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::infinity());
}

double Turbulence::value_within(const Vec3d& p, double w, double low, double high) const {
    const double mean = statistics_of(kind_).mean;
    double sum = 0;
    for (const Octave& o : octaves_) {
        if (sum + o.rest_most <= low || sum + o.rest_least >= high) break;
        sum += o.weight * (octave_value(kind_, o.place.point(p), o.rate * w, o.seed) - mean);
    }
    return sum;
}

Vec3d warped(const Vec3d& p, double w, double amount, std::uint64_t seed) {
    Vec3d q = p;
    for (int a = 0; a < 3; ++a) {
        // Off the lattice of the pattern itself, whose zeros would else stay where they are.
        const Vec3d at = p + Vec3d(0.31, 0.57, 0.73);
        const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(a));
        q[a] += amount / noise_deviation * static_cast<double>(gradient_noise(at, w, key));
    }
    return q;
}

}  // namespace gischt
