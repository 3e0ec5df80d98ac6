// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/air.h"

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "math/noise.h"

namespace gischt {
namespace {

// All octaves of one pattern of eddies, with a root mean square of 1.
Vec3d eddies(const Vec3d& p, int octaves, std::uint64_t key) {
    Vec3d sum, q = p;
    double weight = 1, squares = 0;
    for (int o = 0; o < octaves; ++o) {
        sum += weight * curl_of_noise(q, key + static_cast<std::uint64_t>(o));
        squares += weight * weight;
        weight *= std::exp2(-1.0 / 3);
        q = 2.0 * q + Vec3d(0.37, 0.71, 0.53);
    }
    return sum / (curl_of_noise_rms * std::sqrt(squares));
}

// The straight part from a to b of a vortex line of circulation 1: the integral of
// dl x r / (4 pi (r^2 + core^2)^(3/2)).
Vec3d vortex_part(const Vec3d& a, const Vec3d& b, double core, const Vec3d& point) {
    const double full = length(b - a);
    if (!(full > 0)) return {};
    const Vec3d along = (b - a) / full, arm = point - a;
    const double z = dot(arm, along), rest = z - full;
    const Vec3d across = arm - z * along;
    const double d2 = dot(across, across) + core * core;
    const double share = z / std::sqrt(d2 + z * z) - rest / std::sqrt(d2 + rest * rest);
    return (share / (4 * pi * d2)) * cross(along, across);
}

}  // namespace

Vec3d eddy_velocity(const EddyParams& params, const Vec3d& point, double time) {
    const double speed = params.speed.at(time);
    if (speed == 0) return {};
    // One pattern passes into the next such that the variance stays; each is free of divergence,
    // and so is every sum of them.
    const double t = time * params.change, slice = std::floor(t), w = t - slice;
    const auto pattern = [&](double s) {
        const auto key = random_key(static_cast<std::uint64_t>(params.seed),
                                    static_cast<std::uint64_t>(static_cast<std::int64_t>(s)));
        return eddies(point / params.scale, params.octaves, key);
    };
    Vec3d sum = (1 - w) * pattern(slice);
    if (w > 0) sum += w * pattern(slice + 1);
    return (speed / std::sqrt((1 - w) * (1 - w) + w * w)) * sum;
}

Vec3d vortex_velocity(const VortexParams& params, const Vec3d& point, double time) {
    const Vec3d at = params.position.at(time);
    const double circulation = params.circulation.at(time);
    if (params.points.empty()) {
        const Vec3d axis = normalize(params.axis.at(time)), arm = point - at;
        const Vec3d across = arm - dot(arm, axis) * axis;
        const double d2 = dot(across, across) + params.core * params.core;
        return (circulation / (2 * pi * d2)) * cross(axis, across);
    }
    Vec3d sum;
    for (std::size_t i = 1; i < params.points.size(); ++i) {
        sum += vortex_part(at + params.points[i - 1], at + params.points[i], params.core, point);
    }
    return circulation * sum;
}

Air::Air(AirParams params) : params_(std::move(params)) {
    const auto bad = [](const char* what, const char* hint) {
        throw Error(ErrorKind::Usage, "vortex", what, hint);
    };
    for (const VortexParams& v : params_.vortices) {
        if (v.points.size() == 1) bad("a curve has one point", "give two at least, or none");
        if (!(v.core > 0)) bad("a core has no radius", "give it in metres, above 0");
        for (const Vec3d& axis : v.axis.v) {
            if (!(length(axis) > 0)) bad("an axis has no length", "give the way that it points");
        }
    }
    if (!(params_.turbulence.scale > 0)) {
        throw Error(ErrorKind::Usage, "turbulence", "the scale is not positive",
                    "give the size of the largest eddies in metres");
    }
}

void Air::set_flow(std::shared_ptr<const Flow> begin, std::shared_ptr<const Flow> end, double from,
                   double to) {
    begin_ = std::move(begin);
    end_ = std::move(end);
    from_ = from;
    to_ = to;
}

Vec3d Air::velocity(const Vec3d& point, double time) const {
    Vec3d u = params_.wind.at(time) + eddy_velocity(params_.turbulence, point, time);
    for (const VortexParams& v : params_.vortices) u += vortex_velocity(v, point, time);
    if (begin_ && end_) {
        const double s = std::clamp((time - from_) / (to_ - from_), 0.0, 1.0);
        u += (1 - s) * begin_->at(point) + s * end_->at(point);
    }
    return u;
}

}  // namespace gischt
