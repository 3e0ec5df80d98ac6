// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gischt {

// GLSL of LitVolume's compute shaders: what media take, glow and scatter of the sky; and what one
// medium scatters of one light.
extern const char* const start_cells_glsl;
extern const char* const scatter_cells_glsl;

}  // namespace gischt
