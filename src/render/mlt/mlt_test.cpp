// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/mlt.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "render/bdpt/test_bdpt.h"

namespace gischt {
namespace {

using namespace bdpt_test;

View with_pixels(View view, int size) {
    CameraParams p;
    p.position = Keyed<Vec3d>(Vec3d(0, -5, 1.2));
    p.target = Keyed<Vec3d>(Vec3d{});
    p.fov_degrees = Keyed<double>(30);
    view.camera = Camera(p, 0, size, size);
    return view;
}

RenderSettings settings_of(int mutations, int depth, std::uint64_t seed = 0) {
    RenderSettings s;
    s.samples_per_pixel = mutations;
    s.depth = depth;
    s.seed = seed;
    s.filter = FilterKind::Box;
    return s;
}

// The mean of the picture, of independent runs.
Estimate mean_by_mlt(const View& view, const MltParams& params, int mutations, int depth,
                     int runs) {
    return estimate(runs, [&](int run) {
        Job job;
        const Image image =
            make_mlt_method(params)
                ->render(view,
                         settings_of(mutations, depth, 1000 + static_cast<std::uint64_t>(run)), job)
                .image;
        Vec3d sum;
        for (int c = 0; c < 3; ++c) {
            for (const float v : image.planes[static_cast<std::size_t>(c)].values) {
                sum[c] += static_cast<double>(v);
            }
        }
        return sum / Vec3d(double(image.pixel_count()));
    });
}

std::vector<NamedView> mlt_views() {
    std::vector<NamedView> all{{"glass ball with smoke under a lamp", glass_and_smoke(), 6},
                               {"every material", materials(), 12}};
    View fire;
    fire.media = {flame()};
    fire.surfaces = SurfaceSet({table(-0.8)}, 0);
    fire.background = Vec3f{};
    all.push_back({"flame over a table", fire, 4});
    View cloud;
    cloud.media = {cloud_of({1, 4, 15}, 0.5, {}, 7)};
    cloud.lights = {std::make_shared<SunLight>(normalize(Vec3d(-1, -1, 1)), Vec3f(3, 2, 1), 0.2),
                    sky(Vec3f(0.1f))};
    all.push_back({"coloured cloud", cloud, 5});
    return all;
}

void expect_agreement(const MltParams& params, int mutations, int runs) {
    const auto all = mlt_views();
    for (const NamedView& v : all) {
        const View view = with_pixels(v.view, 8);
        View whole = with_pixels(v.view, 1);  // the same square as one pixel
        const Estimate expected =
            mean_by_path(whole, {.depth = v.depth, .batches = 64, .samples = 256});
        for (const bool direct : {true, false}) {
            MltParams p = params;
            p.direct = direct;
            expect_same_mean(mean_by_mlt(view, p, mutations, v.depth, runs), expected,
                             2 * 3 * static_cast<int>(all.size()),
                             fmt::format("{}{}", v.name, direct ? ", direct apart" : ""));
        }
    }
}

TEST(Mlt, HasTheMeanOfPath) {
    MltParams params;
    params.chains = 2;
    params.bootstrap = 2;
    expect_agreement(params, 16, 32);
}
TEST(MltLong, HasTheMeanOfPath) {
    MltParams params;
    params.chains = 2;
    params.bootstrap = 2;
    expect_agreement(params, 256, 128);
}

// Chains of a single mutation would show how they start.
TEST(Mlt, HasNoBiasOfTheStart) {
    MltParams params;
    params.chains = 64;
    params.bootstrap = 1;
    expect_agreement(params, 8, 40);
}

TEST(Mlt, IsTheSameOnAnyNumberOfThreads) {
    const View view = with_pixels(glass_and_smoke(), 16);
    Job job;
    const RenderResult all = make_mlt_method({})->render(view, settings_of(4, 6), job);
    const ThreadLimit one(1);
    EXPECT_EQ(all.image, make_mlt_method({})->render(view, settings_of(4, 6), job).image);
}

TEST(Mlt, FourPartsAreTheWhole) {
    const View view = with_pixels(glass_and_smoke(), 12);
    Job job;
    FilmState whole, sum;
    RenderSettings settings = settings_of(8, 6);
    settings.film = &whole;
    make_mlt_method({})->render(view, settings, job);
    settings.samples_per_pixel = 2;
    for (const int first : {2, 0, 6, 4}) {
        FilmState part;
        settings.film = &part;
        settings.first_sample = first;
        make_mlt_method({})->render(view, settings, job);
        if (sum.film) {
            sum.merge(part);
        } else {
            sum = part;
        }
    }
    EXPECT_EQ(sum.image(), whole.image());
}

TEST(Mlt, GoesOnToTheSameBits) {
    const View view = with_pixels(glass_and_smoke(), 12);
    Job job;
    FilmState film;
    RenderSettings settings = settings_of(3, 6);
    settings.film = &film;
    make_mlt_method({})->render(view, settings, job);
    settings.samples_per_pixel = 8;
    const Image later = make_mlt_method({})->render(view, settings, job).image;
    EXPECT_EQ(later, make_mlt_method({})->render(view, settings_of(8, 6), job).image);
}

TEST(Mlt, RefusesByName) {
    View view = with_pixels(glass_and_smoke(), 4);
    view.shutter = 0.1;
    Job job;
    try {
        make_mlt_method({})->render(view, settings_of(1, 2), job);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Usage);
        EXPECT_NE(e.fact().find("motion blur"), std::string::npos);
    }
    RenderSettings noisy = settings_of(1, 2);
    noisy.noise = 0.1;
    view.shutter = 0;
    EXPECT_THROW(make_mlt_method({})->render(view, noisy, job), Error);
}

}  // namespace
}  // namespace gischt
