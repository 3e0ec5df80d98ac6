// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/zone_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace gischt {

std::vector<Vec3f> scattering_of_elements(const Enclosure& enclosure) {
    std::vector<Vec3f> s = enclosure.grid.scattering;
    for (const SurfacePatch& p : enclosure.patches) s.push_back(p.albedo);
    return s;
}

namespace {

// Of each channel, in double, by a fixed tree.
Vec3d dot_of(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    constexpr std::size_t block = 4096;
    const std::size_t blocks = (a.size() + block - 1) / block;
    std::array<std::vector<double>, 3> part;
    for (auto& p : part) p.resize(blocks);
    for (std::size_t k = 0; k < blocks; ++k) {
        for (std::size_t i = k * block; i < std::min(a.size(), (k + 1) * block); ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                const int channel = static_cast<int>(c);
                part[c][k] +=
                    static_cast<double>(a[i][channel]) * static_cast<double>(b[i][channel]);
            }
        }
    }
    return {tree_sum(part[0]), tree_sum(part[1]), tree_sum(part[2])};
}

Vec3f ratio(const Vec3d& a, const Vec3d& b) {
    Vec3f r;
    for (int c = 0; c < 3; ++c) r[c] = b[c] > 0 ? static_cast<float>(a[c] / b[c]) : 0.0f;
    return r;
}

struct Equilibrium {
    std::vector<Vec3f> x;
    int iterations = 0;
    double residual = 0;
};

// s R x - s G s x = s b: symmetric, and positive definite as no row of G s exceeds R. Elements
// without scattering stay 0 here. Conjugate gradients with the diagonal as preconditioner.
Equilibrium by_sweeps(const ZoneSweep& sweep, std::span<const Vec3f> s, std::span<const Vec3f> b,
                      const ZoneSolveLimits& limits, Job& job) {
    const std::vector<float>& measure = sweep.measure();
    const std::size_t n = s.size();
    std::vector<Vec3f> x(n), r(n), z(n), p(n), sp(n);
    const auto precondition = [&] {
        for (std::size_t i = 0; i < n; ++i) {
            for (int c = 0; c < 3; ++c) {
                const float d = s[i][c] * measure[i];
                z[i][c] = d > 0 ? r[i][c] / d : 0.0f;
            }
        }
    };
    for (std::size_t i = 0; i < n; ++i) r[i] = s[i] * b[i];
    precondition();
    p = z;
    Vec3d rho = dot_of(r, z);
    const Vec3d start = rho;
    Equilibrium result;
    for (;; ++result.iterations) {
        double worst = 0;
        for (int c = 0; c < 3; ++c) {
            if (start[c] > 0) worst = std::max(worst, rho[c] / start[c]);
        }
        result.residual = std::sqrt(worst);
        if (result.residual <= limits.tolerance || result.iterations >= limits.most_iterations) {
            break;
        }
        job.progress(std::min(0.99, std::log(result.residual) / std::log(limits.tolerance)),
                     "zones");
        for (std::size_t i = 0; i < n; ++i) sp[i] = s[i] * p[i];
        const ArrivingLight light = sweep(sp, false);
        std::vector<Vec3f> ap(n);
        for (std::size_t i = 0; i < n; ++i) ap[i] = s[i] * (measure[i] * p[i] - light.at[i]);
        const Vec3f step = ratio(rho, dot_of(p, ap));
        for (std::size_t i = 0; i < n; ++i) {
            x[i] += step * p[i];
            r[i] -= step * ap[i];
        }
        precondition();
        const Vec3d before = rho;
        rho = dot_of(r, z);
        const Vec3f beta = ratio(rho, before);
        for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
    }
    result.x = std::move(x);
    return result;
}

// x_i = (b_i + sum of G_ij s_j x_j over the others) / (R_i - G_ii s_i), one after the other.
Equilibrium by_relaxation(const ZoneSweep& sweep, std::span<const Vec3f> s,
                          std::span<const Vec3f> b, const ZoneSolveLimits& limits, Job& job) {
    const std::vector<float>& measure = sweep.measure();
    std::vector<bool> scatters(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) scatters[i] = max_component(s[i]) > 0;
    const ExchangeMatrix matrix(sweep.enclosure(), scatters, limits.memory, job);
    const std::size_t n = matrix.size();
    Equilibrium result;
    result.x.resize(s.size());
    std::vector<float> y(n);  // s x
    for (int c = 0; c < 3; ++c) {
        std::fill(y.begin(), y.end(), 0.0f);
        for (int iteration = 1;; ++iteration) {
            job.check();
            double change = 0, size = 0;
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t e = matrix.element(i);
                const std::span<const float> g = matrix.row(i, c);
                // Partial sums, so that the loop runs in vectors.
                std::array<float, 8> lane{};
                const std::size_t even = n / 8 * 8;
                for (std::size_t j = 0; j < even; j += 8) {
                    for (std::size_t k = 0; k < 8; ++k) lane[k] += g[j + k] * y[j + k];
                }
                double sum = static_cast<double>(b[e][c] - g[i] * y[i]);
                for (const float v : lane) sum += static_cast<double>(v);
                for (std::size_t j = even; j < n; ++j) sum += static_cast<double>(g[j] * y[j]);
                // No line passes a zone inside of a solid.
                const double own = static_cast<double>(measure[e] - g[i] * s[e][c]);
                const double x = own > 0 ? sum / own : 0;
                const double weight = static_cast<double>(measure[e] * s[e][c]);
                const double off = x - static_cast<double>(result.x[e][c]);
                change += weight * off * off;
                size += weight * x * x;
                result.x[e][c] = static_cast<float>(x);
                y[i] = s[e][c] * result.x[e][c];
            }
            result.iterations = std::max(result.iterations, iteration);
            const double relative = size > 0 ? std::sqrt(change / size) : 0;
            // What is still to come of a sequence that converges linearly is some ten times that.
            const bool is_done = relative <= 0.1 * limits.tolerance;
            if (is_done || iteration >= limits.most_iterations) {
                result.residual = std::max(result.residual, 10 * relative);
                break;
            }
        }
        if (c == 0) job.progress(0.5, "zones");
    }
    return result;
}

}  // namespace

ZoneSolution solve_zones(const ZoneSweep& sweep, std::span<const Vec3f> source, ZoneSolver solver,
                         const ZoneSolveLimits& limits, Job& job) {
    const std::vector<Vec3f> s = scattering_of_elements(sweep.enclosure());
    const ArrivingLight first = sweep(source, true);
    const Equilibrium found = solver == ZoneSolver::Exchange
                                  ? by_relaxation(sweep, s, first.at, limits, job)
                                  : by_sweeps(sweep, s, first.at, limits, job);
    if (!(found.residual <= limits.tolerance)) {
        throw Error(
            ErrorKind::Usage, "zonal",
            fmt::format("light is not in equilibrium after {} iterations, but off by {:.1e}",
                        found.iterations, found.residual),
            "raise render.zonal.iterations or the tolerance");
    }
    // One more sweep tells what arrives everywhere, where nothing scatters and outside too.
    std::vector<Vec3f> total(source.begin(), source.end());
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += s[i] * found.x[i];
    ArrivingLight last = sweep(total, true);
    ZoneSolution solution;
    solution.arriving = sweep.mean_radiance(last);
    solution.leaving = std::move(last.leaving);
    solution.iterations = found.iterations;
    solution.residual = found.residual;
    return solution;
}

}  // namespace gischt
