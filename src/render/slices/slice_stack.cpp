// SPDX-License-Identifier: Apache-2.0
#include "render/slices/slice_stack.h"

#include <algorithm>
#include <cmath>

namespace gischt {

std::array<double, 3> stack_shares(const Vec3d& direction, double fade) {
    const Vec3d cosine = abs(normalize(direction));
    const double most = max_component(cosine);
    std::array<double, 3> share{};
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
        double& s = share[static_cast<std::size_t>(a)];
        if (fade > 0) {
            s = std::max(0.0, cosine[a] - most + fade);
        } else {
            s = cosine[a] == most && sum == 0 ? 1 : 0;
        }
        sum += s;
    }
    for (double& s : share) s /= sum;
    return share;
}

std::vector<SliceRun> slice_runs(double low, double high, int count, double phase, double eye) {
    const double step = (high - low) / count, first = low + phase * step;
    // Slices below the eye come in ascending, those above in descending order.
    const double before =
        std::clamp(std::ceil((eye - first) / step), 0.0, static_cast<double>(count));
    const int below = static_cast<int>(before), above = count - below;
    std::vector<SliceRun> runs;
    if (below > 0) runs.push_back({first, step, below});
    if (above > 0) runs.push_back({first + (count - 1) * step, -step, above});
    return runs;
}

}  // namespace gischt
