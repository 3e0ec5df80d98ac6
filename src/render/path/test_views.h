// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "math/noise.h"
#include "optics/environment.h"
#include "optics/local_lights.h"
#include "optics/medium.h"
#include "optics/surface_params.h"
#include "render/path/path_tracer.h"

// Views in which the truth is known, and the comparison of Monte-Carlo estimates with it.
namespace gischt::path_test {

using MediumPtr = std::shared_ptr<const Medium>;

// A mean of independent batches and its standard error, per channel.
struct Estimate {
    Vec3d mean, error;
    int batches = 0;
};

// Of `batches` results of a function of the batch's number. Numbers within a batch may be
// stratified, as the spread of the batches tells the error whatever they are.
inline Estimate estimate(int batches, const std::function<Vec3d(int)>& batch) {
    std::vector<Vec3d> values;
    Vec3d sum, squares;
    for (int b = 0; b < batches; ++b) sum += values.emplace_back(batch(b));
    const Vec3d mean = sum / Vec3d(batches);
    for (const Vec3d& v : values) squares += (v - mean) * (v - mean);
    squares = squares / Vec3d(double(batches) * (batches - 1));
    return {mean, {std::sqrt(squares.x), std::sqrt(squares.y), std::sqrt(squares.z)}, batches};
}

// How many standard errors a mean may be off, in either direction, such that one of so many
// comparisons fails by chance with probability 1e-3 (Bonferroni). Student's t by its expansion in
// 1/n around the normal distribution (Fisher & Cornish 1960).
inline double critical_z(int comparisons, int batches) {
    const double tail = 1e-3 / comparisons;
    double low = 0, high = 12;
    for (int i = 0; i < 60; ++i) {
        const double z = 0.5 * (low + high);
        (std::erfc(z / std::sqrt(2.0)) > tail ? low : high) = z;
    }
    const double z = low, n = batches - 1;
    return z + (z * z * z + z) / (4 * n) +
           (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

// `rounding` is what float arithmetic may add, relative to the truth.
inline void expect_mean(const Estimate& got, int channel, double truth, int comparisons,
                        const std::string& name, double rounding = 2e-6) {
    const double off = got.mean[channel] - truth;
    EXPECT_LE(std::abs(off), critical_z(comparisons, got.batches) * got.error[channel] +
                                 rounding * std::abs(truth))
        << name << ": " << got.mean[channel] << " +- " << got.error[channel] << ", not " << truth
        << " (z " << off / got.error[channel] << ")";
}

// Two independent estimates of the same.
inline void expect_same_mean(const Estimate& a, const Estimate& b, int comparisons,
                             const std::string& name) {
    for (int c = 0; c < 3; ++c) {
        const double off = a.mean[c] - b.mean[c], error = std::hypot(a.error[c], b.error[c]);
        EXPECT_LE(std::abs(off), critical_z(comparisons, std::min(a.batches, b.batches)) * error +
                                     2e-6 * std::abs(b.mean[c]))
            << name << " channel " << c << ": " << a.mean[c] << " and " << b.mean[c] << " (z "
            << off / error << ", error " << 100 * error / b.mean[c] << " %)";
    }
}

struct Effort {
    int depth = 10'000, batches = 64, samples = 64;
    std::uint64_t seed = 1;
};

// The mean of what rays through part (x, y) of a picture cut into edge x edge parts see.
using Seen = std::function<Vec3d(const Ray&, const PixelSampler&)>;
inline Estimate mean_of_part(const View& view, const Seen& seen, int x, int y, int edge,
                             const Effort& effort) {
    return estimate(effort.batches, [&](int batch) {
        const std::uint64_t key = random_key(effort.seed, static_cast<std::uint64_t>(batch));
        Vec3d sum;
        for (int i = 0; i < effort.samples; ++i) {
            const PixelSampler numbers(key, 1, x, y, static_cast<std::uint32_t>(i));
            const Vec2f place = numbers.two(0);
            const Ray ray = view.camera.ray((x + double(place.x)) / edge * view.width(),
                                            (y + double(place.y)) / edge * view.height());
            sum += seen(ray, numbers);
        }
        return sum / Vec3d(effort.samples);
    });
}

// A view ready to be traced.
struct Traced {
    Job job;
    PathScene scene;
    PathTracer tracer;

    // Keeps references to both.
    Traced(const View& view, const PathParams& params, int depth)
        : scene(view, params, job), tracer(scene, depth, false) {}
    Seen seen() {
        return [this](const Ray& ray, const PixelSampler& numbers) {
            return Vec3d(tracer(ray, 0.5f, numbers).radiance);
        };
    }
};

// The mean radiance of the whole picture.
inline Estimate mean_radiance(const View& view, const PathParams& params, const Effort& effort) {
    Traced traced(view, params, effort.depth);
    return mean_of_part(view, traced.seen(), 0, 0, 1, effort);
}

// An orthographic camera that looks from `from` to the origin at a square of the given height.
inline Camera ortho(const Vec3d& from, double height, int size = 1) {
    CameraParams p;
    p.projection = Projection::Orthographic;
    p.position = Keyed<Vec3d>(from);
    p.target = Keyed<Vec3d>(Vec3d{});
    p.height = Keyed<double>(height);
    return Camera(p, 0, size, size);
}

inline MediumParams coefficients(const Vec3d& extinction, const Vec3d& albedo, double g = 0) {
    MediumParams p;
    p.extinction = Keyed<Vec3d>(extinction);
    p.albedo = Keyed<Vec3d>(albedo);
    p.g = Keyed<double>(g);
    return p;
}

inline MediumPtr solid(const Region& region, const MediumParams& params, double kelvin = 0) {
    return std::make_shared<const Medium>(region, params, 0, kelvin);
}

// Density by function on n^3 voxels of [-1,1]^3, further fields by name.
using Density = std::function<double(const Vec3d&)>;
inline void add_field(Frame& frame, const std::string& name, int n, const Density& value) {
    Field& f = frame.fields[name];
    f.component.emplace_back(TileMap::box(Vec3i(n)));
    f.to_world = Transform::scale_translate(2.0 / n, Vec3d(-1));
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3i c(i % n, i / n % n, i / n / n);
        f.component[0].ref(c) = static_cast<float>(value(f.to_world.point(Vec3d(c) + Vec3d(0.5))));
    }
}
inline MediumPtr voxels(int n, const Density& density, const MediumParams& params) {
    Frame frame;
    add_field(frame, "density", n, density);
    Job job;
    return std::make_shared<const Medium>(frame, params, 0, job);
}

// Soft lumps between 0 and 1 around the middle, with empty space around.
inline double lumps(const Vec3d& p, std::uint64_t seed = 7) {
    const double lump = 0.9 - length(p) + 0.5 * double(gradient_noise(2.5 * p, seed));
    return std::clamp(2 * lump, 0.0, 1.0);
}

inline LightPtr delta_sun(const Vec3d& towards, const Vec3f& irradiance) {
    return std::make_shared<SunLight>(normalize(towards), irradiance, 0);
}
inline LightPtr sky(const Vec3f& radiance) {
    return std::make_shared<ConstantLight>(radiance);
}

}  // namespace gischt::path_test
