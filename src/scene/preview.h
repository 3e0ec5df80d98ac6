// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gischt {

// What makes a scene quick to look at, as KEY=VALUE: every computed fluid gets half its cells along
// each edge (an eighth of the cells, steps twice as long), but not fewer than 16. Files stay.
std::vector<std::string> preview_overrides(const Scene& scene);

}  // namespace gischt
