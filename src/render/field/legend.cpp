// SPDX-License-Identifier: Apache-2.0
#include "render/field/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/draw.h"

namespace gischt {
namespace {

// All in dots of the font.
constexpr int bar_width = 12, tick_length = 4, gap = 4;

}  // namespace

Ticks make_ticks(double low, double high, int most) {
    // The smallest step of 1, 2, 5 times a power of ten that gives no more ticks than wanted.
    const double rough = (high - low) / most;
    double step = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
        const double first = std::ceil(low / (factor * step) - 1e-9);
        const double last = std::floor(high / (factor * step) + 1e-9);
        if (last - first + 1 > most) continue;
        step *= factor;
        break;
    }
    Ticks ticks;
    const double largest = std::max(std::abs(low), std::abs(high));
    const int magnitude = static_cast<int>(std::floor(std::log10(largest)));
    // More than five digits before or three zeros after the point go into a common factor.
    if (magnitude > 4 || magnitude < -2) ticks.exponent = magnitude;
    const double unit = std::pow(10.0, ticks.exponent);
    const int decimals =
        std::clamp(-static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)), 0, 9);
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
        ticks.at.push_back(k * step);
        // + 0.0 turns -0 into 0.
        ticks.label.push_back(fmt::format("{:.{}f}", k * step / unit + 0.0, decimals));
    }
    return ticks;
}

int legend_width(const Ticks& ticks, const LegendStyle& style) {
    int widest = 0;
    for (const std::string& label : ticks.label) {
        widest = std::max(widest, text_size(label, style.scale).x);
    }
    return (bar_width + tick_length + gap) * style.scale + widest;
}

void draw_legend(Image& image, Vec2i at, int height, ColormapKind map, Vec2d range,
                 const Ticks& ticks, const LegendStyle& style) {
    const int s = style.scale, bar = bar_width * s;
    draw_colormap(image, at, {bar, height}, map);
    for (std::size_t i = 0; i < ticks.at.size(); ++i) {
        const double share = (ticks.at[i] - range.x) / (range.y - range.x);
        const int y = at.y + static_cast<int>(std::lround((1 - share) * (height - 1)));
        const int thick = std::max(1, s / 2);
        fill_rectangle(image, {at.x + bar, y - thick / 2}, {tick_length * s, thick}, style.ink);
        const Vec2i size = text_size(ticks.label[i], s);
        draw_text(image, {at.x + bar + (tick_length + gap) * s, y - size.y / 2}, ticks.label[i],
                  style.ink, s);
    }
}

}  // namespace gischt
