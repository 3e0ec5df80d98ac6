// SPDX-License-Identifier: Apache-2.0
#include "render/march/sky_sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/fast_math.h"

namespace gischt {

SweepSums::SweepSums(std::size_t nodes, bool with_octaves) : phase(nodes, 0.0f) {
    for (int c = 0; c < 3; ++c) {
        single[c].assign(nodes, 0.0f);
        if (with_octaves) octaves[c].assign(nodes, 0.0f);
    }
}

SkySweep::SkySweep(const SweepGrid& grid, const Camera& camera, std::span<const Octave> octaves,
                   const SurfaceSet& surfaces)
    : grid_(grid),
      camera_(camera),
      octaves_(octaves),
      surfaces_(surfaces),
      channels_(grid.extinction.size()) {
    const auto nu = static_cast<std::size_t>(grid.nu), nv = static_cast<std::size_t>(grid.nv);
    for (std::size_t c = 0; c < channels_; ++c) {
        upwind_[c].resize((nu + 2) * (nv + 2));
        here_[c].resize(nu * nv);
        log_[c].resize(nu);
    }
    cosine_.resize(nu);
    weight_.resize(nu);
    term_.resize(nu);
}

void SkySweep::add(const SkyDirection& sky, const Vec3f& arriving, SweepSums& sums) {
    // The way to the plane before, in cells.
    Vec3d back = grid_.to_world.inverse().vector(sky.direction);
    back = back / Vec3d(std::abs(back[grid_.axis]));
    const int sign = back[grid_.axis] > 0 ? 1 : -1;
    const auto half_length = static_cast<float>(0.5 * length(grid_.to_world.vector(back)));
    shift_u_ = back[grid_.u] < 0 ? -1 : 0;
    shift_v_ = back[grid_.v] < 0 ? -1 : 0;
    fraction_u_ = static_cast<float>(back[grid_.u] - shift_u_);
    fraction_v_ = static_cast<float>(back[grid_.v] - shift_v_);

    for (std::size_t c = 0; c < channels_; ++c) {
        std::fill(upwind_[c].begin(), upwind_[c].end(), arriving[static_cast<int>(c)]);
    }
    for (int step = 0; step < grid_.planes; ++step) {
        const int plane = sign > 0 ? grid_.planes - 1 - step : step;
        enter_plane(plane + sign, sky.direction, arriving);
        move_light(plane, half_length);
        scatter(plane, sky, sums);
    }
}

// Light from outside: the frame around the plane before, or all of that plane if it lies outside.
// Without surfaces the frame never changes.
void SkySweep::enter_plane(int plane, const Vec3d& towards, const Vec3f& arriving) {
    if (surfaces_.is_empty()) return;
    const bool is_outside = plane < 0 || plane >= grid_.planes;
    for (int j = -1; j <= grid_.nv; ++j) {
        const bool whole_row = is_outside || j == -1 || j == grid_.nv;
        for (int i = -1; i <= grid_.nu; i += whole_row ? 1 : grid_.nu + 1) {
            const bool is_dark = surfaces_.is_blocked({grid_.position(i, j, plane), towards});
            for (std::size_t c = 0; c < channels_; ++c) {
                upwind_[c][padded(i, j)] = is_dark ? 0.0f : arriving[static_cast<int>(c)];
            }
        }
    }
}

// The light at the nodes of a plane, and then the light that leaves it. Half of each step counts
// with the extinction of the plane before, half with that of this one.
void SkySweep::move_light(int plane, float half_length) {
    const float w11 = fraction_u_ * fraction_v_, w01 = (1 - fraction_u_) * fraction_v_,
                w10 = fraction_u_ * (1 - fraction_v_), w00 = (1 - fraction_u_) * (1 - fraction_v_);
    const auto nu = static_cast<std::size_t>(grid_.nu);
    for (std::size_t c = 0; c < channels_; ++c) {
        for (int j = 0; j < grid_.nv; ++j) {
            const float* a = upwind_[c].data() + padded(shift_u_, j + shift_v_);
            const float* b = a + grid_.nu + 2;
            const float* e = grid_.extinction[c].data() + grid_.row(j, plane) * nu;
            float* out = here_[c].data() + static_cast<std::size_t>(j) * nu;
            for (std::size_t i = 0; i < nu; ++i) {
                const float light = (w00 * a[i] + w10 * a[i + 1]) + (w01 * b[i] + w11 * b[i + 1]);
                out[i] = light * fast_exp(-half_length * e[i]);
            }
        }
        for (int j = 0; j < grid_.nv; ++j) {
            const std::size_t first = grid_.row(j, plane) * nu;
            const float* e = grid_.extinction[c].data() + first;
            const float* in = here_[c].data() + static_cast<std::size_t>(j) * nu;
            float* out = upwind_[c].data() + padded(0, j);
            for (std::size_t i = 0; i < nu; ++i) out[i] = in[i] * fast_exp(-half_length * e[i]);
            if (grid_.is_opaque.empty()) continue;
            for (std::size_t i = 0; i < nu; ++i) {
                if (grid_.is_opaque[first + i]) out[i] = 0;
            }
        }
    }
}

// Adds what the nodes of a plane scatter towards the camera.
void SkySweep::scatter(int plane, const SkyDirection& sky, SweepSums& sums) {
    for (int j = 0; j < grid_.nv; ++j) {
        const SweepGrid::Range range = grid_.needed[grid_.row(j, plane)];
        const int count = range.end - range.begin;
        if (count <= 0) continue;

        // Cosine between the way of the light before and after it scatters towards the camera.
        const Vec3f first(grid_.position(range.begin, j, plane) - camera_.position());
        const Vec3f step(grid_.to_world.column[static_cast<std::size_t>(grid_.u)]);
        const Vec3f towards(sky.direction);
        if (camera_.projection() == Projection::Orthographic) {
            std::fill_n(cosine_.begin(), count,
                        static_cast<float>(dot(camera_.forward(), sky.direction)));
        } else {
            for (int i = 0; i < count; ++i) {
                const Vec3f way = first + static_cast<float>(i) * step;
                cosine_[static_cast<std::size_t>(i)] =
                    dot(way, towards) / std::sqrt(dot(way, way) + 1e-30f);
            }
        }
        const auto nu = static_cast<std::size_t>(grid_.nu);
        const auto begin = static_cast<std::size_t>(range.begin);
        for (std::size_t c = 0; c < channels_; ++c) {
            const float* light = here_[c].data() + static_cast<std::size_t>(j) * nu + begin;
            for (int i = 0; i < count; ++i) log_[c][static_cast<std::size_t>(i)] = light[i];
        }
        scatter_row(grid_.row(j, plane) * nu + begin, count, sky, sums);
    }
}

// The same for the nodes [first, first + count) of one row; their light is in log_, which becomes
// its logarithm once the first octave is done.
void SkySweep::scatter_row(std::size_t first, int count, const SkyDirection& sky, SweepSums& sums) {
    const auto n = static_cast<std::size_t>(count);
    const auto weigh = [&](const PhaseFunction& function, float factor) {
        std::visit(
            [&](const auto& phase) {
                for (std::size_t i = 0; i < n; ++i) {
                    weight_[i] = factor * phase.value(cosine_[i]);
                }
            },
            function);
    };
    // A part of the sky is wider than a point: so is the lobe that sees it.
    const auto seen = [&](const Octave& o) {
        return widened(o.phase, static_cast<double>(sky.mean_cosine));
    };
    weigh(seen(octaves_[0]), sky.solid_angle);
    for (std::size_t i = 0; i < n; ++i) sums.phase[first + i] += weight_[i];
    for (std::size_t c = 0; c < 3; ++c) {
        const float radiance = sky.radiance[static_cast<int>(c)];
        const float* light = log_[std::min(c, channels_ - 1)].data();
        float* sum = sums.single[c].data() + first;
        for (std::size_t i = 0; i < n; ++i) sum[i] += radiance * (light[i] * weight_[i]);
    }
    if (octaves_.size() < 2) return;
    for (std::size_t c = 0; c < channels_; ++c) {
        for (std::size_t i = 0; i < n; ++i) log_[c][i] = fast_log(log_[c][i] + 1e-30f);
    }
    for (std::size_t o = 1; o < octaves_.size(); ++o) {
        weigh(seen(octaves_[o]), sky.solid_angle * octaves_[o].contribution);
        const float a = octaves_[o].attenuation;
        for (std::size_t c = 0; c < 3; ++c) {
            if (c < channels_) {
                for (std::size_t i = 0; i < n; ++i) {
                    term_[i] = fast_exp(a * log_[c][i]) * weight_[i];
                }
            }
            const float radiance = sky.radiance[static_cast<int>(c)];
            float* sum = sums.octaves[c].data() + first;
            for (std::size_t i = 0; i < n; ++i) sum[i] += radiance * term_[i];
        }
    }
}

}  // namespace gischt
