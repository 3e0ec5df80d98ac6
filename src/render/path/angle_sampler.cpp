// SPDX-License-Identifier: Apache-2.0
#include "render/path/angle_sampler.h"

#include <algorithm>
#include <cmath>

#include "image/color.h"

namespace gischt {

void AngleSampler::aim(std::span<const Light* const> lights, const Ray& ray, double t0, double t1) {
    arcs_.clear();
    t0_ = t0;
    t1_ = t1;
    if (!(t0 < t1)) return;
    double sum = 0;
    for (const Light* light : lights) {
        const auto place = light->place();
        if (!place) continue;
        Arc arc;
        arc.nearest = dot(place->center - ray.origin, ray.direction);
        const Vec3d aside = ray.at(arc.nearest) - place->center;
        // A ray through the light, or from it, would only ever take its middle.
        const double size = length(place->center - ray.origin) + (std::isfinite(t1) ? t1 : t0);
        arc.distance = std::max({length(aside), 0.5 * place->radius, 1e-6 * size});
        arc.begin = std::atan((t0 - arc.nearest) / arc.distance);
        arc.angle = std::atan((t1 - arc.nearest) / arc.distance) - arc.begin;
        // Its light over the stretch by the midpoint rule in the angle, where the square law is
        // gone.
        constexpr int probes = 4;
        for (int i = 0; i < probes; ++i) {
            const double along =
                arc.distance * std::tan(arc.begin + (i + 0.5) / probes * arc.angle);
            const Vec3f arriving = light->mean_radiance(ray.at(arc.nearest + along));
            arc.share += static_cast<double>(luminance(arriving)) *
                         (arc.distance * arc.distance + along * along);
        }
        arc.share *= arc.angle / arc.distance;
        if (!(arc.angle > 0) || !(arc.share > 0) || !std::isfinite(arc.share)) continue;
        sum += arc.share;
        arcs_.push_back(arc);
    }
    for (Arc& arc : arcs_) arc.share /= sum;
}

double AngleSampler::sample(float u) const {
    double left = static_cast<double>(u);
    std::size_t i = 0;
    while (i + 1 < arcs_.size() && left >= arcs_[i].share) left -= arcs_[i++].share;
    const Arc& arc = arcs_[i];
    const double share = std::min(left / arc.share, 1.0);
    const double t = arc.nearest + arc.distance * std::tan(arc.begin + share * arc.angle);
    return std::clamp(t, t0_, t1_);
}

float AngleSampler::density(double t) const {
    double sum = 0;
    for (const Arc& arc : arcs_) {
        const double along = t - arc.nearest;
        sum +=
            arc.share * arc.distance / (arc.angle * (arc.distance * arc.distance + along * along));
    }
    return static_cast<float>(sum);
}

}  // namespace gischt
