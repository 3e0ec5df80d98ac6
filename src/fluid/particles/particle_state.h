// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "grid/particles.h"

namespace gischt {

// All that later frames depend on, in one file that is whole when this returns. Colour and the like
// follow from the age and are not kept. Throws Error{Resource} when it cannot be written.
void save_particle_state(const Particles& particles, int frame, const std::filesystem::path& path);
// Throws Error{Input} for a file that is missing, damaged or no such state.
Particles load_particle_state(const std::filesystem::path& path, int& frame);

}  // namespace gischt
