// SPDX-License-Identifier: Apache-2.0
#include "image/draw.h"

#include <algorithm>
#include <cmath>

#include "image/font.h"

namespace gischt {
namespace {

// The planes that are drawn on, looked up once.
class Canvas {
  public:
    explicit Canvas(Image& image) : image_(image), color_(image.color()) {
        if (image.has("A")) alpha_ = image.channel("A");
    }
    int width() const { return image_.width; }
    int height() const { return image_.height; }

    // Mixes a color in by its coverage of the pixel, in [0,1].
    void blend(int x, int y, const Vec3f& color, float coverage) {
        if (x < 0 || y < 0 || x >= width() || y >= height()) return;
        const std::size_t i = image_.index(x, y);
        for (int c = 0; c < 3; ++c) {
            float& v = color_[static_cast<std::size_t>(c)][i];
            v += coverage * (color[c] - v);
        }
        if (!alpha_.empty()) alpha_[i] += coverage * (1 - alpha_[i]);
    }

  private:
    Image& image_;
    std::array<std::span<float>, 3> color_;
    std::span<float> alpha_;
};

void fill(Canvas& canvas, Vec2i at, Vec2i size, const Vec3f& color) {
    const int x0 = std::max(at.x, 0), x1 = std::min(at.x + size.x, canvas.width());
    const int y0 = std::max(at.y, 0), y1 = std::min(at.y + size.y, canvas.height());
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) canvas.blend(x, y, color, 1);
    }
}

// Distance of p from the segment a b.
float distance(Vec2f p, Vec2f a, Vec2f b) {
    const Vec2f ab{b.x - a.x, b.y - a.y}, ap{p.x - a.x, p.y - a.y};
    const float length_2 = ab.x * ab.x + ab.y * ab.y;
    const float along = ap.x * ab.x + ap.y * ab.y;
    const float t = length_2 > 0 ? std::clamp(along / length_2, 0.0f, 1.0f) : 0;
    return std::hypot(ap.x - t * ab.x, ap.y - t * ab.y);
}

// Calls f(x, y) for the pixels of the canvas within `reach` of the box around a and b.
template <class F>
void for_pixels_near(const Canvas& canvas, Vec2f a, Vec2f b, float reach, F&& f) {
    auto range = [reach](float u, float v, int size) {
        const float largest = static_cast<float>(size);
        return Vec2i{static_cast<int>(std::clamp(std::min(u, v) - reach, 0.0f, largest)),
                     static_cast<int>(std::clamp(std::max(u, v) + reach + 1, 0.0f, largest))};
    };
    const Vec2i xs = range(a.x, b.x, canvas.width()), ys = range(a.y, b.y, canvas.height());
    for (int y = ys.x; y < ys.y; ++y) {
        for (int x = xs.x; x < xs.y; ++x) f(x, y);
    }
}

Vec2f centre(int x, int y) {
    return {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
}

// A filled triangle with one corner at `tip`: the smooth minimum of its three edge distances.
void draw_head(Canvas& canvas, Vec2f tip, Vec2f along, float size, const Vec3f& color) {
    const Vec2f back{tip.x - size * along.x, tip.y - size * along.y};
    // Half as wide as long on either side; the flanks' normals have length hypot(1, 0.5).
    constexpr float slope = 0.5f;
    const float scale = 1 / std::hypot(1.0f, slope);
    for_pixels_near(canvas, tip, back, size, [&](int x, int y) {
        const Vec2f p = centre(x, y), d{p.x - tip.x, p.y - tip.y};
        const float depth = -(d.x * along.x + d.y * along.y);
        const float side = std::abs(d.x * along.y - d.y * along.x);
        const float inside = std::min((slope * depth - side) * scale, size - depth);
        const float coverage = std::clamp(inside + 0.5f, 0.0f, 1.0f);
        if (coverage > 0) canvas.blend(x, y, color, coverage);
    });
}

void line(Canvas& canvas, Vec2f from, Vec2f to, const Vec3f& color, float width) {
    for_pixels_near(canvas, from, to, 0.5f * width + 1, [&](int x, int y) {
        const float outside = distance(centre(x, y), from, to) - 0.5f * width;
        const float coverage = std::clamp(0.5f - outside, 0.0f, 1.0f);
        if (coverage > 0) canvas.blend(x, y, color, coverage);
    });
}

}  // namespace

Vec2i text_size(std::string_view text, int scale) {
    int columns = 0, column = 0, lines = 1;
    for (const char c : text) {
        if (c == '\n') {
            ++lines;
            column = 0;
        } else {
            columns = std::max(columns, ++column);
        }
    }
    if (columns == 0) return {0, 0};
    return {scale * (columns * (glyph_width + 1) - 1), scale * (lines * (glyph_height + 1) - 1)};
}

void draw_text(Image& image, Vec2i at, std::string_view text, const Vec3f& color, int scale) {
    Canvas canvas(image);
    Vec2i pen = at;
    for (const char c : text) {
        if (c == '\n') {
            pen = {at.x, pen.y + scale * (glyph_height + 1)};
            continue;
        }
        const auto& rows = glyph(c);
        for (int y = 0; y < glyph_height; ++y) {
            for (int x = 0; x < glyph_width; ++x) {
                if (!(rows[static_cast<std::size_t>(y)] >> (glyph_width - 1 - x) & 1)) continue;
                fill(canvas, {pen.x + scale * x, pen.y + scale * y}, {scale, scale}, color);
            }
        }
        pen.x += scale * (glyph_width + 1);
    }
}

void fill_rectangle(Image& image, Vec2i at, Vec2i size, const Vec3f& color) {
    Canvas canvas(image);
    fill(canvas, at, size, color);
}

void draw_line(Image& image, Vec2f from, Vec2f to, const Vec3f& color, float width) {
    Canvas canvas(image);
    line(canvas, from, to, color, width);
}

void draw_arrow(Image& image, Vec2f from, Vec2f to, const Vec3f& color, float width) {
    const float length = std::hypot(to.x - from.x, to.y - from.y);
    if (!(length > 0) || !std::isfinite(length)) return;
    const Vec2f along{(to.x - from.x) / length, (to.y - from.y) / length};
    const float head = std::min(4 * width + 3, 0.6f * length);
    Canvas canvas(image);
    // The shaft ends inside the head, where the head is wider than it.
    const Vec2f neck{to.x - 0.8f * head * along.x, to.y - 0.8f * head * along.y};
    line(canvas, from, neck, color, width);
    draw_head(canvas, to, along, head, color);
}

}  // namespace gischt
