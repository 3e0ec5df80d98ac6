// SPDX-License-Identifier: Apache-2.0
#include "math/quadrature.h"

#include <cmath>

#include "base/units.h"

namespace gischt {

GaussLegendre::GaussLegendre(int n) {
    node.resize(static_cast<std::size_t>(n));
    weight.resize(node.size());
    for (std::size_t i = 0; i < node.size(); ++i) {
        // Newton's method on the Legendre polynomial from Tricomi's estimate of its i-th root.
        double x = std::cos(pi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 100; ++step) {
            double p = 1, below = 0;
            for (int k = 1; k <= n; ++k) {
                const double next = ((2 * k - 1) * x * p - (k - 1) * below) / k;
                below = p;
                p = next;
            }
            slope = n * (x * p - below) / (x * x - 1);
            const double dx = p / slope;
            x -= dx;
            if (std::abs(dx) < 1e-15) break;
        }
        node[i] = x;
        weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
}

}  // namespace gischt
