// SPDX-License-Identifier: Apache-2.0
#include "math/pixel_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <set>
#include <vector>

#include "base/units.h"

namespace gischt {
namespace {

// The stratum of a number among 2^bits.
int stratum(float u, int bits) {
    return static_cast<int>(std::ldexp(u, bits));
}

TEST(PixelSampler, EverySampleRangeOfAPixelStratifiesTheSquare) {
    for (const std::uint32_t dimension : {0u, 3u, 31u}) {
        for (const int bits : {2, 5, 8}) {
            const std::uint32_t n = 1u << bits;
            for (std::uint32_t first = 0; first < 3 * n; first += n) {
                for (int split = 0; split <= bits; ++split) {
                    std::set<std::pair<int, int>> seen;
                    for (std::uint32_t s = first; s < first + n; ++s) {
                        const Vec2f u = PixelSampler(7, 2, 37, 1001, s).two(dimension);
                        seen.insert({stratum(u.x, split), stratum(u.y, bits - split)});
                    }
                    EXPECT_EQ(seen.size(), n) << bits << " " << split;
                }
            }
        }
    }
}

// The claim of pixel_sampler.cpp: 2^j samples of a block of 2^m pixels, each component.
TEST(PixelSampler, BlocksOfPixelsStratifyEachComponentTogether) {
    for (const std::uint32_t dimension : {0u, 5u}) {
        for (int m = 0; m <= 6; m += 2) {
            for (int j = 0; j <= 4; ++j) {
                const int edge = 1 << m / 2;
                std::set<int> x, y;
                for (int p = 0; p < edge * edge; ++p) {
                    for (std::uint32_t s = 0; s < 1u << j; ++s) {
                        const Vec2f u =
                            PixelSampler(3, 1, 640 + p % edge, 64 + p / edge, s).two(dimension);
                        x.insert(stratum(u.x, m + j));
                        y.insert(stratum(u.y, m + j));
                    }
                }
                EXPECT_EQ(x.size(), 1u << (m + j)) << m << " " << j;
                EXPECT_EQ(y.size(), 1u << (m + j)) << m << " " << j;
            }
        }
    }
}

TEST(PixelSampler, OneSamplePerPixelOfABlockIsANet) {
    for (const std::uint32_t dimension : {0u, 9u}) {
        for (int split = 0; split <= 6; ++split) {
            std::set<std::pair<int, int>> seen;
            for (int p = 0; p < 64; ++p) {
                const Vec2f u = PixelSampler(11, 5, 8 + p % 8, 16 + p / 8, 0).two(dimension);
                seen.insert({stratum(u.x, split), stratum(u.y, 6 - split)});
            }
            EXPECT_EQ(seen.size(), 64u) << split;
        }
    }
}

// Chi-squared of counts against equal expectations, as standard deviations from its mean.
double chi_squared_score(const std::vector<int>& counts, int total) {
    const double expected = static_cast<double>(total) / static_cast<double>(counts.size());
    double chi = 0;
    for (const int c : counts) chi += (c - expected) * (c - expected) / expected;
    const double freedom = static_cast<double>(counts.size()) - 1;
    return (chi - freedom) / std::sqrt(2 * freedom);
}

// Over seeds, which are independent, the numbers of one sample of one pixel are uniform, and those
// of two dimensions, two pixels or two samples are independent. 26 tests at 4.5 standard deviations
// of a chi-squared of 255 degrees: a family-wise significance of about 1e-3.
TEST(PixelSampler, UniformAndIndependentAcrossDimensions) {
    struct Pair {
        std::uint32_t a, b;
    };
    const std::function<float(const PixelSampler&, std::uint32_t)> parts[] = {
        [](const PixelSampler& s, std::uint32_t d) { return s.two(d).x; },
        [](const PixelSampler& s, std::uint32_t d) { return s.two(d).y; }};
    const int n = 65536;
    for (const Pair pair :
         {Pair{0, 1}, Pair{0, 2}, Pair{3, 31}, Pair{31, 32}, Pair{32, 33}, Pair{100, 227}}) {
        for (const auto& part : parts) {
            std::vector<int> cells(256);
            for (int i = 0; i < n; ++i) {
                const PixelSampler s(static_cast<std::uint64_t>(i), 1, 17, 4, 6);
                ++cells[static_cast<std::size_t>(16 * stratum(part(s, pair.a), 4) +
                                                 stratum(part(s, pair.b), 4))];
            }
            EXPECT_LT(std::abs(chi_squared_score(cells, n)), 4.5) << pair.a << " " << pair.b;
        }
    }
    // Both components of one dimension, of neighbouring pixels and of two samples.
    for (const std::uint32_t dimension : {0u, 40u}) {
        std::vector<int> components(256), frames(256);
        for (int i = 0; i < n; ++i) {
            const auto seed = static_cast<std::uint64_t>(i);
            const Vec2f u = PixelSampler(seed, 1, 5, 9, 3).two(dimension);
            const Vec2f next = PixelSampler(seed, 2, 5, 9, 3).two(dimension);
            ++components[static_cast<std::size_t>(16 * stratum(u.x, 4) + stratum(u.y, 4))];
            ++frames[static_cast<std::size_t>(16 * stratum(u.x, 4) + stratum(next.x, 4))];
        }
        EXPECT_LT(std::abs(chi_squared_score(components, n)), 4.5);
        EXPECT_LT(std::abs(chi_squared_score(frames, n)), 4.5);
    }
}

// A picture's samples in padded dimensions must not move together: the pairs (x of a, x of b) of
// all samples of one pixel fill the square as independent numbers do.
TEST(PixelSampler, PaddedDimensionsOfOnePixelFillTheSquare) {
    const int n = 16384;
    for (std::uint32_t b = 1; b < 20; ++b) {
        std::vector<int> cells(256);
        for (int i = 0; i < n; ++i) {
            const PixelSampler s(5, 1, 300, 200, static_cast<std::uint32_t>(i));
            ++cells[static_cast<std::size_t>(16 * stratum(s.two(0).x, 4) + stratum(s.two(b).x, 4))];
        }
        EXPECT_LT(chi_squared_score(cells, n), 4.5) << b;
    }
}

TEST(PixelSampler, StreamIsUniformAndRepeats) {
    const PixelSampler s(1, 1, 2, 3, 4);
    HashStream a = s.stream(3), b = s.stream(3), other = s.stream(4);
    std::vector<int> cells(256);
    const int n = 65536;
    for (int i = 0; i < n; ++i) {
        const float u = a.next();
        EXPECT_EQ(u, b.next());
        ++cells[static_cast<std::size_t>(16 * stratum(u, 4) + stratum(other.next(), 4))];
    }
    EXPECT_LT(std::abs(chi_squared_score(cells, n)), 4.5);
}

// Share of the error's power in the lowest frequencies of a picture, those below 1/8 of the
// sampling rate in both directions, where white noise has (its share of all frequencies) 1/16.
double low_frequency_share(const std::function<double(int, int)>& error) {
    constexpr int edge = 64;
    using Complex = std::complex<double>;
    auto transform = [](std::vector<Complex>& line) {
        std::vector<Complex> out(edge);
        for (std::size_t k = 0; k < edge; ++k) {
            for (std::size_t i = 0; i < edge; ++i) {
                out[k] += line[i] * std::polar(1.0, -2 * pi * static_cast<double>(k * i) / edge);
            }
        }
        line = out;
    };
    std::vector<std::vector<Complex>> rows(edge, std::vector<Complex>(edge));
    for (std::size_t y = 0; y < edge; ++y) {
        for (std::size_t x = 0; x < edge; ++x) {
            rows[y][x] = error(static_cast<int>(x), static_cast<int>(y));
        }
        transform(rows[y]);
    }
    double low = 0, all = 0;
    for (std::size_t x = 0; x < edge; ++x) {
        std::vector<Complex> column(edge);
        for (std::size_t y = 0; y < edge; ++y) column[y] = rows[y][x];
        transform(column);
        const std::size_t fx = std::min(x, edge - x);
        for (std::size_t y = 0; y < edge; ++y) {
            const std::size_t fy = std::min(y, edge - y);
            if (fx + fy == 0) continue;
            all += std::norm(column[y]);
            if (fx < 8 && fy < 8) low += std::norm(column[y]);
        }
    }
    return low / all;
}

// The error of a picture of a smooth function, an edge and a quarter disc has little power in low
// frequencies: less than 60 % of white noise's at 1 to 4 samples (here 12 to 50 %).
TEST(PixelSampler, ErrorOfFewSamplesIsBlueNoiseOnTheScreen) {
    struct Case {
        std::function<double(Vec2f)> f;
        double mean;
    };
    const Case cases[] = {{[](Vec2f u) { return static_cast<double>(u.x); }, 0.5},
                          {[](Vec2f u) { return u.y < 0.3f ? 1.0 : 0.0; }, 0.3},
                          {[](Vec2f u) { return u.x * u.x + u.y * u.y < 1 ? 1.0 : 0.0; }, pi / 4}};
    for (const Case& c : cases) {
        for (const std::uint32_t samples : {1u, 2u, 4u}) {
            auto share = [&](std::uint32_t dimension) {
                return low_frequency_share([&](int x, int y) {
                    double sum = 0;
                    for (std::uint32_t s = 0; s < samples; ++s) {
                        sum += c.f(PixelSampler(9, 1, x, y, s).two(dimension));
                    }
                    return sum / samples - c.mean;
                });
            };
            const double white = share(PixelSampler::stratified_dimensions);
            EXPECT_LT(share(4), 0.6 * white) << samples;
        }
    }
}

}  // namespace
}  // namespace gischt
