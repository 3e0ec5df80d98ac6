// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/blending.h"

namespace gischt {

static std::vector<Choice<BlendFactor>> factor_choices() {
    using F = BlendFactor;
    return {{"ZERO", F::Zero},
            {"ONE", F::One},
            {"SRC_COLOR", F::SrcColor},
            {"ONE_MINUS_SRC_COLOR", F::OneMinusSrcColor},
            {"DST_COLOR", F::DstColor},
            {"ONE_MINUS_DST_COLOR", F::OneMinusDstColor},
            {"SRC_ALPHA", F::SrcAlpha},
            {"ONE_MINUS_SRC_ALPHA", F::OneMinusSrcAlpha},
            {"DST_ALPHA", F::DstAlpha},
            {"ONE_MINUS_DST_ALPHA", F::OneMinusDstAlpha},
            {"CONSTANT_COLOR", F::ConstantColor},
            {"ONE_MINUS_CONSTANT_COLOR", F::OneMinusConstantColor},
            {"CONSTANT_ALPHA", F::ConstantAlpha},
            {"ONE_MINUS_CONSTANT_ALPHA", F::OneMinusConstantAlpha}};
}

const Table<BlendParams>& blend_table() {
    using P = BlendParams;
    static const Table<P> table =
        Table<P>("blending", "How particles are put over what lies behind them: eq. 4")
            .choice(
                "blend", &P::preset,
                {{"opaque", BlendPreset::Opaque, "ONE, ZERO: they hide it"},
                 {"additive", BlendPreset::Additive, "SRC_ALPHA, ONE: they add light"},
                 {"smoke", BlendPreset::Smoke, "SRC_ALPHA, ONE_MINUS_SRC_ALPHA: they cover it"}},
                {.help = "The factors of the source and of the destination"})
            .choice("blend_source", &P::source, factor_choices(),
                    {.help = "Factor of the particle's colour, in place of that of 'blend'"})
            .choice("blend_destination", &P::destination, factor_choices(),
                    {.help = "Factor of the colour behind it, in place of that of 'blend'"})
            .add("blend_constant_color", &P::constant_color,
                 {.help = "The colour of the factors CONSTANT_COLOR", .min = 0})
            .add("blend_constant_alpha", &P::constant_alpha,
                 {.help = "The alpha of the factors CONSTANT_ALPHA", .min = 0, .max = 1});
    return table;
}

bool is_opaque(const BlendParams& params) {
    return params.preset == BlendPreset::Opaque && !params.source && !params.destination;
}

std::optional<GlBlend> blend_of(const BlendParams& params) {
    if (is_opaque(params)) return std::nullopt;
    using F = BlendFactor;
    GlBlend blend;
    switch (params.preset) {
        case BlendPreset::Opaque:
            break;
        case BlendPreset::Additive:
            blend = {F::SrcAlpha, F::One, F::Zero, F::One, {}};
            break;
        case BlendPreset::Smoke:
            blend = {F::SrcAlpha, F::OneMinusSrcAlpha, F::One, F::OneMinusSrcAlpha, {}};
            break;
    }
    if (params.source) blend.source = blend.source_alpha = *params.source;
    if (params.destination) blend.destination = blend.destination_alpha = *params.destination;
    const Vec3f c(params.constant_color);
    blend.constant = {c.x, c.y, c.z, static_cast<float>(params.constant_alpha)};
    return blend;
}

}  // namespace gischt
