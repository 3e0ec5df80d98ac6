// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/emission.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/units.h"

namespace gischt {
namespace {

// What a particle's random numbers are for.
enum Dimension : std::uint32_t { Birth, PlaceA, PlaceB, PlaceC, ConeA, ConeB, Speed, Life, Radius };

double uniform(std::uint64_t key, std::uint32_t dimension) {
    return static_cast<double>(random_uniform(key, dimension));
}

// A mean with a uniform spread of the given share to either side.
double spread(double mean, double share, std::uint64_t key, std::uint32_t dimension) {
    return mean * (1 + share * (2 * uniform(key, dimension) - 1));
}

// A direction in the cone around a unit axis, even over its solid angle.
Vec3d in_cone(const Vec3d& axis, double half_angle, double a, double b) {
    const double c = 1 - a * (1 - std::cos(half_angle)), s = std::sqrt(std::max(0.0, 1 - c * c));
    Vec3d x, y;
    orthonormal_frame(axis, x, y);
    return c * axis + (s * std::cos(2 * pi * b)) * x + (s * std::sin(2 * pi * b)) * y;
}

Vec3d in_ball(double a, double b, double c) {
    return std::cbrt(c) * in_cone({0, 0, 1}, pi, a, b);
}

// The integral of the interpolation of two keys over the first share s of the time between them.
double partial(KeyInterpolation kind, double a, double b, double s) {
    switch (kind) {
        case KeyInterpolation::Step:
            return a * s;
        case KeyInterpolation::Linear:
            return a * s + (b - a) * s * s / 2;
        case KeyInterpolation::Smooth:
            break;
    }
    return a * s + (b - a) * s * s * s * (1 - s / 2);
}

[[noreturn]] void bad_spout(const char* what, const char* hint) {
    throw Error(ErrorKind::Usage, "source", what, hint);
}

}  // namespace

RateIntegral::RateIntegral(const Keyed<double>& rate) : rate_(rate) {
    for (const double r : rate.v) {
        if (!(r >= 0)) bad_spout("a rate is negative", "give particles per second");
    }
    sum_.push_back(0);
    for (std::size_t i = 1; i < rate_.t.size(); ++i) {
        sum_.push_back(sum_.back() + (rate_.t[i] - rate_.t[i - 1]) * partial(rate_.interpolation,
                                                                             rate_.v[i - 1],
                                                                             rate_.v[i], 1));
    }
    offset_ = since_first_key(0);
}

double RateIntegral::since_first_key(double time) const {
    if (rate_.is_constant()) return rate_.v.front() * time;
    const auto& t = rate_.t;
    if (time <= t.front()) return rate_.v.front() * (time - t.front());
    if (time >= t.back()) return sum_.back() + rate_.v.back() * (time - t.back());
    const auto next =
        static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), time) - t.begin());
    const double width = t[next] - t[next - 1];
    return sum_[next - 1] + width * partial(rate_.interpolation, rate_.v[next - 1], rate_.v[next],
                                            (time - t[next - 1]) / width);
}

double RateIntegral::time_of(double value, double from, double to) const {
    if (rate_.is_constant()) return std::clamp(value / rate_.v.front(), from, to);
    // Bisection to the last bit: the integral never falls.
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (from + to);
        (at(middle) < value ? from : to) = middle;
    }
    return to;
}

Spout::Spout(const SpoutParams& params, const Mesh& mesh, int index, std::uint64_t seed)
    : params_(params),
      count_(params.rate),
      first_id_(static_cast<std::uint64_t>(index) << 40),
      seed_(seed) {
    for (const Vec3d& d : params.direction.v) {
        if (!(length(d) > 0)) bad_spout("a direction has no length", "give the way that they go");
    }
    double sum = 0;
    if (params.kind == SpoutKind::Curve) {
        for (std::size_t i = 1; i < params.points.size(); ++i) {
            cumulative_.push_back(sum += length(params.points[i] - params.points[i - 1]));
        }
        if (!(sum > 0)) bad_spout("a curve has no length", "give two points at least");
    }
    if (params.kind == SpoutKind::Mesh) {
        mesh_ = mesh;
        for (const Vec3i& t : mesh_.triangles) {
            const auto at = [&](int i) { return Vec3d(mesh_.points[static_cast<std::size_t>(i)]); };
            cumulative_.push_back(sum += 0.5 * length(cross(at(t.y) - at(t.x), at(t.z) - at(t.x))));
        }
        if (!(sum > 0) || !std::isfinite(sum)) bad_spout("a mesh has no area", "give another file");
    }
}

// The part of a cumulative sum in which a share of the whole falls, and where inside of it.
static std::size_t find_part(const std::vector<double>& sum, double share, double& inside) {
    const double value = share * sum.back();
    const auto found = std::upper_bound(sum.begin(), sum.end() - 1, value);
    const auto i = static_cast<std::size_t>(found - sum.begin());
    const double begin = i == 0 ? 0 : sum[i - 1];
    inside = sum[i] > begin ? (value - begin) / (sum[i] - begin) : 0;
    return i;
}

Spout::Spot Spout::on_mesh(std::uint64_t key) const {
    double rest = 0;
    const std::size_t t = find_part(cumulative_, uniform(key, PlaceA), rest);
    const Vec3i& corner = mesh_.triangles[t];
    const auto at = [&](int i) { return Vec3d(mesh_.points[static_cast<std::size_t>(i)]); };
    const Vec3d a = at(corner.x), b = at(corner.y), c = at(corner.z);
    // Even over the triangle (Turk 1990).
    const double r = std::sqrt(uniform(key, PlaceB)), s = uniform(key, PlaceC);
    return {(1 - r) * a + (r * (1 - s)) * b + (r * s) * c, normalize(cross(b - a, c - a))};
}

Spout::Spot Spout::on_curve(std::uint64_t key) const {
    double s = 0;
    const std::size_t i = find_part(cumulative_, uniform(key, PlaceA), s);
    const Vec3d a = params_.points[i], b = params_.points[i + 1], along = normalize(b - a);
    return {a + s * (b - a), along};
}

Spout::Spot Spout::spot(double time, std::uint64_t key) const {
    const Vec3d center = params_.position.at(time);
    const Vec3d axis = normalize(params_.direction.at(time));
    const double radius = params_.radius.at(time);
    const double a = uniform(key, PlaceA), b = uniform(key, PlaceB), c = uniform(key, PlaceC);
    Vec3d x, y;
    switch (params_.kind) {
        case SpoutKind::Point:
            return {center, axis};
        case SpoutKind::Disc:
            orthonormal_frame(axis, x, y);
            return {center + radius * std::sqrt(a) *
                                 (std::cos(2 * pi * b) * x + std::sin(2 * pi * b) * y),
                    axis};
        case SpoutKind::Ball: {
            const Vec3d d = in_ball(a, b, c);
            return {center + radius * d, length(d) > 0 ? normalize(d) : axis};
        }
        case SpoutKind::Curve: {
            Spot s = on_curve(key);
            orthonormal_frame(s.normal, x, y);
            s.point += center + radius * std::sqrt(b) *
                                    (std::cos(2 * pi * c) * x + std::sin(2 * pi * c) * y);
            return s;
        }
        case SpoutKind::Mesh:
            break;
    }
    Spot s = on_mesh(key);
    s.point += center;
    return s;
}

void Spout::emit(double from, double to, Particles& particles, std::vector<double>& birth) const {
    const double begin = count_.at(from), end = count_.at(to);
    // Candidates, whose own random number decides whether they fall into the step.
    std::vector<std::uint64_t> born;
    std::vector<double> moment;
    for (double k = std::floor(begin); k < end; k += 1) {
        const auto id = first_id_ + static_cast<std::uint64_t>(k);
        const double at = k + uniform(random_key(seed_, id), Birth);
        if (at < begin || at >= end) continue;
        born.push_back(id);
        moment.push_back(at);
    }
    const std::size_t first = particles.size();
    particles.resize(first + born.size());
    birth.resize(birth.size() + born.size());
    double* when = birth.data() + (birth.size() - born.size());
    parallel_for(static_cast<int>(born.size()), 1024, [&](int n) {
        const auto j = static_cast<std::size_t>(n), i = first + j;
        const std::uint64_t key = random_key(seed_, born[j]);
        const double time = count_.time_of(moment[j], from, to);
        const Spot place = spot(time, key);
        const Vec3d axis =
            params_.along_normal ? place.normal : normalize(params_.direction.at(time));
        const double speed = spread(params_.speed.at(time), params_.speed_spread, key, Speed);
        const Vec3d own =
            params_.inherit == 0 ? Vec3d() : params_.inherit * params_.position.rate(time);
        const Vec3d way =
            in_cone(axis, radians(params_.cone_degrees), uniform(key, ConeA), uniform(key, ConeB));
        when[j] = time;
        particles.position[i] = place.point;
        particles.velocity[i] = Vec3f(speed * way + own);
        particles.age[i] = 0;
        particles.life[i] =
            static_cast<float>(spread(params_.life.at(time), params_.life_spread, key, Life));
        particles.radius[i] = static_cast<float>(
            spread(params_.particle_radius.at(time), params_.radius_spread, key, Radius));
        particles.id[i] = born[j];
    });
}

double most_alive(const SpoutParams& params) {
    const double rate = *std::max_element(params.rate.v.begin(), params.rate.v.end()),
                 life = *std::max_element(params.life.v.begin(), params.life.v.end());
    return rate * life;
}

}  // namespace gischt
