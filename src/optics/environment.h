// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "image/image.h"
#include "math/transform.h"
#include "optics/distribution.h"
#include "optics/harmonics.h"
#include "optics/light.h"

namespace gischt {

// Light from infinitely far as a picture over the sphere, latitude by longitude, in its own frame:
// z up, the top row at +z, the middle column at +x, columns to the right clockwise seen from above,
// as Blender and Poly Haven have it. Bilinear between the centres of the pixels. Directions are
// drawn in proportion to luminance (Pharr, Jakob, Humphreys 2023, Physically Based Rendering,
// 12.5.2). Immutable.
class EnvironmentMap {
  public:
    using Ptr = std::shared_ptr<const EnvironmentMap>;

    // Takes the colour of an image; negative values count as 0. Throws Error{Input} when it has no
    // colour or values that are not finite.
    explicit EnvironmentMap(const Image& image);
    // From a function of the direction, taken at the centres of the pixels.
    EnvironmentMap(int width, int height, const std::function<Vec3f(const Vec3d&)>& radiance);

    Vec3f radiance(const Vec3d& direction) const;

    struct Sample {
        Vec3d direction;
        Vec3f radiance;
        float pdf = 0;  // 1/sr; 0 only for a black map
    };
    Sample sample(Vec2f u) const;
    float pdf(const Vec3d& direction) const;

    // Mean radiance over the sphere.
    const Vec3f& mean() const { return mean_; }
    const Harmonics& harmonics() const { return harmonics_; }
    int width() const { return width_; }
    int height() const { return height_; }
    const Vec3f& texel(int x, int y) const {
        return texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x)];
    }

  private:
    void integrate();
    Distribution2d distribution() const;

    int width_, height_;
    std::vector<Vec3f> texels_;
    Vec3f mean_;
    Harmonics harmonics_;
    Distribution2d distribution_{std::vector<double>{1}, 1,
                                 1};  // over (u, v), of at most 1024 x 512 cells
};

// The same radiance from all directions.
class ConstantLight : public Light {
  public:
    explicit ConstantLight(const Vec3f& radiance) : radiance_(radiance) {}

    LightSample sample(const Vec3d& point, Vec2f u) const override;
    float pdf(const Vec3d& point, const Vec3d& direction) const override;
    Vec3f radiance(const Vec3d&) const override { return radiance_; }
    bool is_delta() const override { return false; }
    bool is_infinite() const override { return true; }
    Vec3f mean_radiance(const Vec3d&) const override { return radiance_; }

  private:
    Vec3f radiance_;
};

// An environment map, turned and scaled.
class EnvironmentLight : public Light {
  public:
    // `to_world` is a rotation from the map's frame (z up) to the scene; scale is a factor.
    EnvironmentLight(EnvironmentMap::Ptr map, const Transform& to_world, const Vec3f& scale);

    const EnvironmentMap& map() const { return *map_; }

    LightSample sample(const Vec3d& point, Vec2f u) const override;
    float pdf(const Vec3d& point, const Vec3d& direction) const override;
    Vec3f radiance(const Vec3d& direction) const override;
    bool is_delta() const override { return false; }
    bool is_infinite() const override { return true; }
    Vec3f mean_radiance(const Vec3d&) const override { return scale_ * map_->mean(); }

    // Harmonics::lobe and irradiance in the scene's frame, scaled.
    Vec3f lobe(const Vec3d& direction, float g) const;
    Vec3f irradiance(const Vec3d& normal) const;

  private:
    EnvironmentMap::Ptr map_;
    Transform to_world_, to_map_;
    Vec3f scale_;
};

}  // namespace gischt
