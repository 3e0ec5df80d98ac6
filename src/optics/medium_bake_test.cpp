// SPDX-License-Identifier: Apache-2.0
#include "optics/medium_bake.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gischt {
namespace {

// A warm coloured ball of cells, its edges empty.
std::shared_ptr<const Medium> warm_ball() {
    constexpr int n = 16;
    Frame frame;
    Field& density = frame.fields["density"];
    density.component.emplace_back(TileMap::box(Vec3i(n)));
    density.to_world = Transform::scale_translate(2.0 / n, Vec3d(-1));
    Field heat = density, dye = density;
    dye.component.resize(3, dye.component[0]);
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3i c(i % n, i / n % n, i / n / n);
        const Vec3d p = density.to_world.point(Vec3d(c) + Vec3d(0.5));
        density.component[0].ref(c) = static_cast<float>(std::max(0.0, 0.8 - length(p)));
        heat.component[0].ref(c) = static_cast<float>(1500 + 500 * p.x);
        for (int a = 0; a < 3; ++a) {
            dye.component[static_cast<std::size_t>(a)].ref(c) = static_cast<float>(0.3 + 0.2 * a);
        }
    }
    frame.fields["temperature"] = heat;
    frame.fields["dye"] = dye;
    MediumParams params;
    params.color_field = "dye";
    params.emission = EmissionKind::Blackbody;
    Job job;
    return std::make_shared<const Medium>(frame, params, 0, job);
}

// One point per cell, at its centre, is what the medium says of that point.
TEST(MediumBake, HoldsWhatTheMediaAre) {
    Job job;
    MediumParams thin;
    thin.extinction = Keyed<Vec3d>(Vec3d(2.0));
    const std::vector<std::shared_ptr<const Medium>> media{
        warm_ball(), std::make_shared<const Medium>(Region::sphere({0.5, 0, 0}, 0.6), thin, 0)};
    const MatterGrid grid =
        bake_matter(media, {Vec3d(-1.1), {1.2, 1.1, 1.1}}, {23, 21, 19}, 1, job);
    ASSERT_EQ(grid.media.size(), 2u);
    EXPECT_TRUE(grid.media[1].color.empty());
    const ExtinctionGrid at{grid.box, grid.cells, {}};
    int dense = 0;
    for (std::size_t i = 0; i < grid.emission.size(); ++i) {
        const auto n = static_cast<int>(i);
        const Vec3d p = at.center(
            {n % grid.cells.x, n / grid.cells.x % grid.cells.y, n / grid.cells.x / grid.cells.y});
        const MediumPoint ball = media[0]->at(p);
        ASSERT_NEAR(grid.media[0].density[i], media[0]->density(p), 1e-5);
        ASSERT_NEAR(grid.media[1].density[i], media[1]->density(p), 1e-5);
        const Vec3f scattering = grid.media[0].density[i] * grid.media[0].color[i] *
                                 media[0]->cross_sections().scattering;
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(scattering[c], ball.scattering[c], 1e-4);
            ASSERT_NEAR(grid.emission[i][c], ball.emission[c], 1e-4f * ball.emission.x + 1e-6f);
        }
        dense += ball.scattering.x > 0;
    }
    EXPECT_GT(dense, 500);
}

// More points per cell approach the mean: the mass of the ball on a coarse grid.
TEST(MediumBake, KeepsTheMass) {
    Job job;
    const std::vector<std::shared_ptr<const Medium>> media{warm_ball()};
    const auto mass = [&](const Vec3i& cells, int points) {
        const MatterGrid grid = bake_matter(media, {Vec3d(-1), Vec3d(1)}, cells, points, job);
        double sum = 0;
        for (const float d : grid.media[0].density) sum += static_cast<double>(d);
        return sum * 8 / static_cast<double>(volume(cells));
    };
    // A cone of height 0.8 on a ball of that radius: pi 0.8^4 / 3.
    EXPECT_NEAR(mass(Vec3i(5), 8), 0.4289, 0.01);
    EXPECT_NEAR(mass(Vec3i(40), 1), 0.4289, 0.01);
}

}  // namespace
}  // namespace gischt
