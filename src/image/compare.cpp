// SPDX-License-Identifier: Apache-2.0
#include "image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace gischt {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Planes = std::array<std::span<const float>, 3>;

double mean(const Planes& planes) {
    double sum = 0;
    for (const auto& plane : planes) {
        for (const float v : plane) sum += std::isfinite(v) ? v : 0;
    }
    return sum / (3.0 * static_cast<double>(planes[0].size()));
}

void note_largest(Comparison& r, double difference, std::size_t i, int width, std::size_t c) {
    if (!(difference > r.max_difference)) return;
    r.max_difference = difference;
    r.max_x = static_cast<int>(i % static_cast<std::size_t>(width));
    r.max_y = static_cast<int>(i / static_cast<std::size_t>(width));
    r.max_channel = "RGB"[c];
}

}  // namespace

Comparison compare(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height) {
        throw Error(
            ErrorKind::Input, "compare",
            fmt::format("sizes differ: {} x {} and {} x {}", a.width, a.height, b.width, b.height));
    }
    const Planes pa = a.color(), pb = b.color();
    Comparison r;
    r.mean_a = mean(pa);
    r.mean_b = mean(pb);
    const double floor_2 = 0.01 * r.mean_b * r.mean_b;
    double sum = 0, relative = 0, peak = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < pa[c].size(); ++i) {
            const double va = pa[c][i], vb = pb[c][i];
            if (!std::isfinite(va) || !std::isfinite(vb)) {
                if (va == vb) continue;
                ++r.not_finite;
                note_largest(r, infinity, i, a.width, c);
                continue;
            }
            const double d = va - vb, scale = vb * vb + floor_2;
            sum += d * d;
            relative += d == 0 ? 0 : scale > 0 ? d * d / scale : infinity;
            peak = std::max(peak, std::abs(vb));
            note_largest(r, std::abs(d), i, a.width, c);
        }
    }
    const double count = 3.0 * static_cast<double>(a.pixel_count());
    r.mse = r.not_finite > 0 ? infinity : sum / count;
    r.rel_mse = r.not_finite > 0 ? infinity : relative / count;
    r.rmse = std::sqrt(r.mse);
    r.ratio = r.mean_a == r.mean_b ? 1 : r.mean_a / r.mean_b;
    r.psnr = r.mse > 0 ? 10 * std::log10(peak * peak / r.mse) : infinity;
    return r;
}

}  // namespace gischt
