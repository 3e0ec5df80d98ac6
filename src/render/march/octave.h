// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "optics/medium.h"

namespace gischt {

// One term of the approximation of multiple scattering; the first is single scattering itself.
struct Octave {
    float attenuation = 1, contribution = 1;
    PhaseFunction phase;
};

// The phase function of the same kind whose lobe is wider: mean cosine times `factor`.
PhaseFunction widened(const PhaseFunction& phase, double factor);

// Single scattering and the octaves that the medium asks for.
std::vector<Octave> octaves_of(const Medium& medium);

}  // namespace gischt
