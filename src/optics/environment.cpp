// SPDX-License-Identifier: Apache-2.0
#include "optics/environment.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "image/color.h"

namespace gischt {
namespace {

// The map's coordinates of a direction: u to the right, v down, both in [0,1].
Vec2d coordinates(const Vec3d& d) {
    const double u = 0.5 - std::atan2(d.y, d.x) / (2 * pi);
    const double v = std::acos(std::clamp(d.z, -1.0, 1.0)) / pi;
    return {u, v};
}

Vec3d direction_of(double u, double v) {
    const double turn = 2 * pi * (0.5 - u), sine = std::sin(pi * v);
    return {sine * std::cos(turn), sine * std::sin(turn), std::cos(pi * v)};
}

}  // namespace

EnvironmentMap::EnvironmentMap(const Image& image) : width_(image.width), height_(image.height) {
    const auto color = image.color();
    texels_.resize(image.pixel_count());
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        const Vec3f c{color[0][i], color[1][i], color[2][i]};
        if (!std::isfinite(c.x + c.y + c.z)) {
            throw Error(ErrorKind::Input, "environment",
                        "the picture has values that are not finite numbers");
        }
        texels_[i] = max(c, Vec3f(0));
    }
    integrate();
    distribution_ = distribution();
}

EnvironmentMap::EnvironmentMap(int width, int height,
                               const std::function<Vec3f(const Vec3d&)>& radiance)
    : width_(width), height_(height) {
    texels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    parallel_for(height, 1, [&](int y) {
        for (int x = 0; x < width; ++x) {
            texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)] =
                radiance(direction_of((x + 0.5) / width, (y + 0.5) / height));
        }
    });
    integrate();
    distribution_ = distribution();
}

Vec3f EnvironmentMap::radiance(const Vec3d& direction) const {
    const Vec2d c = coordinates(direction);
    const double x = c.x * width_ - 0.5, y = std::clamp(c.y * height_ - 0.5, 0.0, height_ - 1.0);
    const double x_floor = std::floor(x);
    const int x0 = (static_cast<int>(x_floor) + width_) % width_, x1 = (x0 + 1) % width_;
    const int y0 = static_cast<int>(y), y1 = std::min(y0 + 1, height_ - 1);
    const auto s = static_cast<float>(x - x_floor), t = static_cast<float>(y - y0);
    return (1 - t) * ((1 - s) * texel(x0, y0) + s * texel(x1, y0)) +
           t * ((1 - s) * texel(x0, y1) + s * texel(x1, y1));
}

void EnvironmentMap::integrate() {
    struct Row {
        Vec3d mean;
        std::array<Vec3d, 9> harmonic;
    };
    std::vector<Row> rows(static_cast<std::size_t>(height_));
    parallel_for(height_, 1, [&](int y) {
        Row& row = rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < width_; ++x) {
            const Vec3d value(texel(x, y));
            const auto basis =
                harmonic_basis(direction_of((x + 0.5) / width_, (y + 0.5) / height_));
            row.mean += value;
            for (std::size_t i = 0; i < 9; ++i) row.harmonic[i] += basis[i] * value;
        }
    });
    Vec3d mean;
    std::array<Vec3d, 9> harmonic{};
    for (int y = 0; y < height_; ++y) {
        // Solid angle of a pixel, exact for the row.
        const double angle =
            2 * pi / width_ * (std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_));
        const Row& row = rows[static_cast<std::size_t>(y)];
        mean += angle * row.mean;
        for (std::size_t i = 0; i < 9; ++i) harmonic[i] += angle * row.harmonic[i];
    }
    mean_ = Vec3f(mean * (0.25 / pi));
    for (std::size_t i = 0; i < 9; ++i) harmonics_.coefficient[i] = Vec3f(harmonic[i]);
}

Distribution2d EnvironmentMap::distribution() const {
    std::vector<double> brightness(texels_.size());
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        brightness[i] = static_cast<double>(luminance(texels_[i]));
    }
    const auto at = [&](int x, int y) {
        const int wrapped = (x + width_) % width_, clamped = std::clamp(y, 0, height_ - 1);
        return brightness[static_cast<std::size_t>(clamped) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(wrapped)];
    };
    // The mean of the bilinear interpolation over a pixel weighs 1 6 1: a bright pixel shines into
    // its neighbours' cells, and whatever shines must be drawn.
    const auto across = [&](int x, int y) {
        return 0.125 * at(x - 1, y) + 0.75 * at(x, y) + 0.125 * at(x + 1, y);
    };
    const int columns = std::min(width_, 1024), rows = std::min(height_, 512);
    std::vector<double> weight(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int y = 0; y < height_; ++y) {
        const double sine = std::sin(pi * (y + 0.5) / height_);
        const std::int64_t row = static_cast<std::int64_t>(y) * rows / height_;
        for (int x = 0; x < width_; ++x) {
            const std::int64_t column = static_cast<std::int64_t>(x) * columns / width_;
            weight[static_cast<std::size_t>(row * columns + column)] +=
                sine * (0.125 * across(x, y - 1) + 0.75 * across(x, y) + 0.125 * across(x, y + 1));
        }
    }
    return Distribution2d(std::move(weight), columns, rows);
}

EnvironmentMap::Sample EnvironmentMap::sample(Vec2f u) const {
    const Vec2d c = distribution_.sample(u);
    Sample s;
    s.direction = direction_of(c.x, c.y);
    s.radiance = radiance(s.direction);
    s.pdf = pdf(s.direction);
    return s;
}

float EnvironmentMap::pdf(const Vec3d& direction) const {
    const double sine = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    if (!(sine > 0)) return 0;
    // du dv = dw / (2 pi^2 sine).
    const double density = distribution_.density(coordinates(direction));
    return static_cast<float>(density / (2 * pi * pi * sine));
}

LightSample ConstantLight::sample(const Vec3d&, Vec2f u) const {
    const double z = 1 - 2 * static_cast<double>(u.x), turn = 2 * pi * static_cast<double>(u.y);
    const double sine = std::sqrt(std::max(0.0, 1 - z * z));
    LightSample s;
    s.direction = {sine * std::cos(turn), sine * std::sin(turn), z};
    s.weight = radiance_ * static_cast<float>(4 * pi);
    s.pdf = static_cast<float>(0.25 / pi);
    return s;
}

float ConstantLight::pdf(const Vec3d&, const Vec3d&) const {
    return static_cast<float>(0.25 / pi);
}

EnvironmentLight::EnvironmentLight(EnvironmentMap::Ptr map, const Transform& to_world,
                                   const Vec3f& scale)
    : map_(std::move(map)), to_world_(to_world), to_map_(to_world.inverse()), scale_(scale) {}

LightSample EnvironmentLight::sample(const Vec3d&, Vec2f u) const {
    const EnvironmentMap::Sample s = map_->sample(u);
    LightSample out;
    out.direction = to_world_.vector(s.direction);
    if (s.pdf > 0) out.weight = scale_ * s.radiance * (1 / s.pdf);
    out.pdf = s.pdf;
    return out;
}

float EnvironmentLight::pdf(const Vec3d&, const Vec3d& direction) const {
    return map_->pdf(to_map_.vector(direction));
}

Vec3f EnvironmentLight::radiance(const Vec3d& direction) const {
    return scale_ * map_->radiance(to_map_.vector(direction));
}

Vec3f EnvironmentLight::lobe(const Vec3d& direction, float g) const {
    return scale_ * map_->harmonics().lobe(to_map_.vector(direction), g);
}

Vec3f EnvironmentLight::irradiance(const Vec3d& normal) const {
    return scale_ * map_->harmonics().irradiance(to_map_.vector(normal));
}

}  // namespace gischt
