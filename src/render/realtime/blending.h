// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gl/types.h"
#include "schema/table.h"

namespace gischt {

// The classical blendings: particles that hide what lies behind, that add light (fire, sparks), and
// that cover it (smoke).
enum class BlendPreset { Opaque, Additive, Smoke };

// Eq. 4, C = C_src B_src + C_dst B_dst: a preset, or any two of the fourteen factors.
struct BlendParams {
    BlendPreset preset = BlendPreset::Smoke;
    std::optional<BlendFactor> source, destination;  // in place of the preset's
    Vec3d constant_color{1, 1, 1};
    double constant_alpha = 1;
};

// The keys blend, blend_source, blend_destination, blend_constant_color, blend_constant_alpha.
const Table<BlendParams>& blend_table();

// The blending of fragments whose colour is not multiplied by their alpha. The presets keep alpha
// the coverage of the picture; factors of your own hold for alpha too. Nothing for `opaque`
// without factors.
std::optional<GlBlend> blend_of(const BlendParams& params);
// Fragments hide what is behind them: depth is written and thin ones are dropped.
bool is_opaque(const BlendParams& params);

}  // namespace gischt
