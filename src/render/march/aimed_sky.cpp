// SPDX-License-Identifier: Apache-2.0
#include "render/march/aimed_sky.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gischt {
namespace {

// Mean of max(0, x) for x spread evenly over [c - r, c + r].
float mean_positive(float c, float r) {
    const float low = std::max(c - r, 0.0f), high = std::max(c + r, 0.0f);
    return 0.25f * (high * high - low * low) / r;
}

// The first of the rising sums that exceeds u times the last; u becomes the place within it.
std::size_t choose(const float* sums, std::size_t count, float& u) {
    const float target = u * sums[count - 1];
    const auto found =
        static_cast<std::size_t>(std::upper_bound(sums, sums + count - 1, target) - sums);
    const float before = found > 0 ? sums[found - 1] : 0.0f;
    u = std::clamp((target - before) / (sums[found] - before), 0.0f, 0x1.fffffep-1f);
    return found;
}

}  // namespace

AimedSky::AimedSky(const Light& light) : light_(&light) {
    constexpr int probes = 5;  // along each edge of a cell
    for (int c = 0; c < cells; ++c) {
        std::vector<Vec3d> directions;
        Vec3d sum;
        for (int p = 0; p < probes * probes; ++p) {
            const double u = (c % edge + (p % probes + 0.5) / probes) / edge,
                         v = (c / edge + (p / probes + 0.5) / probes) / edge;
            directions.push_back(
                light.sample({}, {static_cast<float>(u), static_cast<float>(v)}).direction);
            sum += directions.back();
        }
        const Vec3d mean = sum / Vec3d(probes * probes);
        double spread = 0;
        for (const Vec3d& d : directions) spread = std::max(spread, length(d - mean));
        const auto i = static_cast<std::size_t>(c);
        x_[i] = static_cast<float>(mean.x);
        y_[i] = static_cast<float>(mean.y);
        z_[i] = static_cast<float>(mean.z);
        // The probes leave out a tenth of the cell on each side.
        spread_[i] = std::max(1e-4f, static_cast<float>(1.3 * spread));
    }
}

void AimedSky::aim(const Vec3d& normal) {
    if (normal_ && *normal_ == normal) return;
    normal_ = normal;
    const Vec3f n(normal);
    for (std::size_t i = 0; i < cells; ++i) {
        until_[i] = mean_positive(x_[i] * n.x + y_[i] * n.y + z_[i] * n.z, spread_[i]);
    }
    // No cell is left out: the spread is a guess, and a direction that is never drawn is a bias.
    float all = 0;
    for (std::size_t row = 0; row < edge; ++row) {
        float sum = 0;
        for (std::size_t i = row * edge; i < (row + 1) * edge; ++i)
            until_[i] = sum += until_[i] + 2e-3f;
        row_until_[row] = all += sum;
    }
}

AimedSky::Direction AimedSky::operator()(Vec2f u) const {
    const std::size_t row = choose(row_until_.data(), edge, u.y);
    const float* sums = until_.data() + row * edge;
    const std::size_t column = choose(sums, edge, u.x);
    const float probability =
        (sums[column] - (column > 0 ? sums[column - 1] : 0.0f)) / row_until_[edge - 1];
    const LightSample s = light_->sample(
        {}, {(static_cast<float>(column) + u.x) / edge, (static_cast<float>(row) + u.y) / edge});
    const double cosine = dot(s.direction, *normal_);
    if (cosine <= 0) return {s.direction, {}};
    return {s.direction, s.weight * (static_cast<float>(cosine) / (cells * probability))};
}

}  // namespace gischt
