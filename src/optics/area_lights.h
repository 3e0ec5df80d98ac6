// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "optics/light_params.h"
#include "optics/surface_params.h"

namespace gischt {

// The surface of a light that has a size, black but for its glow, at one moment (its places stay
// keyed); nothing for other lights and for one without strength. Throws Error{Usage} on a size that
// is not positive.
std::optional<SurfaceParams> lamp_surface(const AnyLightParams& light, double time);

}  // namespace gischt
