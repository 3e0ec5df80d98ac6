// SPDX-License-Identifier: Apache-2.0
#include "image/resize.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace gischt {
namespace {

// A source pixel and the share of the new pixel's extent that it fills.
struct Tap {
    int source;
    double share;
};

// For every new pixel along an axis, the source pixels that it covers.
std::vector<std::vector<Tap>> covers(int from, int to) {
    std::vector<std::vector<Tap>> taps(static_cast<std::size_t>(to));
    const double scale = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        const double lo = i * scale, hi = std::min<double>((i + 1) * scale, from);
        for (int s = static_cast<int>(lo); s < from && s < hi; ++s) {
            const double overlap = std::min<double>(hi, s + 1) - std::max<double>(lo, s);
            // Slivers are rounding of the boundaries.
            if (overlap > 1e-9) taps[static_cast<std::size_t>(i)].push_back({s, overlap / scale});
        }
    }
    return taps;
}

}  // namespace

Image resize(const Image& image, int width, int height) {
    Image out(width, height, {});
    out.metadata = image.metadata;
    const auto columns = covers(image.width, width), rows = covers(image.height, height);
    for (const Channel& plane : image.planes) {
        const auto target = out.add_channel(plane.name);
        parallel_for(height, 4, [&](int y) {
            for (int x = 0; x < width; ++x) {
                double sum = 0;
                for (const Tap& r : rows[static_cast<std::size_t>(y)]) {
                    for (const Tap& c : columns[static_cast<std::size_t>(x)]) {
                        sum += r.share * c.share * plane.values[image.index(c.source, r.source)];
                    }
                }
                target[out.index(x, y)] = static_cast<float>(sum);
            }
        });
    }
    return out;
}

Image fit(const Image& image, int width, int height) {
    const double scale = std::min(static_cast<double>(width) / image.width,
                                  static_cast<double>(height) / image.height);
    auto scaled = [&](int side) {
        return std::max(1, static_cast<int>(std::lround(side * scale)));
    };
    return resize(image, scaled(image.width), scaled(image.height));
}

void paste(Image& image, const Image& part, int x, int y) {
    const int x0 = std::max(x, 0), x1 = std::min(x + part.width, image.width);
    const int y0 = std::max(y, 0), y1 = std::min(y + part.height, image.height);
    if (x0 >= x1) return;
    for (Channel& plane : image.planes) {
        const Channel* source = part.find(plane.name);
        if (!source) continue;
        for (int row = y0; row < y1; ++row) {
            const float* from = source->values.data() + part.index(x0 - x, row - y);
            std::copy_n(from, x1 - x0, plane.values.data() + image.index(x0, row));
        }
    }
}

}  // namespace gischt
