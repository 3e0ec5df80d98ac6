// SPDX-License-Identifier: Apache-2.0
// Plane-parallel media against published solutions of radiative transfer, by paths from both ends.
#include <fmt/format.h>

#include "render/bdpt/test_bdpt.h"
#include "render/mlt/mlt.h"
#include "render/path/test_slabs.h"

namespace gischt {
namespace {

using namespace bdpt_test;

constexpr int enough = 400;  // scatterings; fewer than 1e-9 of the light is left after them

using Method = std::function<Estimate(const View& view)>;

void expect_tables(const Method& method, double most_error) {
    for (const SlabCase& c : slabs) {
        const std::string name = fmt::format("g {} albedo {} tau {}", c.g, c.albedo, c.tau);
        const Estimate got = method(mirrored_slab(c.tau, c.albedo, c.g));
        expect_mean(got, 0, c.reflectance, slab_comparisons, name + " R", 0.5e-5 / c.reflectance);
        expect_mean(got, 1, c.transmittance, slab_comparisons, name + " T",
                    0.5e-5 / c.transmittance);
        EXPECT_LT(got.error.x, most_error * c.reflectance) << name;
        EXPECT_LT(got.error.y, most_error * c.transmittance) << name;
    }
}

Method by_bdpt(int batches, int samples) {
    return [=](const View& view) {
        return mean_by_bdpt(view, {},
                            {.depth = enough, .batches = batches, .samples = samples, .seed = 9});
    };
}

// Independent runs on a picture of 4 x 4 pixels.
Method by_mlt(int runs, int mutations) {
    return [=](const View& seen) {
        View view = seen;
        view.camera = ortho({0, 0, 10}, 0.5, 4);
        MltParams params;
        params.chains = 4;
        params.bootstrap = 16;
        return estimate(runs, [&](int run) {
            RenderSettings s;
            s.samples_per_pixel = mutations;
            s.depth = enough;
            s.seed = 500 + static_cast<std::uint64_t>(run);
            s.filter = FilterKind::Box;
            Job job;
            const Image image = make_mlt_method(params)->render(view, s, job).image;
            Vec3d sum;
            const auto color = image.color();
            for (int c = 0; c < 3; ++c) {
                for (const float v : color[static_cast<std::size_t>(c)])
                    sum[c] += static_cast<double>(v);
            }
            return sum / Vec3d(double(image.pixel_count()));
        });
    };
}

TEST(BdptSlab, ReflectsAndTransmitsWhatTheTablesSay) {
    expect_tables(by_bdpt(32, 256), 0.1);
}
TEST(BdptSlabLong, ReflectsAndTransmitsWhatTheTablesSay) {
    expect_tables(by_bdpt(256, 2048), 0.012);
}
TEST(MltSlab, ReflectsAndTransmitsWhatTheTablesSay) {
    expect_tables(by_mlt(16, 24), 0.35);
}
TEST(MltSlabLong, ReflectsAndTransmitsWhatTheTablesSay) {
    expect_tables(by_mlt(64, 128), 0.07);
}

}  // namespace
}  // namespace gischt
