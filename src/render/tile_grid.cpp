// SPDX-License-Identifier: Apache-2.0
#include "render/tile_grid.h"

#include <algorithm>

#include "base/parallel.h"

namespace gischt {

PixelTile TileGrid::at(int number) const {
    const int x0 = number % columns_ * edge_, y0 = number / columns_ * edge_;
    return {x0, y0, std::min(x0 + edge_, width_), std::min(y0 + edge_, height_)};
}

std::vector<char> TileGrid::noisy(const Film& film, double noise) const {
    // Sums per tile over its pixels in fixed order.
    std::vector<double> variance(count()), mean(count());
    parallel_for(static_cast<int>(count()), 16, [&](int t) {
        const PixelTile tile = at(t);
        double variances = 0, means = 0;
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                variances += film.variance(x, y);
                means += film.mean_luminance(x, y);
            }
        }
        variance[static_cast<std::size_t>(t)] = variances;
        mean[static_cast<std::size_t>(t)] = means;
    });
    const double pixels = static_cast<double>(width_) * height_;
    const double bound = noise * noise * tree_sum(mean) / pixels;

    std::vector<char> out(count(), 0);
    for (int t = 0; t < static_cast<int>(count()); ++t) {
        if (!(variance[static_cast<std::size_t>(t)] > bound * mean[static_cast<std::size_t>(t)]))
            continue;
        const int column = t % columns_, row = t / columns_;
        for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
            for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
                out[static_cast<std::size_t>(r * columns_ + c)] = 1;
            }
        }
    }
    return out;
}

}  // namespace gischt
