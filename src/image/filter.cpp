// SPDX-License-Identifier: Apache-2.0
#include "image/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"

namespace gischt {
namespace {

constexpr std::array<FilterKind, 4> kinds{FilterKind::Box, FilterKind::Gaussian,
                                          FilterKind::Mitchell, FilterKind::BlackmanHarris};
const std::array<std::string, 4> names{"box", "gaussian", "mitchell", "blackman_harris"};

// Bins of the tabulated distribution: a bin is 1.5/512 of a pixel wide, far below what is seen.
constexpr int bins = 512;

// Mitchell & Netravali 1988, equation 8 with B = C = 1/3, for |x| in [0, 2].
double mitchell(double x) {
    x = std::abs(x);
    if (x < 1) return (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6;
    return (-7.0 / 3 * x * x * x + 12 * x * x - 20 * x + 32.0 / 3) / 6;
}

// Harris 1978, minimum 4-term window; t in [-1, 1].
double blackman_harris(double t) {
    return 0.35875 + 0.48829 * std::cos(pi * t) + 0.14128 * std::cos(2 * pi * t) +
           0.01168 * std::cos(3 * pi * t);
}

}  // namespace

FilterKind filter_kind(std::string_view name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return kinds[i];
    }
    throw Error(ErrorKind::Usage, "film", fmt::format("unknown filter '{}'", name),
                hint_for(name, names));
}

float default_radius(FilterKind kind) {
    switch (kind) {
        case FilterKind::Box:
            return 0.5f;
        case FilterKind::Mitchell:
            return 2;
        case FilterKind::Gaussian:
        case FilterKind::BlackmanHarris:
            break;
    }
    return 1.5f;
}

ReconstructionFilter::ReconstructionFilter(FilterKind kind, float radius)
    : kind_(kind), radius_(radius > 0 ? radius : default_radius(kind)) {
    if (!(radius_ <= 16)) {
        throw Error(ErrorKind::Usage, "film", fmt::format("filter radius {} px", radius_),
                    "at most 16 pixels; common are 0.5 to 2");
    }
    // The integrals of f1 and |f1| over [0, radius], and the running one of |f1| for the inversion.
    double net = 0, total = 0;
    std::vector<double> sums{0};
    for (int i = 0; i < bins; ++i) {
        const double f = profile((i + 0.5) / bins * radius_);
        net += f;
        total += std::abs(f);
        sums.push_back(total);
    }
    mean_weight_ = (net / total) * (net / total);
    for (const double s : sums) cdf_.push_back(static_cast<float>(s / total));
}

double ReconstructionFilter::profile(double x) const {
    const double r = radius_;
    if (std::abs(x) > r) return 0;
    switch (kind_) {
        case FilterKind::Box:
            return 1;
        case FilterKind::Mitchell:
            return mitchell(2 * x / r);
        case FilterKind::BlackmanHarris:
            return blackman_harris(x / r);
        case FilterKind::Gaussian:
            break;
    }
    const double s = r / 3;
    return std::exp(-x * x / (2 * s * s)) - std::exp(-r * r / (2 * s * s));
}

FilterSample ReconstructionFilter::sample(Vec2f u) const {
    float weight = 1;
    const float x = sample_axis(u.x, weight), y = sample_axis(u.y, weight);
    return {{x, y}, weight};
}

float ReconstructionFilter::sample_axis(float u, float& sign) const {
    // u in [0,1) becomes a side and the share of |f1| between the centre and the sample.
    const float t = 2 * u - 1, share = std::abs(t);
    if (kind_ == FilterKind::Box) return t * radius_;

    const auto next = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, share);
    const auto bin = static_cast<int>(next - cdf_.begin()) - 1;
    const float lo = *(next - 1), hi = *next;
    const float f = hi > lo ? std::clamp((share - lo) / (hi - lo), 0.0f, 1.0f) : 0.5f;
    // Only Mitchell's filter has negative lobes: its bins beyond the zero at 4/7 of the radius.
    if (kind_ == FilterKind::Mitchell && mitchell(2 * (bin + 0.5) / bins) < 0) sign = -sign;
    return std::copysign((static_cast<float>(bin) + f) / bins * radius_, t);
}

}  // namespace gischt
