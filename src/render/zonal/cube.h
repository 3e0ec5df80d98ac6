// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/units.h"
#include "render/path/test_views.h"
#include "render/zonal/scattered_march.h"

// For tests: a cube of even fog, lit from one side, and what leaves each of its faces.
namespace gischt::path_test {

// Edge 1, centred on the origin, lit along +x: a sun of irradiance 1 on the face at -x. Scattering
// is even, albedo 0.95.
inline View lit_cube(double thickness) {
    View view;
    view.media = {
        solid(Region::box({Vec3d(-0.5), Vec3d(0.5)}), coefficients(Vec3d(thickness), Vec3d(0.95)))};
    view.lights = {delta_sun({-1, 0, 0}, Vec3f(1))};
    view.background = Vec3f(0);
    view.camera = ortho({0, -3, 0}, 1);
    return view;
}

// Mean exitant radiance (exitance over pi) of the face that is lit, the one opposite, and the four
// at the sides, W/(m^2 sr), of light that was scattered at least once: by path tracing, with its
// standard error. CubeLong.FacesAreThoseOfPathTracing makes it anew.
struct CubeFaces {
    double lit, back, side;
};
struct CubeReference {
    double thickness;
    CubeFaces mean, error;
};
inline constexpr std::array<CubeReference, 2> cube_references{{
    {4, {0.090370, 0.013590, 0.040121}, {0.000049, 0.000017, 0.000030}},
    {10, {0.127937, 0.001401, 0.025659}, {0.000045, 0.000006, 0.000023}},
}};

// A ray into the cube by one of its faces, evenly distributed over the face and by cosine over the
// directions: the mean of what such rays see is the mean exitant radiance.
inline Ray ray_into_cube(int axis, int end, Vec2f place, Vec2f turn) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double inward = end == 0 ? 1 : -1, sine = std::sqrt(double(turn.x)),
                 angle = 2 * pi * double(turn.y);
    Ray ray;
    ray.origin[u] = double(place.x) - 0.5;
    ray.origin[v] = double(place.y) - 0.5;
    ray.origin[axis] = -0.5 * inward;
    ray.direction[axis] = inward * std::sqrt(1 - sine * sine);
    ray.direction[u] = sine * std::cos(angle);
    ray.direction[v] = sine * std::sin(angle);
    ray.origin -= 1e-3 * ray.direction;
    return ray;
}

// The mean over a face of what `seen` sees there.
inline Estimate cube_face(int axis, int end, int batches, int samples, const Seen& seen) {
    return estimate(batches, [&](int batch) {
        Vec3d sum;
        const std::uint64_t key = random_key(91, static_cast<std::uint64_t>(2 * axis + end),
                                             static_cast<std::uint64_t>(batch));
        for (int i = 0; i < samples; ++i) {
            const PixelSampler numbers(key, 1, batch & 63, axis, static_cast<std::uint32_t>(i));
            sum += seen(ray_into_cube(axis, end, numbers.two(0), numbers.two(1)), numbers);
        }
        return sum / Vec3d(samples);
    });
}

// The means over the faces of the first scattering by path tracing and all others from a source, as
// a picture shows them; samples per face.
inline CubeFaces gathered_faces(const View& view, const ScatteredSource& source, int samples) {
    Traced traced(view, {}, 1);
    ScatteredMarch march(traced.scene, source, {});
    const Seen seen = [&](const Ray& ray, const PixelSampler& numbers) {
        return Vec3d(traced.tracer(ray, 0.5f, numbers).radiance + march(ray, numbers.one(30)));
    };
    const auto face = [&](int axis, int end) {
        return cube_face(axis, end, 4, samples / 4, seen).mean.x;
    };
    return {face(0, 0), face(0, 1), face(1, 0)};
}

inline void expect_faces(const CubeFaces& got, const CubeFaces& truth, double share,
                         const std::string& name) {
    EXPECT_NEAR(got.lit, truth.lit, share * truth.lit) << name << " lit";
    EXPECT_NEAR(got.back, truth.back, share * truth.back) << name << " back";
    EXPECT_NEAR(got.side, truth.side, share * truth.side) << name << " side";
}

}  // namespace gischt::path_test
