// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "math/quadrature.h"
#include "math/vec.h"

namespace gischt {

// Pearson's test that samples of directions have the density that is claimed.
struct ChiSquared {
    double statistic = 0, p_value = 0;
    int freedom = 0;
};

// The upper tail of the chi-squared distribution (Abramowitz & Stegun 26.4.4, by the incomplete
// gamma function's series and continued fraction, 6.5.29 and 6.5.31).
inline double chi_squared_tail(double statistic, int freedom) {
    const double a = 0.5 * freedom, x = 0.5 * statistic;
    if (x <= 0) return 1;
    const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 2000; ++n) sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 2000; ++i) {
        const double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
    }
    return front * h;
}

// `draw(key)` gives a direction or nothing; `density` in 1/sr. Bins are even in cosine and azimuth
// (20 x 40 over the sphere); the density is integrated over each, finer where there is much of it;
// bins of less than 5 expected samples are pooled. `depth`: how often a bin is halved at most, 6
// where the density jumps.
inline ChiSquared chi_squared(const std::function<std::optional<Vec3d>(std::uint64_t)>& draw,
                              const std::function<double(const Vec3d&)>& density,
                              std::uint64_t seed, int depth = 10) {
    constexpr int rows = 20, columns = 40, samples = 60000;
    std::vector<double> seen(rows * columns, 0), expected(rows * columns, 0);
    double lost = 0;
    for (std::uint64_t i = 0; i < samples; ++i) {
        const auto d = draw(random_key(seed, i));
        if (!d) {
            ++lost;
            continue;
        }
        const int row = std::clamp(static_cast<int>(0.5 * (d->z + 1) * rows), 0, rows - 1);
        const double turn = std::atan2(d->y, d->x) / (2 * pi) + 0.5;
        const int column = std::clamp(static_cast<int>(turn * columns), 0, columns - 1);
        ++seen[static_cast<std::size_t>(row * columns + column)];
    }
    // A rule over a patch, halved until the halves agree with the whole.
    const GaussLegendre rule(4);
    const auto patch = [&](double z0, double z1, double t0, double t1) {
        return rule.integrate(z0, z1, [&](double z) {
            return rule.integrate(t0, t1, [&](double t) {
                const double r = std::sqrt(std::max(0.0, 1 - z * z)), a = 2 * pi * (t - 0.5);
                return 2 * pi * density({r * std::cos(a), r * std::sin(a), z});
            });
        });
    };
    const std::function<double(double, double, double, double, double, int)> integrate =
        [&](double z0, double z1, double t0, double t1, double whole, int level) -> double {
        const double z = 0.5 * (z0 + z1), t = 0.5 * (t0 + t1);
        const double a = patch(z0, z, t0, t), b = patch(z, z1, t0, t), c = patch(z0, z, t, t1),
                     d = patch(z, z1, t, t1);
        if (level >= 3 && std::abs(a + b + c + d - whole) < 1e-6) return a + b + c + d;
        if (level >= depth) return a + b + c + d;
        return integrate(z0, z, t0, t, a, level + 1) + integrate(z, z1, t0, t, b, level + 1) +
               integrate(z0, z, t, t1, c, level + 1) + integrate(z, z1, t, t1, d, level + 1);
    };
    double total = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const double z0 = 2.0 * row / rows - 1, z1 = 2.0 * (row + 1) / rows - 1,
                         t0 = static_cast<double>(column) / columns,
                         t1 = static_cast<double>(column + 1) / columns;
            double& e = expected[static_cast<std::size_t>(row * columns + column)];
            e = samples * integrate(z0, z1, t0, t1, patch(z0, z1, t0, t1), 0);
            total += e;
        }
    }
    ChiSquared out;
    double pooled_seen = lost, pooled_expected = std::max(0.0, samples - total);
    const auto add = [&](double o, double e) {
        out.statistic += (o - e) * (o - e) / e;
        ++out.freedom;
    };
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (expected[i] >= 5) {
            add(seen[i], expected[i]);
        } else {
            pooled_seen += seen[i];
            pooled_expected += expected[i];
        }
    }
    // The rest counts when it is large enough; a sample where none may be is always wrong.
    if (pooled_expected >= 5)
        add(pooled_seen, pooled_expected);
    else if (pooled_seen > 30)
        out.statistic = 1e9;
    --out.freedom;
    out.p_value = out.freedom > 0 ? chi_squared_tail(out.statistic, out.freedom) : 1;
    return out;
}

}  // namespace gischt
