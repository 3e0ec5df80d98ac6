// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "fluid/smoke.h"

namespace gischt {

// Writes a state and the number of its frame to one file, which is whole when this returns:
// little-endian, float32, every tile, and a hash at the end. 24 bytes per cell in 3-D. Throws
// Error{Resource} when the disk does not take it.
void save_smoke_state(const SmokeState& state, int frame, const std::filesystem::path& path);

// Reads what save_smoke_state() wrote for the same domain; `frame` receives the number. Throws
// Error{Input} for anything else.
SmokeState load_smoke_state(const Domain& domain, const BlockMap& blocks,
                            const std::filesystem::path& path, int& frame);

}  // namespace gischt
