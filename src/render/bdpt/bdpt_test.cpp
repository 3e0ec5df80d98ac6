// SPDX-License-Identifier: Apache-2.0
// The method as a whole: its bits, its film, and what it refuses.
#include "render/bdpt/bdpt.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/bdpt/test_bdpt.h"
#include "render/path/path.h"

namespace gischt {
namespace {

using namespace bdpt_test;

RenderSettings settings_of(int samples, int depth) {
    RenderSettings s;
    s.samples_per_pixel = samples;
    s.depth = depth;
    return s;
}

View small_view(int size) {
    View view = glass_and_smoke();
    CameraParams p;
    p.position = Keyed<Vec3d>(Vec3d(0, -5, 1.2));
    p.target = Keyed<Vec3d>(Vec3d{});
    p.fov_degrees = Keyed<double>(35);
    view.camera = Camera(p, 0, size, size);
    view.lights = {delta_sun({-1, -1, 1}, {3, 2, 1}), sky(Vec3f(0.1f))};
    return view;
}

TEST(Bdpt, IsTheSameOnAnyNumberOfThreads) {
    const View view = small_view(24);
    Job job;
    const RenderResult all = make_bdpt_method({})->render(view, settings_of(4, 8), job);
    const ThreadLimit one(1);
    const RenderResult single = make_bdpt_method({})->render(view, settings_of(4, 8), job);
    EXPECT_EQ(all.image, single.image);
    EXPECT_EQ(all.statistics.rays, single.statistics.rays);
}

TEST(Bdpt, FourPartsAreTheWhole) {
    const View view = small_view(12);
    Job job;
    FilmState whole, sum;
    RenderSettings settings = settings_of(16, 8);
    settings.film = &whole;
    make_bdpt_method({})->render(view, settings, job);
    settings.samples_per_pixel = 4;
    for (const int first : {4, 0, 12, 8}) {
        FilmState part;
        settings.film = &part;
        settings.first_sample = first;
        make_bdpt_method({})->render(view, settings, job);
        if (sum.film) {
            sum.merge(part);
        } else {
            sum = part;
        }
    }
    EXPECT_EQ(sum.image(), whole.image());
}

// A wide filter takes the same light, pixel by pixel, as the path tracer's.
TEST(Bdpt, SplatsHaveTheFootprintOfTheFilter) {
    View view;
    CameraParams p;
    p.position = Keyed<Vec3d>(Vec3d(0, -4, 0));
    p.target = Keyed<Vec3d>(Vec3d{});
    p.fov_degrees = Keyed<double>(30);
    view.camera = Camera(p, 0, 4, 4);
    view.media = {solid(Region::sphere({0.3, 0, 0.3}, 0.5), coefficients(Vec3d(2), Vec3d(0.9)))};
    view.lights = {delta_sun({-1, -1, 1}, Vec3f(3))};
    view.background = Vec3f{};
    for (const FilterKind kind : {FilterKind::Box, FilterKind::Gaussian, FilterKind::Mitchell}) {
        constexpr int batches = 32, pixels = 16;
        const auto picture = [&](RenderMethod& method, int samples) {
            std::vector<std::vector<double>> all;
            for (int b = 0; b < batches; ++b) {
                RenderSettings settings = settings_of(samples, 2);
                settings.filter = kind;
                settings.seed = static_cast<std::uint64_t>(b);
                Job job;
                const Image image = method.render(view, settings, job).image;
                std::vector<double> values;
                for (std::size_t i = 0; i < pixels; ++i) {
                    values.push_back(double(image.planes[0].values[i]));
                }
                all.push_back(values);
            }
            return all;
        };
        const auto a = picture(*make_bdpt_method({}), 64), b = picture(*make_path_method({}), 64);
        double brightest = 0;
        for (const auto& one : b)
            brightest = std::max(brightest, *std::max_element(one.begin(), one.end()));
        int compared = 0;
        for (std::size_t i = 0; i < pixels; ++i) {
            const auto of = [&](const auto& pictures) {
                return estimate(batches, [&](int k) {
                    return Vec3d(pictures[static_cast<std::size_t>(k)][i]);
                });
            };
            const Estimate x = of(a), y = of(b);
            const double error = std::hypot(x.error.x, y.error.x);
            // Where samples rarely see anything their spread does not tell the error.
            if (x.mean.x < 0.02 * brightest && y.mean.x < 0.02 * brightest) continue;
            ++compared;
            EXPECT_LE(std::abs(x.mean.x - y.mean.x), critical_z(48, batches) * error + 1e-9)
                << "filter " << static_cast<int>(kind) << " pixel " << i << ": " << x.mean.x
                << " and " << y.mean.x;
        }
        EXPECT_GT(compared, 5);
    }
}

// A point light in a ball of glass with the index 1 would be seen through; with 1.5 the power that
// leaves is that of the light, but for what total reflection holds back: none from the middle.
TEST(Bdpt, FindsAPointLightInAGlassBall) {
    View view;
    SphereSurface glass = ball({}, 0.2, MaterialKind::Dielectric);
    SphereSurface hull = ball({}, 1, MaterialKind::Lambert);
    hull.material.albedo = Vec3d(0.5);
    view.surfaces = SurfaceSet({glass, hull}, 0);
    view.lights = {point({}, Vec3f(1))};
    view.camera = perspective({0, -0.7, 0}, {0, -1, 0}, 40);
    view.background = Vec3f{};
    // All light arrives in the end, as it is reflected within by the symmetry of the ball: fluxes
    // 4 pi I reach the hull of 4 pi m^2 evenly, and what it reflects comes back with r = albedo, so
    // the radiosity is albedo I / (1 - albedo). In units of L / n^2 the light inside of the glass,
    // told by its intensity as in vacuum, is n^2 as strong outside.
    const Estimate got = mean_by_bdpt(view, {}, {.depth = 200, .batches = 64, .samples = 512});
    for (int c = 0; c < 3; ++c) {
        expect_mean(got, c, 1.5 * 1.5 * 0.5 / (1 - 0.5) / pi, 3, "radiance of the hull");
    }
}

TEST(Bdpt, RefusesByName) {
    const auto hint_of = [](const View& view, const RenderSettings& settings) -> std::string {
        Job job;
        try {
            make_bdpt_method({})->render(view, settings, job);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Usage);
            return e.fact() + " | " + e.hint();
        }
        return "";
    };
    View view = small_view(4);
    EXPECT_EQ(hint_of(view, settings_of(1, 2)), "");
    RenderSettings noisy = settings_of(1, 2);
    noisy.noise = 0.1;
    EXPECT_NE(hint_of(view, noisy).find("--time"), std::string::npos);
    RenderSettings layers = settings_of(1, 2);
    layers.aovs = {"direct"};
    EXPECT_NE(hint_of(view, layers), "");
    layers.aovs = {"variance"};
    EXPECT_NE(hint_of(view, layers).find("'path'"), std::string::npos);
    View moving = view;
    moving.shutter = 0.1;
    EXPECT_NE(hint_of(moving, settings_of(1, 2)).find("motion blur"), std::string::npos);
    for (const bool is_holdout : {true, false}) {
        SphereSurface mask = ball({}, 0.2, MaterialKind::Lambert);
        (is_holdout ? mask.material.holdout : mask.material.shadow_catcher) = true;
        View masked = view;
        masked.surfaces = SurfaceSet({mask}, 0);
        EXPECT_NE(hint_of(masked, settings_of(1, 2)).find("'path'"), std::string::npos);
    }
}

}  // namespace
}  // namespace gischt
