// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "io/vdb_header.h"

namespace gischt {

// Walks the structure of a grid's tree (of a type that read_vdb() knows) without decompressing it:
// that every node, mask and chunk of values ends inside the grid and every chunk has the size that
// its node calls for. OpenVDB trusts these sizes and writes beyond its buffers where they lie.
// Throws Error{Input}. Cost: some 5 % of reading.
void check_vdb_tree(const std::string& path, const VdbEntry& entry);

}  // namespace gischt
