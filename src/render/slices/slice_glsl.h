// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gischt {

// GLSL: slab(), the piece of a pixel's ray for which a slice at `place` stands. Needs camera_glsl;
// uniforms `across`, the slices' unit normal, and `spacing` in metres; with SURFACES defined only
// what lies before a surface counts, whose depths are bound to 2.
extern const char* const slab_glsl;

}  // namespace gischt
