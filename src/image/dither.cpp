// SPDX-License-Identifier: Apache-2.0
#include "image/dither.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/random.h"

namespace gischt {
namespace {

constexpr int size = dither_size, count = size * size;

// A binary pattern on a torus and its blurred copy, whose maximum over the ones is the tightest
// cluster and whose minimum over the zeros is the largest void.
class Pattern {
  public:
    Pattern() : set_(count, false), blur_(count, 0) {
        for (int j = -reach; j <= reach; ++j) {
            for (int i = -reach; i <= reach; ++i) {
                // Gaussian of 1.5 pixels, Ulichney's choice; integers keep ties and sums exact.
                const double g = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
                kernel_[at(j + reach)][at(i + reach)] = static_cast<int>(std::lround(g * 65536));
            }
        }
    }
    bool has(int p) const { return set_[at(p)]; }
    void flip(int p) {
        const int sign = has(p) ? -1 : 1, x = p % size, y = p / size;
        set_[at(p)] = !has(p);
        for (int j = -reach; j <= reach; ++j) {
            for (int i = -reach; i <= reach; ++i) {
                const int q = (y + j + size) % size * size + (x + i + size) % size;
                blur_[at(q)] += sign * kernel_[at(j + reach)][at(i + reach)];
            }
        }
    }
    int tightest_cluster() const { return extreme(true, 1); }
    int largest_void() const { return extreme(false, -1); }

  private:
    static constexpr int reach = 7;
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    int extreme(bool ones, int sign) const {
        int best = -1;
        for (int p = 0; p < count; ++p) {
            if (has(p) != ones) continue;
            if (best < 0 || sign * blur_[at(p)] > sign * blur_[at(best)]) best = p;
        }
        return best;
    }

    std::vector<bool> set_;
    std::vector<int> blur_;
    std::array<std::array<int, 2 * reach + 1>, 2 * reach + 1> kernel_{};
};

// A tenth of the pixels at random, then moved from clusters to voids until nothing moves.
Pattern initial_pattern(int ones) {
    Pattern p;
    const std::uint64_t key = random_key(1993);
    for (std::uint32_t k = 0, placed = 0; placed < static_cast<std::uint32_t>(ones); ++k) {
        const int q = static_cast<int>(random_bits(key, k) % count);
        if (p.has(q)) continue;
        p.flip(q);
        ++placed;
    }
    while (true) {
        const int cluster = p.tightest_cluster();
        p.flip(cluster);
        const int gap = p.largest_void();
        p.flip(gap);
        if (gap == cluster) return p;
    }
}

// Ranks below the initial pattern by taking clusters away, those above it by filling voids.
std::vector<float> make_thresholds() {
    const int ones = count / 10;
    const Pattern start = initial_pattern(ones);
    std::vector<float> threshold(count);
    auto set_rank = [&](int p, int rank) {
        threshold[static_cast<std::size_t>(p)] = (static_cast<float>(rank) + 0.5f) / count;
    };
    Pattern p = start;
    for (int rank = ones - 1; rank >= 0; --rank) {
        const int q = p.tightest_cluster();
        p.flip(q);
        set_rank(q, rank);
    }
    p = start;
    for (int rank = ones; rank < count; ++rank) {
        const int q = p.largest_void();
        p.flip(q);
        set_rank(q, rank);
    }
    return threshold;
}

}  // namespace

float dither_threshold(int x, int y, int channel) {
    static const std::vector<float> table = make_thresholds();
    // Shifts far from each other in both directions.
    const int i = (x + 23 * channel) & (size - 1), j = (y + 41 * channel) & (size - 1);
    return table[static_cast<std::size_t>(j * size + i)];
}

}  // namespace gischt
