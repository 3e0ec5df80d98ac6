// SPDX-License-Identifier: Apache-2.0
#include "optics/texture.h"

#include <cmath>

#include "base/error.h"

namespace gischt {

Texture::Texture(const Image& image) : width_(image.width), height_(image.height) {
    const auto [r, g, b] = image.color();
    texels_.reserve(image.pixel_count());
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const Vec3f c{r[i], g[i], b[i]};
        if (!(min_component(c) >= 0) || !std::isfinite(c.x + c.y + c.z)) {
            throw Error(ErrorKind::Input, "texture",
                        "the picture has values that are negative or not finite");
        }
        texels_.push_back(c);
    }
}

const Vec3f& Texture::texel(int x, int y) const {
    const int i = ((x % width_) + width_) % width_, j = ((y % height_) + height_) % height_;
    return texels_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(i)];
}

Vec3f Texture::at(const Vec2d& uv) const {
    if (!std::isfinite(uv.x + uv.y)) return texel(0, 0);
    const double x = (uv.x - std::floor(uv.x)) * width_ - 0.5,
                 y = (1 - (uv.y - std::floor(uv.y))) * height_ - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto a = static_cast<float>(x - i), b = static_cast<float>(y - j);
    return (1 - b) * ((1 - a) * texel(i, j) + a * texel(i + 1, j)) +
           b * ((1 - a) * texel(i, j + 1) + a * texel(i + 1, j + 1));
}

}  // namespace gischt
