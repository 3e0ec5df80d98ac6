// SPDX-License-Identifier: Apache-2.0
#include "scene/preview.h"

#include <fmt/format.h>

#include <algorithm>

namespace gischt {
namespace {

// The key of a fluid's resolution and its value; none for a fluid that is not computed.
struct ResolutionOf {
    struct Found {
        const char* key = nullptr;
        int cells = 0;
    };
    Found operator()(const FluidOf<SmokeParams>& f) const {
        return {"domain.resolution", f.source.domain.resolution};
    }
    Found operator()(const FluidOf<CloudParams>& f) const {
        return {"resolution", f.source.resolution};
    }
    Found operator()(const FluidOf<ParticleParams>& f) const {
        return {"domain.resolution", f.source.domain.resolution};
    }
    Found operator()(const FluidOf<ProceduralParams>& f) const {
        return {"resolution", f.source.resolution};
    }
    Found operator()(const FluidOf<FileParams>&) const { return {}; }
};

}  // namespace

std::vector<std::string> preview_overrides(const Scene& scene) {
    constexpr int fewest = 16;  // below, sources and solids are lost
    std::vector<std::string> sets;
    for (std::size_t i = 0; i < scene.fluids.size(); ++i) {
        const auto found = std::visit(ResolutionOf{}, scene.fluids[i]);
        if (!found.key || found.cells <= fewest) continue;
        sets.push_back(
            fmt::format("fluid.{}.{}={}", i, found.key, std::max(fewest, (found.cells + 1) / 2)));
    }
    return sets;
}

}  // namespace gischt
