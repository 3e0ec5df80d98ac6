// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gischt {

// OpenVDB names each file by a random UUID. One made of the content keeps the bytes a function of
// the frame, and tells files as gischt wrote them from all others. No protection against intent.

// Replaces the UUID of a closed file; throws std::runtime_error when it cannot be written.
void stamp_vdb(const std::string& path);
// Whether the UUID is that of the content.
bool has_vdb_stamp(const std::string& path);

}  // namespace gischt
