// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace gischt {

// Nodes and weights on [-1,1]; exact for polynomials up to degree 2n - 1.
struct GaussLegendre {
    std::vector<double> node, weight;

    explicit GaussLegendre(int n);

    template <class F>
    double integrate(double a, double b, F&& f) const {
        double sum = 0;
        for (std::size_t i = 0; i < node.size(); ++i) {
            sum += weight[i] * f(0.5 * (a + b) + 0.5 * (b - a) * node[i]);
        }
        return 0.5 * (b - a) * sum;
    }
};

}  // namespace gischt
