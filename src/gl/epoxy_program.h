// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "gl/types.h"

namespace gischt {

// Compiles and links in the current context; see GlDevice::create_program.
GlId link_program(std::string_view name, std::span<const GlStage> stages);

}  // namespace gischt
