// SPDX-License-Identifier: Apache-2.0
// Bidirectional path tracing has the mean of path tracing.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "render/bdpt/test_bdpt.h"

namespace gischt {
namespace {

using namespace bdpt_test;

std::vector<std::pair<std::string, BdptParams>> ways() {
    BdptParams plain, distances;
    plain.shadow = TransmittanceEstimator::Ratio;
    plain.roulette = plain.connection = 0;
    distances.weights = StrategyWeights::Distances;
    distances.shadow = TransmittanceEstimator::Exact;
    return {{"plain", plain}, {"as it is", {}}, {"distances", distances}};
}

void expect_agreement(int samples, std::uint64_t seed) {
    const auto rows = ways();
    const auto all = agreement_views();
    const int comparisons = 3 * static_cast<int>(rows.size() * all.size());
    for (const NamedView& v : all) {
        Effort effort{.depth = v.depth, .batches = 64, .samples = 4 * samples, .seed = seed};
        const Estimate expected = mean_by_path(v.view, effort);
        EXPECT_GT(max_component(expected.mean), 0) << v.name;
        effort.samples = samples;
        for (const auto& [name, params] : rows) {
            ++effort.seed;
            expect_same_mean(mean_by_bdpt(v.view, params, effort), expected, comparisons,
                             fmt::format("{}, {}", v.name, name));
        }
    }
}

TEST(BdptAgreement, WithPathUnderAllLights) {
    expect_agreement(24, 1);
}
TEST(BdptAgreementLong, WithPathUnderAllLights) {
    expect_agreement(1024, 100);
}

// Depth is counted the same, one scattering after the other.
TEST(BdptAgreement, WithPathAtEveryDepth) {
    View view = glass_and_smoke();
    view.lights = {sky(Vec3f(0.2f))};
    for (const int depth : {0, 1, 2, 3}) {
        const Effort effort{.depth = depth, .batches = 64, .samples = 64, .seed = 5};
        expect_same_mean(mean_by_bdpt(view, {}, effort), mean_by_path(view, effort), 4 * 3,
                         fmt::format("depth {}", depth));
    }
}

// Every strategy alone finds all paths of its length, where nothing comes close to anything.
TEST(BdptAgreement, OfEachStrategyAlone) {
    View view;
    view.camera = perspective({0, -6, 1}, {0, 0, 0}, 25);
    RectSurface wall;
    wall.center = Keyed<Vec3d>(Vec3d(0, 1.6, 0.3));
    wall.normal = {0, -1, 0};
    wall.size = {2, 1.2};
    wall.two_sided = true;
    RectSurface floor = wall;
    floor.center = Keyed<Vec3d>(Vec3d(0, 0, -0.8));
    floor.normal = {0, 0, 1};
    view.surfaces = SurfaceSet({wall, floor, lamp({0.5, -0.5, 2.5}, 1.2, {5, 4, 3})}, 0);
    view.background = Vec3f{};
    for (const std::size_t n : {3u, 4u}) {
        const Effort effort{.depth = 5, .batches = 64, .samples = 1024};
        std::vector<Estimate> got;
        for (std::size_t s = 0; s < n; ++s) {
            got.push_back(mean_by_bdpt(view, {}, effort, Strategy{s, n - s}));
            EXPECT_GT(got.back().mean.x, 0) << s;
            if (s > 0) {
                expect_same_mean(got[s], got[1], 3 * 7, fmt::format("{} of {} vertices", s, n));
            }
        }
        expect_same_mean(got[0], got[1], 3 * 7, fmt::format("0 of {} vertices", n));
    }
}

// And in a medium with a light of every kind, as far as points of the volume do not meet.
TEST(BdptAgreement, OfEachStrategyAloneInAMedium) {
    for (int kind = 0; kind < 4; ++kind) {
        View view;
        view.camera = ortho({2, -3, 1}, 2);
        view.media = {cloud_of({1, 2, 4}, 0.3, {}, 7)};
        view.background = Vec3f{};
        if (kind == 0) view.lights = {delta_sun({-1, -1, 1}, {3, 2, 1})};
        if (kind == 1) view.lights = {point({1.2, -0.8, 1.4}, Vec3f(3))};
        if (kind == 2) view.surfaces = SurfaceSet({lamp({1.4, -0.9, 1.6}, 0.6, {6, 5, 4})}, 0);
        if (kind == 3) view.lights = {uneven_sky()};
        const Effort effort{.depth = 1, .batches = 64, .samples = 256};
        expect_same_mean(mean_by_bdpt(view, {}, effort, Strategy{2, 1}),
                         mean_by_bdpt(view, {}, effort, Strategy{1, 2}), 3 * 4,
                         fmt::format("light {}", kind));
    }
}

}  // namespace
}  // namespace gischt
