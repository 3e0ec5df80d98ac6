// SPDX-License-Identifier: Apache-2.0
#include "image/denoise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/color.h"
#include "math/vec.h"

namespace gischt {
namespace {

constexpr int window = 10, patch = 3;  // radii in pixels
constexpr int pad = window + patch;
constexpr int strengths = 3;
constexpr int band = 16;          // rows of a task
constexpr float softest = 1.25f;  // 1 / k^2; the next ones are 4 and 16 times as strict
constexpr float least = 1e-12f;   // keeps quotients finite where there is no noise
constexpr std::size_t candidates = strengths + 1;  // with the picture as it is

using Plane = std::vector<float>;
using Color = std::array<Plane, 3>;

// A plane with its border repeated `pad` pixels outwards.
struct Padded {
    int stride = 0;
    Plane values;

    Padded(const Plane& inner, int width, int height) : stride(width + 2 * pad) {
        values.resize(static_cast<std::size_t>(stride) *
                      static_cast<std::size_t>(height + 2 * pad));
        for (int y = -pad; y < height + pad; ++y) {
            const int from = std::clamp(y, 0, height - 1) * width;
            for (int x = -pad; x < width + pad; ++x)
                row(y)[x] = inner[static_cast<std::size_t>(from + std::clamp(x, 0, width - 1))];
        }
    }
    float* row(int y) { return values.data() + std::ptrdiff_t{y + pad} * stride + pad; }
    const float* row(int y) const { return values.data() + std::ptrdiff_t{y + pad} * stride + pad; }
};

// Mean over a square of that radius, cut at the border.
Plane box_mean(const Plane& in, int width, int height, int radius) {
    Plane rows(in.size()), out(in.size());
    parallel_for(height, 16, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const int x0 = std::max(x - radius, 0), x1 = std::min(x + radius, width - 1);
            float sum = 0;
            for (int i = x0; i <= x1; ++i) sum += in[static_cast<std::size_t>(y * width + i)];
            rows[static_cast<std::size_t>(y * width + x)] = sum / static_cast<float>(x1 - x0 + 1);
        }
    });
    parallel_for(height, 16, [&](int y) {
        const int y0 = std::max(y - radius, 0), y1 = std::min(y + radius, height - 1);
        float* to = out.data() + std::ptrdiff_t{y} * width;
        for (int j = y0; j <= y1; ++j) {
            const float* from = rows.data() + std::ptrdiff_t{j} * width;
            for (int x = 0; x < width; ++x) to[x] += from[x];
        }
        for (int x = 0; x < width; ++x) to[x] /= static_cast<float>(y1 - y0 + 1);
    });
    return out;
}

struct Denoiser {
    Job& job;
    int width, height;
    Color picture, variance;  // of the picture, smoothed
    std::array<Color, 2> half;
    std::array<std::array<Color, strengths>, 2> filtered;

    std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width + x); }

    // Noise is taken to have the color of the light around.
    void set_variance(const Plane& of_luminance) {
        const Plane v = box_mean(of_luminance, width, height, 1);
        Color mean;
        for (std::size_t c = 0; c < 3; ++c) mean[c] = box_mean(picture[c], width, height, 2);
        for (std::size_t c = 0; c < 3; ++c) {
            variance[c].resize(v.size());
            for (std::size_t i = 0; i < v.size(); ++i) {
                const float y = luminance(Vec3f(mean[0][i], mean[1][i], mean[2][i]));
                const float share = y > 0 ? std::clamp(mean[c][i] / y, 0.0f, 4.0f) : 1.0f;
                variance[c][i] = v[i] * share * share;
            }
        }
    }

    void split() {
        for (auto& h : half) h = picture;
        for (std::size_t i = 0; i < picture[0].size(); ++i) {
            const std::uint64_t key = random_key(0, i);
            const float u = 1 - random_uniform(key, 0), angle = 6.2831853f * random_uniform(key, 1);
            const float n = std::sqrt(-2 * std::log(u)) * std::cos(angle);  // Box & Muller 1958
            for (std::size_t c = 0; c < 3; ++c) {
                const float noise = n * std::sqrt(variance[c][i]);
                half[0][c][i] += noise;
                half[1][c][i] -= noise;
            }
        }
    }

    // Averages half `h` with the weights of the other.
    void filter(std::size_t h) {
        std::vector<Padded> guide, noise;
        Color out_zero;
        for (std::size_t c = 0; c < 3; ++c) {
            guide.emplace_back(half[1 - h][c], width, height);
            Plane v = variance[c];
            for (float& value : v) value *= 2;
            noise.emplace_back(v, width, height);
            out_zero[c].assign(picture[c].size(), 0.0f);
        }
        filtered[h].fill(out_zero);
        parallel_for((height + band - 1) / band, 1, [&](int b) {
            filter_band(h, guide, noise, b * band, std::min((b + 1) * band, height));
        });
    }

    void filter_band(std::size_t h, const std::vector<Padded>& guide,
                     const std::vector<Padded>& noise, int y0, int y1) {
        const int rows = y1 - y0 + 2 * patch;
        const auto w = static_cast<std::size_t>(width);
        Plane apart(w + 2 * patch), sums(w * static_cast<std::size_t>(rows)), distance(w);
        std::array<Plane, strengths> total;
        for (Plane& t : total) t.assign(w * static_cast<std::size_t>(y1 - y0), 0.0f);
        for (int dy = -window; dy <= window; ++dy) {
            job.check();
            for (int dx = -window; dx <= window; ++dx) {
                for (int r = 0; r < rows; ++r) {
                    row_distance(guide, noise, y0 - patch + r, dx, dy, apart);
                    float* to = sums.data() + std::ptrdiff_t{r} * width;
                    for (int x = 0; x < width; ++x) {
                        const float* a = apart.data() + x;
                        to[x] = a[0] + a[1] + a[2] + a[3] + a[4] + a[5] + a[6];
                    }
                }
                for (int y = y0; y < y1; ++y) {
                    if (y + dy < 0 || y + dy >= height) continue;
                    const float* s = sums.data() + std::ptrdiff_t{y - y0} * width;
                    for (int x = 0; x < width; ++x) {
                        float sum = 0;
                        for (int j = 0; j <= 2 * patch; ++j) sum += s[x + j * width];
                        distance[static_cast<std::size_t>(x)] = sum;
                    }
                    gather(h, y, y - y0, dx, dy, distance, total);
                }
            }
        }
        for (std::size_t k = 0; k < strengths; ++k) {
            for (std::size_t i = 0; i < total[k].size(); ++i) {
                for (Plane& plane : filtered[h][k]) plane[at(0, y0) + i] /= total[k][i];
            }
        }
    }

    // Squared difference to the pixel at (dx, dy) less what noise alone makes, in units of the
    // noise (Rousselle et al. 2012, eq. 3), summed over the colors; from x = -patch on.
    void row_distance(const std::vector<Padded>& guide, const std::vector<Padded>& noise, int y,
                      int dx, int dy, Plane& out) const {
        std::fill(out.begin(), out.end(), 0.0f);
        const int count = width + 2 * patch;
        float* to = out.data();
        for (std::size_t c = 0; c < 3; ++c) {
            const float *p = guide[c].row(y) - patch, *q = guide[c].row(y + dy) - patch + dx;
            const float *vp = noise[c].row(y) - patch, *vq = noise[c].row(y + dy) - patch + dx;
            for (int x = 0; x < count; ++x) {
                const float d = p[x] - q[x];
                const float far =
                    (d * d - vp[x] - std::min(vp[x], vq[x])) / (least + vp[x] + vq[x]);
                to[x] += std::min(far, 1e6f);
            }
        }
    }

    void gather(std::size_t h, int y, int row, int dx, int dy, const Plane& distance,
                std::array<Plane, strengths>& total) {
        const int x0 = std::max(0, -dx), x1 = std::min(width, width - dx);
        const float scale = softest / (3 * (2 * patch + 1) * (2 * patch + 1) * 16.0f);
        const float *r = half[h][0].data() + std::ptrdiff_t{y + dy} * width + dx,
                    *g = half[h][1].data() + std::ptrdiff_t{y + dy} * width + dx,
                    *b = half[h][2].data() + std::ptrdiff_t{y + dy} * width + dx;
        Plane weight(distance.size());
        for (int x = x0; x < x1; ++x) {
            // exp(-t) as (1 - t/16)^16, which ends at t = 16.
            const auto i = static_cast<std::size_t>(x);
            float e = std::max(0.0f, 1 - std::max(0.0f, distance[i]) * scale);
            for (int s = 0; s < 4; ++s) e *= e;
            weight[i] = e;
        }
        for (std::size_t k = 0; k < strengths; ++k) {
            float* sum = total[k].data() + std::ptrdiff_t{row} * width;
            float* out[3];
            for (std::size_t c = 0; c < 3; ++c) out[c] = filtered[h][k][c].data() + at(0, y);
            for (int x = x0; x < x1; ++x) {
                const float w = weight[static_cast<std::size_t>(x)];
                sum[x] += w;
                out[0][x] += w * r[x];
                out[1][x] += w * g[x];
                out[2][x] += w * b[x];
                weight[static_cast<std::size_t>(x)] = w * w * w * w;
            }
        }
    }

    // The error of (F_A + F_B) / 2 in units of the noise, up to what all strengths share: each half
    // judges the other's, and averaging two halves takes a quarter of their squared difference.
    Plane error_of(std::size_t k) const {
        Plane e(picture[0].size(), 0.0f);
        for (std::size_t c = 0; c < 3; ++c) {
            const Plane &a = half[0][c], &b = half[1][c];
            const Plane& fa = k < strengths ? filtered[0][k][c] : a;
            const Plane& fb = k < strengths ? filtered[1][k][c] : b;
            for (std::size_t i = 0; i < e.size(); ++i) {
                const float p = fa[i] - b[i], q = fb[i] - a[i], d = fa[i] - fb[i];
                e[i] += (0.5f * (p * p + q * q) - 0.25f * d * d) / (least + variance[c][i]);
            }
        }
        return box_mean(e, width, height, 5);
    }

    Color blended() const {
        std::array<Plane, candidates> error, share;
        for (std::size_t k = 0; k < candidates; ++k) {
            error[k] = error_of(k);
            share[k].assign(error[k].size(), 0.0f);
        }
        for (std::size_t i = 0; i < error[0].size(); ++i) {
            std::size_t best = 0;
            for (std::size_t k = 1; k < candidates; ++k) {
                if (error[k][i] < error[best][i]) best = k;
            }
            share[best][i] = 1;
        }
        for (Plane& s : share) s = box_mean(s, width, height, 2);
        Color out;
        for (std::size_t c = 0; c < 3; ++c) {
            out[c] = picture[c];
            for (std::size_t i = 0; i < out[c].size(); ++i) {
                if (variance[c][i] == 0) continue;
                float sum = share[strengths][i] * picture[c][i];
                for (std::size_t k = 0; k < strengths; ++k)
                    sum += share[k][i] * 0.5f * (filtered[0][k][c][i] + filtered[1][k][c][i]);
                out[c][i] = sum;
            }
        }
        return out;
    }

    // Gives back what the mean has changed by, where there is noise.
    void keep_mean(Color& out) const {
        for (std::size_t c = 0; c < 3; ++c) {
            auto total = [&](auto&& f) {
                return parallel_sum(height, 16, [&](int y) {
                    double sum = 0;
                    for (int x = 0; x < width; ++x) sum += f(at(x, y));
                    return sum;
                });
            };
            const double lost = total([&](std::size_t i) {
                return static_cast<double>(picture[c][i]) - static_cast<double>(out[c][i]);
            });
            const double noise = total(
                [&](std::size_t i) { return std::sqrt(static_cast<double>(variance[c][i])); });
            if (!(noise > 0)) continue;
            for (std::size_t i = 0; i < out[c].size(); ++i) {
                out[c][i] += static_cast<float>(lost / noise *
                                                std::sqrt(static_cast<double>(variance[c][i])));
            }
        }
    }
};

void check_input(const Image& image) {
    if (image.has("noisy.R")) throw Error(ErrorKind::Input, "denoise", "the picture is denoised");
    if (!image.has("variance.Y")) {
        throw Error(ErrorKind::Input, "denoise", "the picture has no layer 'variance'",
                    "render it with film.denoise=true, or film.aovs=[\"variance\"]");
    }
    for (const char* name : {"R", "G", "B", "variance.Y"}) {
        for (const float v : image.channel(name)) {
            const bool is_sound = std::isfinite(v) && (name[0] != 'v' || v >= 0);
            if (!is_sound) {
                throw Error(ErrorKind::Input, "denoise",
                            fmt::format("channel {} has the value {}", name, v));
            }
        }
    }
}

}  // namespace

void denoise(Image& image, Job& job) {
    check_input(image);
    Denoiser d{job, image.width, image.height, {}, {}, {}, {}};
    const std::array<const char*, 3> names{"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto plane = image.channel(names[c]);
        d.picture[c].assign(plane.begin(), plane.end());
    }
    const auto v = image.channel("variance.Y");
    d.set_variance(Plane(v.begin(), v.end()));
    d.split();
    d.filter(0);
    job.progress(0.5, "denoise");
    d.filter(1);
    job.progress(1, "denoise");
    Color out = d.blended();
    d.keep_mean(out);
    for (std::size_t c = 0; c < 3; ++c) {
        const auto noisy = image.add_channel(fmt::format("noisy.{}", names[c]));
        std::copy(d.picture[c].begin(), d.picture[c].end(), noisy.begin());
        std::copy(out[c].begin(), out[c].end(), image.channel(names[c]).begin());
    }
    image.metadata.set("denoised", "true");
}

}  // namespace gischt
