// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "base/units.h"
#include "grid/frame.h"
#include "math/noise.h"
#include "optics/environment.h"
#include "optics/local_lights.h"
#include "optics/medium.h"
#include "optics/surface_params.h"
#include "render/method.h"

namespace gischt {

// Views for the tests of the methods on graphics hardware.

inline MediumParams test_medium(const Vec3d& extinction, double albedo = 0.9, double g = 0) {
    MediumParams p;
    p.extinction = Keyed<Vec3d>(extinction);
    p.albedo = Keyed<Vec3d>(Vec3d(albedo));
    p.g = Keyed<double>(g);
    return p;
}

// Soft lumps in a box one metre wide around a centre, `n` cells along an edge, and a temperature.
inline std::shared_ptr<const Medium> test_cloud(int n, const MediumParams& params,
                                                const Vec3d& center = {}) {
    Frame frame;
    Field& density = frame.fields["density"];
    density.component.emplace_back(TileMap::box(Vec3i(n)));
    density.to_world = Transform::scale_translate(1.0 / n, center - Vec3d(0.5));
    Field heat = density;
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3i c(i % n, i / n % n, i / n / n);
        const Vec3d p = density.to_world.point(Vec3d(c) + Vec3d(0.5)) - center;
        const double lump =
            0.36 - length(p) + 0.2 * static_cast<double>(fractal_noise(4.0 * p, 3, 0.5f, 3));
        density.component[0].ref(c) = static_cast<float>(std::clamp(6 * lump, 0.0, 1.0));
        heat.component[0].ref(c) = static_cast<float>(1700 + 400 * p.x);
    }
    frame.fields["temperature"] = heat;
    Job job;
    return std::make_shared<const Medium>(frame, params, 0, job);
}

inline LightPtr test_sun(const Vec3d& towards, const Vec3f& irradiance = Vec3f(3)) {
    return std::make_shared<SunLight>(normalize(towards), irradiance, 0);
}

inline Camera test_camera(const Vec3d& position, int width = 96, int height = 72,
                          double fov_degrees = 30) {
    CameraParams camera;
    camera.position = Keyed<Vec3d>(position);
    camera.target = Keyed<Vec3d>(Vec3d(0));
    camera.fov_degrees = Keyed<double>(fov_degrees);
    return Camera(camera, 0, width, height);
}

inline View test_view(std::vector<std::shared_ptr<const Medium>> media,
                      const Vec3d& eye = {1.5, -2, 0.7}) {
    View view;
    view.camera = test_camera(eye);
    view.media = std::move(media);
    view.lights = {test_sun({1, -1, 2})};
    view.background = Vec3f(0.1f, 0.2f, 0.3f);
    return view;
}

inline RenderSettings test_settings(int samples) {
    RenderSettings settings;
    settings.samples_per_pixel = samples;
    settings.filter = FilterKind::Box;
    return settings;
}

// Means of two pictures, and the root of the mean squared difference, over R, G and B.
struct Comparison {
    double first = 0, second = 0, rms = 0;
    double ratio() const { return first / second; }
    double relative_rms() const { return rms / second; }
};
inline Comparison compared(const Image& a, const Image& b) {
    Comparison c;
    for (const std::string_view name : {"R", "G", "B"}) {
        const auto x = a.channel(name), y = b.channel(name);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const auto u = static_cast<double>(x[i]), v = static_cast<double>(y[i]);
            c.first += u;
            c.second += v;
            c.rms += (u - v) * (u - v);
        }
    }
    const double n = 3 * static_cast<double>(a.pixel_count());
    return {c.first / n, c.second / n, std::sqrt(c.rms / n)};
}

}  // namespace gischt
