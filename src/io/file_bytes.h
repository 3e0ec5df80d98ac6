// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gischt {

// All bytes of a file, a pipe included. Throws Error{Input} when it is missing, a folder, empty or
// unreadable, Error{Resource} when it does not fit into memory.
std::string read_bytes(const std::string& path);

}  // namespace gischt
