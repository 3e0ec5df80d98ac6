// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_gather.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "math/fast_math.h"

namespace gischt {
namespace {

// Optical depth behind which nothing is gathered: exp(-14) is below 1e-6.
constexpr float enough_depth = 14;

constexpr auto pi_f = static_cast<float>(pi);

// Epanechnikov's kernels, which have the least mean square error: over a disc and over a ball.
float over_disc(float distance2, float radius2) {
    return 2 / (pi_f * radius2) * (1 - distance2 / radius2);
}
float over_ball(float distance2, float radius2) {
    return 15 / (8 * pi_f * radius2 * std::sqrt(radius2)) * (1 - distance2 / radius2);
}

void add(EyeGather::Light& light, const Photon& photon, const Vec3f& radiance) {
    (photon.events > 1 ? light.more : light.once) += radiance;
}

}  // namespace

Vec3f PhotonLight::dimmed(const Vec3f& depth) const {
    if (scene_.path.is_grey) return Vec3f(fast_exp(-depth.x));
    return {fast_exp(-depth.x), fast_exp(-depth.y), fast_exp(-depth.z)};
}

void PhotonLight::allow(std::span<const Medium* const> media) {
    allowed_.assign(scene_.media.size(), 0);
    for (const Medium* m : media) {
        const int place = scene_.place_of(m);
        if (place >= 0) allowed_[static_cast<std::size_t>(place)] = 1;
    }
}

EyeGather::Light PhotonLight::along(const Ray& ray, const RayProfile& profile,
                                    std::span<const Medium* const> media, RandomStream random) {
    if (!map_ || map_->in_media.is_empty()) return {};
    allow(media);
    const double end = std::min(ray.t_max, profile.end_at(enough_depth));
    if (scene_.params.gather == PhotonGather::Points) return by_points(ray, profile, end, random);
    return by_beams(ray, profile, end);
}

// The beam radiance estimate (Jarosz, Zwicker, Jensen 2008, eq. 11): the sum over the photons near
// the ray of kernel * transmittance * phase function * power.
EyeGather::Light PhotonLight::by_beams(const Ray& ray, const RayProfile& profile, double end) {
    Light light;
    // Distances count from the point next to the map's origin, where float is fine.
    const double middle = dot(scene_.origin - ray.origin, ray.direction);
    const Vec3f origin(ray.at(middle) - scene_.origin), direction(ray.direction);
    const auto begin = static_cast<float>(ray.t_min - middle);
    const auto last = static_cast<float>(std::min(end - middle, 1e30));
    map_->in_media.along(
        origin, direction, begin, last,
        [&](std::uint32_t i, float t, float distance2, float radius2) {
            const Photon& photon = map_->in_media.photon(i);
            if (!allowed_[static_cast<std::size_t>(photon.place)]) return;
            ++gathered;
            const PhaseFunction& phase =
                scene_.media[static_cast<std::size_t>(photon.place)]->phase();
            const float scattering = value(phase, -dot(photon.direction, direction));
            const Vec3f transmittance = dimmed(profile.depth_to(middle + static_cast<double>(t)));
            add(light, photon,
                over_disc(distance2, radius2) * scattering * photon.power * transmittance);
        });
    return light;
}

// Marching: at places of the ray, half of them by what is seen of the medium and half evenly, the
// photons in a ball around (Jensen & Christensen 1998, eq. 16).
EyeGather::Light PhotonLight::by_points(const Ray& ray, const RayProfile& profile, double end,
                                        RandomStream& random) {
    Light light;
    if (profile.is_empty()) return light;
    const double begin = profile.begin();
    end = std::min(end, profile.end());
    if (!(end > begin)) return light;
    const int half = std::max(1, scene_.params.steps / 2);
    const auto n = static_cast<float>(half);
    places_.clear();
    profile.points(half, random.next(), random.next(), places_, lookups_);
    const float u = random.next();
    for (int i = 0; i < half; ++i) {
        const double share = (i + static_cast<double>(u)) / half;
        places_.push_back({begin + share * (end - begin), 0, {}});
    }
    for (const ProfilePoint& place : places_) {
        if (place.t > end) continue;
        const float density = n * profile.density(place.t) + n / static_cast<float>(end - begin);
        const Vec3f depth = profile.depth_to(place.t);
        const Light here = at_point(ray.at(place.t), -Vec3f(ray.direction), min_component(depth));
        const Vec3f weight = dimmed(depth) * (1 / density);
        light.once += weight * here.once;
        light.more += weight * here.more;
    }
    return light;
}

// What the media around a point scatter per metre, W/(m^3 sr).
EyeGather::Light PhotonLight::at_point(const Vec3d& point, const Vec3f& towards, float depth) {
    const auto& params = scene_.params;
    const float fewer = std::exp(-static_cast<float>(params.shrink) * depth);
    const int count = std::max(4, static_cast<int>(static_cast<float>(params.nearest) * fewer));
    const float radius2 =
        find(map_->in_media, Vec3f(point - scene_.origin), count, map_->shrunk_ball);
    Light light;
    for (const PhotonTree::Near& n : near_) {
        if (!(n.distance2 < radius2)) continue;
        const Photon& photon = map_->in_media.photon(n.photon);
        if (!allowed_[static_cast<std::size_t>(photon.place)]) continue;
        ++gathered;
        const PhaseFunction& phase = scene_.media[static_cast<std::size_t>(photon.place)]->phase();
        add(light, photon,
            over_ball(n.distance2, radius2) * value(phase, dot(photon.direction, towards)) *
                photon.power);
    }
    return light;
}

// Of k neighbours the farthest only tells the radius: given that, the k - 1 others are spread as
// the photons are, and the estimate has no bias but that of the radius, which further passes
// shrink.
float PhotonLight::find(const PhotonTree& tree, const Vec3f& point, int count, float shrunk) {
    const bool is_fixed = scene_.params.radius > 0;
    const float most = map_->most * (is_fixed ? shrunk : 1);
    tree.nearest(point, is_fixed ? 1'000'000 : count, most * most, near_);
    const bool is_full = !is_fixed && near_.size() == static_cast<std::size_t>(count);
    const float reach = is_full ? std::sqrt(near_.front().distance2) : most;
    const float radius = is_fixed ? reach : reach * shrunk;
    return radius * radius;
}

EyeGather::Light PhotonLight::at(const SurfaceHit& hit, const Bsdf& bsdf, const Vec3d& out) {
    Light light;
    if (!map_ || map_->on_surfaces.is_empty()) return light;
    const Vec3f point(hit.point - scene_.origin), normal(hit.normal);
    const float radius2 = find(map_->on_surfaces, point, scene_.params.nearest, map_->shrunk_disc);
    for (const PhotonTree::Near& n : near_) {
        if (!(n.distance2 < radius2)) continue;
        const Photon& photon = map_->on_surfaces.photon(n.photon);
        if (photon.place != hit.surface) continue;
        // The other side of a thin sheet is not this one, nor is what lies round a corner.
        const float above = dot(photon.position - point, normal);
        if (above * above > 0.1f * radius2) continue;
        const float cosine = std::abs(dot(photon.direction, normal));
        if (cosine < 1e-4f) continue;
        ++gathered;
        const Vec3f scattering = bsdf.value(out, -Vec3d(photon.direction)) * (1 / cosine);
        add(light, photon, over_disc(n.distance2, radius2) * scattering * photon.power);
    }
    return light;
}

}  // namespace gischt
