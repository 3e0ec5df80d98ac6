// SPDX-License-Identifier: Apache-2.0
#include "optics/distribution.h"

#include <algorithm>

namespace gischt {
namespace {

// First i with cdf[i] <= u < cdf[i + 1] among n intervals, plus where in it u lies.
double invert(const double* cdf, int n, double u) {
    const double* above = std::upper_bound(cdf + 1, cdf + n, u);
    const auto i = above - cdf - 1;
    const double width = cdf[i + 1] - cdf[i];
    const double inside = width > 0 ? std::clamp((u - cdf[i]) / width, 0.0, 1.0) : 0.5;
    return static_cast<double>(i) + inside;
}

}  // namespace

Distribution2d::Distribution2d(std::vector<double> weights, int columns, int rows)
    : columns_(columns), rows_(rows), density_(std::move(weights)) {
    const auto nx = static_cast<std::size_t>(columns), ny = static_cast<std::size_t>(rows);
    double total = 0;
    for (const double w : density_) total += w;
    if (!(total > 0)) {
        std::fill(density_.begin(), density_.end(), 1.0);
        total = static_cast<double>(nx * ny);
    }
    row_cdf_.assign(ny + 1, 0);
    column_cdf_.assign(ny * (nx + 1), 0);
    for (std::size_t r = 0; r < ny; ++r) {
        double* cdf = &column_cdf_[r * (nx + 1)];
        for (std::size_t c = 0; c < nx; ++c) cdf[c + 1] = cdf[c] + density_[r * nx + c];
        const double sum = cdf[nx];
        for (std::size_t c = 1; c <= nx && sum > 0; ++c) cdf[c] /= sum;
        cdf[nx] = 1;
        row_cdf_[r + 1] = row_cdf_[r] + sum / total;
    }
    row_cdf_[ny] = 1;
    for (double& d : density_) d *= static_cast<double>(nx * ny) / total;
}

Vec2d Distribution2d::sample(Vec2f u) const {
    const double y = invert(row_cdf_.data(), rows_, static_cast<double>(u.y));
    const auto row = static_cast<std::size_t>(std::min(static_cast<int>(y), rows_ - 1));
    const double* cdf = &column_cdf_[row * (static_cast<std::size_t>(columns_) + 1)];
    const double x = invert(cdf, columns_, static_cast<double>(u.x));
    return {x / columns_, y / rows_};
}

double Distribution2d::density(const Vec2d& point) const {
    const int x = std::clamp(static_cast<int>(point.x * columns_), 0, columns_ - 1);
    const int y = std::clamp(static_cast<int>(point.y * rows_), 0, rows_ - 1);
    return density_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(x)];
}

}  // namespace gischt
