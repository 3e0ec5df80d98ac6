// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace gischt {

// Walks the headers of an OpenEXR file, all of whose bytes are given: that every attribute ends
// inside the file and has the size that its type calls for, and that the counts of lines and chunks
// are possible. The library trusts these sizes and takes up to 2 GiB before it reads. Throws
// std::runtime_error with what is wrong.
void check_exr_attributes(std::string_view file);

}  // namespace gischt
