// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace gischt {

// What a fuzzer feeds with bytes: the readers of everything that comes from outside. Each takes the
// bytes as a whole file and returns when it was read or refused with a gischt::Error; anything else
// that happens is a bug. Files that end in a hash are read a second time with the right one, since
// chance does not get past it.
void fuzz_vdb(std::string_view bytes);    // read_vdb() with at most 2^22 values, and list_vdb()
void fuzz_exr(std::string_view bytes);    //
void fuzz_hdr(std::string_view bytes);    //
void fuzz_png(std::string_view bytes);    // also with the right checksums
void fuzz_obj(std::string_view bytes);    //
void fuzz_ply(std::string_view bytes);    // as a mesh and as particles
void fuzz_film(std::string_view bytes);   // also with the right hash
void fuzz_state(std::string_view bytes);  // of smoke and of particles, also with the right hash
void fuzz_scene(std::string_view bytes);  // a scene file, with the checks of `gischt check`

}  // namespace gischt
