// SPDX-License-Identifier: Apache-2.0
#include "image/display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/error.h"
#include "base/parallel.h"
#include "image/color.h"
#include "image/dither.h"

namespace gischt {
namespace {

// Turns pixels of one image into sRGB-encoded values in [0,1] and those into codes.
class Developer {
  public:
    Developer(const Image& image, const DisplayOptions& options, int bits)
        : width_(image.width),
          color_(image.color()),
          tone_(options.tone),
          factor_(exposure_factor(options.exposure)),
          dither_(options.dither && bits == 8),
          largest_(bits == 8 ? 255 : 65535) {
        if (options.alpha && image.has("A")) alpha_ = image.channel("A");
    }
    bool has_alpha() const { return !alpha_.empty(); }

    // R, G, B and alpha, 1 where there is none.
    std::array<int, 4> operator()(int x, int y) const {
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x);
        Vec3f light = factor_ * Vec3f{color_[0][i], color_[1][i], color_[2][i]};
        float coverage = 1;
        if (has_alpha()) {
            coverage = std::clamp(std::max(alpha_[i], max_component(light)), 0.0f, 1.0f);
            if (coverage > 0) light = light / coverage;
        }
        const Vec3f shown = tone_(light);
        return {code(srgb_encode(shown.x), x, y, 0), code(srgb_encode(shown.y), x, y, 1),
                code(srgb_encode(shown.z), x, y, 2), code(coverage, x, y, 3)};
    }

  private:
    int code(float encoded, int x, int y, int channel) const {
        const float scaled = encoded * static_cast<float>(largest_);
        // Codes that an 8-bit picture brought along come back exactly: no dither within the
        // rounding of the transfer functions.
        const float nearest = std::round(scaled);
        const bool whole = std::abs(scaled - nearest) < 1e-3f;
        const float threshold = dither_ && !whole ? dither_threshold(x, y, channel) : 0.5f;
        return dither(whole ? nearest : scaled, largest_, threshold);
    }

    int width_;
    std::array<std::span<const float>, 3> color_;
    std::span<const float> alpha_;
    ToneCurve tone_;
    float factor_;
    bool dither_;
    int largest_;
};

}  // namespace

DisplayImage to_display(const Image& image, const DisplayOptions& options, int bits) {
    GISCHT_ASSERT(bits == 8 || bits == 16);
    const Developer develop(image, options, bits);
    DisplayImage out{image.width, image.height, develop.has_alpha() ? 4 : 3, bits, {}, true};
    const auto channels = static_cast<std::size_t>(out.channels);
    out.codes.resize(image.pixel_count() * channels);
    parallel_for(image.height, 8, [&](int y) {
        std::uint16_t* code = out.codes.data() + image.index(0, y) * channels;
        for (int x = 0; x < image.width; ++x) {
            const auto rgba = develop(x, y);
            for (std::size_t c = 0; c < channels; ++c) {
                *code++ = static_cast<std::uint16_t>(rgba[c]);
            }
        }
    });
    return out;
}

std::vector<std::uint8_t> to_rgb8(const Image& image, const DisplayOptions& options) {
    const Developer develop(image, options, 8);
    std::vector<std::uint8_t> out(image.pixel_count() * 3);
    parallel_for(image.height, 8, [&](int y) {
        std::uint8_t* byte = out.data() + image.index(0, y) * 3;
        for (int x = 0; x < image.width; ++x) {
            const auto rgba = develop(x, y);
            for (std::size_t c = 0; c < 3; ++c) *byte++ = static_cast<std::uint8_t>(rgba[c]);
        }
    });
    return out;
}

}  // namespace gischt
