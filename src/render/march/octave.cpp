// SPDX-License-Identifier: Apache-2.0
#include "render/march/octave.h"

namespace gischt {

PhaseFunction widened(const PhaseFunction& phase, double factor) {
    const auto f = static_cast<float>(factor);
    if (const auto* hg = std::get_if<HenyeyGreensteinPhase>(&phase)) {
        return HenyeyGreensteinPhase{hg->g * f};
    }
    if (const auto* schlick = std::get_if<SchlickPhase>(&phase)) {
        return SchlickPhase{schlick->k * f};
    }
    if (const auto* lobes = std::get_if<TwoLobePhase>(&phase)) {
        return TwoLobePhase{{lobes->first.g * f}, {lobes->second.g * f}, lobes->weight};
    }
    if (const auto* mie = std::get_if<MiePhase>(&phase)) {
        const double g = static_cast<double>(mie->rest.g), a = static_cast<double>(mie->rest.alpha);
        return MiePhase{{mie->peak.g * f}, DrainePhase::of(g * factor, a * factor), mie->weight};
    }
    return phase;
}

std::vector<Octave> octaves_of(const Medium& medium) {
    const MultipleScattering& m = medium.multiple_scattering();
    std::vector<Octave> octaves;
    double a = 1, b = 1, c = 1;
    for (int i = 0; i <= m.octaves; ++i) {
        octaves.push_back(
            {static_cast<float>(a), static_cast<float>(b), widened(medium.phase(), c)});
        a *= m.attenuation;
        b *= m.contribution;
        c *= m.eccentricity;
    }
    return octaves;
}

}  // namespace gischt
