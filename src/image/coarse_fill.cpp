// SPDX-License-Identifier: Apache-2.0
#include "image/coarse_fill.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/parallel.h"
#include "image/coarse_order.h"

namespace gischt {
namespace {

using Plane = std::vector<float>;

// Sums over the samples of blocks of one size.
struct Blocks {
    int edge, width, height;  // pixels, blocks, blocks

    Blocks(int edge_, const Film& film)
        : edge(edge_),
          width((film.width() + edge_ - 1) / edge_),
          height((film.height() + edge_ - 1) / edge_) {}

    std::size_t at(int bx, int by) const {
        return static_cast<std::size_t>(by) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(bx);
    }

    // Of the pixels that have a sample.
    template <class Value>
    Plane sums(const Film& film, const Value& value) const {
        Plane out(at(0, height), 0.0f);
        for (int y = 0; y < film.height(); ++y) {
            for (int x = 0; x < film.width(); ++x) {
                if (film.samples(x, y) > 0) out[at(x / edge, y / edge)] += value(x, y);
            }
        }
        return out;
    }

    // Binomial weights over 9 x 9 blocks: a standard deviation of sqrt(2) blocks.
    Plane blurred(const Plane& in) const {
        constexpr int radius = 4;
        constexpr std::array<float, 2 * radius + 1> weights{1, 8, 28, 56, 70, 56, 28, 8, 1};
        Plane rows(in.size(), 0.0f), out(in.size(), 0.0f);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int d = std::max(-radius, -x); d <= std::min(radius, width - 1 - x); ++d)
                    rows[at(x, y)] +=
                        weights[static_cast<std::size_t>(d + radius)] * in[at(x + d, y)];
            }
        }
        for (int y = 0; y < height; ++y) {
            for (int d = std::max(-radius, -y); d <= std::min(radius, height - 1 - y); ++d) {
                const float w = weights[static_cast<std::size_t>(d + radius)];
                for (int x = 0; x < width; ++x) out[at(x, y)] += w * rows[at(x, y + d)];
            }
        }
        return out;
    }

    // Takes the blocks away that have one without mark next to them.
    void erode(std::vector<char>& marks) const {
        const std::vector<char> from = marks;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
                    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
                        if (!from[at(i, j)]) marks[at(x, y)] = 0;
                }
            }
        }
    }

    // Linear between the centres of blocks.
    float between(const Plane& in, int x, int y) const {
        const float fx = (static_cast<float>(x) + 0.5f) / static_cast<float>(edge) - 0.5f,
                    fy = (static_cast<float>(y) + 0.5f) / static_cast<float>(edge) - 0.5f;
        const int x0 = std::clamp(static_cast<int>(fx), 0, width - 1),
                  y0 = std::clamp(static_cast<int>(fy), 0, height - 1);
        const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
        const float u = std::clamp(fx - static_cast<float>(x0), 0.0f, 1.0f),
                    v = std::clamp(fy - static_cast<float>(y0), 0.0f, 1.0f);
        return (1 - v) * ((1 - u) * in[at(x0, y0)] + u * in[at(x1, y0)]) +
               v * ((1 - u) * in[at(x0, y1)] + u * in[at(x1, y1)]);
    }
};

// The edge of the blocks that a pixel is made of; 1 where it stays as it is.
std::vector<unsigned char> edges_of(const Film& film) {
    const auto w = static_cast<std::size_t>(film.width());
    std::vector<unsigned char> out(w * static_cast<std::size_t>(film.height()),
                                   CoarseOrder::coarsest);
    for (int edge = CoarseOrder::coarsest / 2; edge > 0; edge /= 2) {
        const Blocks small(edge, film), large(2 * edge, film);
        const Plane count = small.sums(film, [](int, int) { return 1.0f; });
        std::vector<char> complete(large.at(0, large.height), 1);
        for (int y = 0; y < small.height; ++y) {
            for (int x = 0; x < small.width; ++x) {
                if (count[small.at(x, y)] == 0) complete[large.at(x / 2, y / 2)] = 0;
            }
        }
        // With a sample in every block around, as the mean wants it.
        if (edge > 1) large.erode(complete);
        for (int y = 0; y < film.height(); ++y) {
            for (int x = 0; x < film.width(); ++x) {
                if (complete[large.at(x / (2 * edge), y / (2 * edge))])
                    out[static_cast<std::size_t>(y) * w + static_cast<std::size_t>(x)] =
                        static_cast<unsigned char>(edge);
            }
        }
    }
    return out;
}

// That of the block's first pixel with a sample.
void fill_depth(const Film& film, std::vector<float>& depth, const Image& image) {
    const CoarseOrder order(film.width(), film.height());
    for (int y = 0; y < film.height(); ++y) {
        for (int x = 0; x < film.width(); ++x) {
            Vec2i source{x, y};
            for (int edge = 2; film.samples(source.x, source.y) == 0; edge *= 2) {
                if (edge > CoarseOrder::coarsest) break;
                source = order.first_of(x, y, edge);
            }
            depth[image.index(x, y)] = depth[image.index(source.x, source.y)];
        }
    }
}

}  // namespace

void fill_coarse(const Film& film, Image& image) {
    const auto& pixels = film.pixels();
    if (std::all_of(pixels.begin(), pixels.end(), [](const FilmPixel& p) { return p.count > 0; }))
        return;
    const std::vector<unsigned char> edges = edges_of(film);
    for (auto& plane : image.planes) {
        if (plane.name == "Z") {
            fill_depth(film, plane.values, image);
            continue;
        }
        const auto from = plane.values;
        for (int edge = 2; edge <= CoarseOrder::coarsest; edge *= 2) {
            if (std::find(edges.begin(), edges.end(), edge) == edges.end()) continue;
            const Blocks blocks(edge, film);
            const Plane count = blocks.blurred(blocks.sums(film, [](int, int) { return 1.0f; }));
            const Plane sum = blocks.blurred(
                blocks.sums(film, [&](int x, int y) { return from[image.index(x, y)]; }));
            parallel_for(film.height(), 16, [&](int y) {
                for (int x = 0; x < film.width(); ++x) {
                    const std::size_t i = image.index(x, y);
                    if (edges[i] != edge) continue;
                    const float n = blocks.between(count, x, y);
                    plane.values[i] = n > 0 ? blocks.between(sum, x, y) / n : 0.0f;
                }
            });
        }
    }
}

}  // namespace gischt
