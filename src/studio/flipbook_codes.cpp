// SPDX-License-Identifier: Apache-2.0
#include "studio/flipbook_codes.h"

#include <algorithm>
#include <cmath>

#include "image/color.h"

namespace gischt {

DisplayImage data_codes(const Image& image, std::initializer_list<std::string_view> channels) {
    DisplayImage out;
    out.width = image.width;
    out.height = image.height;
    out.channels = static_cast<int>(channels.size());
    out.is_srgb = false;
    out.codes.resize(image.pixel_count() * channels.size());
    std::size_t c = 0;
    for (const std::string_view name : channels) {
        const auto values = image.channel(name);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const float v = std::clamp(values[i], 0.0f, 1.0f);
            out.codes[i * channels.size() + c] = static_cast<std::uint16_t>(std::lround(255 * v));
        }
        ++c;
    }
    return out;
}

static std::uint16_t srgb_code(float linear) {
    return static_cast<std::uint16_t>(
        std::lround(255 * srgb_encode(std::clamp(linear, 0.0f, 1.0f))));
}

DisplayImage light_codes(const Image& image, float scale) {
    DisplayImage out{image.width, image.height, 3, 8, {}, true};
    out.codes.resize(image.pixel_count() * 3);
    const auto color = image.color();
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) out.codes[3 * i + c] = srgb_code(color[c][i] / scale);
    }
    return out;
}

DisplayImage color_codes(const Image& image, ToneKind kind, double exposure, bool premultiplied) {
    const ToneCurve tone(kind);
    const float factor = exposure_factor(exposure);
    DisplayImage out{image.width, image.height, 4, 8, {}, true};
    out.codes.resize(image.pixel_count() * 4);
    const auto [r, g, b] = image.color();
    const auto a = image.channel("A");
    for (std::size_t i = 0; i < a.size(); ++i) {
        Vec3f light = factor * Vec3f{r[i], g[i], b[i]};
        const float share =
            premultiplied ? std::clamp(std::max(a[i], max_component(light)), 0.0f, 1.0f) : 1.0f;
        if (share > 0) light = tone(light / share) * share;
        for (int c = 0; c < 3; ++c)
            out.codes[4 * i + static_cast<std::size_t>(c)] = srgb_code(light[c]);
        out.codes[4 * i + 3] =
            static_cast<std::uint16_t>(std::lround(255 * std::clamp(a[i], 0.0f, 1.0f)));
    }
    return out;
}

}  // namespace gischt
