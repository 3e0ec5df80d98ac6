// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace gischt {

// A picture over the unit square that repeats without end: u to the right, v upwards from the
// bottom row. Bilinear between the centres of the pixels, linear light. Immutable.
class Texture {
  public:
    // Takes the colour of an image. Throws Error{Input} when it has none, or values that are
    // negative or not finite.
    explicit Texture(const Image& image);

    Vec3f at(const Vec2d& uv) const;

  private:
    const Vec3f& texel(int x, int y) const;

    int width_, height_;
    std::vector<Vec3f> texels_;
};

}  // namespace gischt
