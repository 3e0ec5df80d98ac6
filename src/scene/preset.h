// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "schema/value.h"

namespace gischt {

// Looks for any volume: smoke, fire, cloud, steam, fog.
const std::vector<std::string>& preset_names();

// Sets the medium of every fluid of a scene's tree. Throws Error{Usage} for a name that does not
// exist.
void apply_preset(Value& scene, std::string_view name);

}  // namespace gischt
