// SPDX-License-Identifier: Apache-2.0
#include "fluid/procedural/procedural.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "math/keyframe_integral.h"

namespace gischt {
namespace {

constexpr Vec3d up(0, 0, 1);

Frame make(const ProceduralParams& params, double time = 0) {
    Job job;
    return make_procedural(params, up, time, job);
}

// Integral of a field over the box, with the volume of a cell.
double total(const Frame& frame, const char* name = "density") {
    const Field& field = *frame.find(name);
    double sum = 0;
    for (const float v : field.component[0].values()) sum += static_cast<double>(v);
    return sum * std::pow(field.cell_size(), 3);
}

ProceduralParams ball() {
    ProceduralParams p;
    p.resolution = 64;
    p.min = Vec3d(-1);
    p.max = Vec3d(1);
    p.shape = ProceduralShape::Ball;
    p.radius = 0.8;
    p.edge = 0.1;
    return p;
}

// The depth at which density rises to a random level is edge X, X of density 6 x (1 - x): mean 1/2,
// variance 1/20, no third moment. So the integral of density is the mean volume of the shape shrunk
// by edge X.
TEST(Procedural, ABallHasTheVolumeOfABall) {
    const double expected = 4.0 / 3 * pi * (std::pow(0.75, 3) + 3 * 0.75 * 0.01 / 20);
    EXPECT_NEAR(total(make(ball())) / expected, 1, 0.002);
    ProceduralParams blob = ball();
    blob.shape = ProceduralShape::Blobs;
    BlobParams b;
    b.radius = 0.8;
    blob.blobs = {b};
    for (const BlobKernel k :
         {BlobKernel::Wyvill, BlobKernel::Blinn, BlobKernel::Metaball, BlobKernel::Murakami}) {
        blob.kernel = k;
        EXPECT_NEAR(total(make(blob)) / expected, 1, 0.002);
    }
}

TEST(Procedural, BoxSlabAndWholeBoxHaveTheirVolumes) {
    ProceduralParams p = ball();
    p.edge = 0.125;  // four cells
    const auto expected = [](const Vec3d& size) {
        const Vec3d mean = size - Vec3d(0.125);
        return mean.x * mean.y * mean.z + 0.125 * 0.125 / 5 * (mean.x + mean.y + mean.z);
    };
    p.shape = ProceduralShape::Box;
    p.size = Vec3d(1.0, 0.8, 1.2);
    EXPECT_NEAR(total(make(p)) / expected({1.0, 0.8, 1.2}), 1, 0.003);
    p.shape = ProceduralShape::Slab;
    p.position = Vec3d(0, 0, -0.5);
    p.thickness = 0.75;
    EXPECT_NEAR(total(make(p)) / expected({2, 2, 0.75}), 1, 0.003);
    p.shape = ProceduralShape::All;
    EXPECT_NEAR(total(make(p)) / expected({2, 2, 2}), 1, 0.003);
}

TEST(Procedural, FallsOffWithHeightByItsScale) {
    ProceduralParams p = ball();
    p.shape = ProceduralShape::All;
    p.position = Vec3d(0, 0, -1);
    p.falloff = 0.5;
    const Field density = *make(p).find("density");
    const double ratio = static_cast<double>(density.sample({0, 0, 0.5})) /
                         static_cast<double>(density.sample({0, 0, -0.5}));
    EXPECT_NEAR(ratio, std::exp(-2), 0.001);
}

// Half of space is above the mean of the noise: a threshold of 0 with a narrow rise fills half.
TEST(Procedural, AThresholdOfZeroFillsHalf) {
    ProceduralParams p = ball();
    p.shape = ProceduralShape::All;
    p.edge = 0.02;
    p.threshold = -0.01;
    p.softness = 0.02;
    p.noise.scale = 0.1;
    p.noise.octaves = 2;
    // 8000 features of which some eight make one independent: 5 x 0.5 / sqrt(1000).
    EXPECT_NEAR(total(make(p)) / std::pow(1.98, 3), 0.5, 0.08);
}

// The wind carries the noise: what was here is there, and the velocity says so.
TEST(Procedural, TheWindCarriesThePattern) {
    ProceduralParams p = ball();
    p.shape = ProceduralShape::All;
    p.threshold = 0;
    p.velocity = Keyed<Vec3d>({0, 2}, {Vec3d(0), Vec3d(0.5, 0, 0)});
    const Frame first = make(p, 0), later = make(p, 2);
    for (double x = -0.8; x < 0.2; x += 0.0625) {
        const Vec3d here(x + 1.0 / 64, 0.1, 0.2);
        ASSERT_NEAR(first.find("density")->sample(here),
                    later.find("density")->sample(here + Vec3d(0.5, 0, 0)), 1e-4f);
    }
    p.threshold.reset();
    EXPECT_NEAR(make(p, 2).find("velocity")->sample({0.1, 0, 0}, 0), 0.5f, 1e-6f);
    p.velocity = Vec3d(0);
    EXPECT_EQ(make(p).find("velocity"), nullptr);
}

TEST(Procedural, NothingIsBelowTheBase) {
    ProceduralParams p = ball();
    p.base = 0;
    const double half = 2.0 / 3 * pi * std::pow(0.75, 3), disc = pi * 0.75 * 0.75;
    EXPECT_NEAR(total(make(p)) / (half - 0.05 * disc), 1, 0.01);
    EXPECT_EQ(make(p).find("density")->sample({0, 0, -0.1}), 0);
}

TEST(Procedural, HeatIsInTheCore) {
    ProceduralParams p = ball();
    p.temperature = 1500;
    p.flame = 0.7;
    p.core = 0.3;
    const Frame frame = make(p);
    const Field &t = *frame.find("temperature"), &flame = *frame.find("flame");
    EXPECT_NEAR(t.sample({0, 0, 0}), 1500, 0.01f);
    EXPECT_NEAR(flame.sample({0, 0, 0}), 0.7f, 1e-6f);
    // At half of the core's depth smoothstep is one half.
    EXPECT_NEAR(t.sample({0.65, 0, 0}), 0.5f * (1500 + 293.15f), 15);
    EXPECT_NEAR(t.background[0], 293.15f, 1e-3f);
}

TEST(Procedural, IsTheSameOnAnyNumberOfThreadsAndAnotherWithAnotherSeed) {
    const auto density = [](int threads, int seed) {
        const ThreadLimit limit(threads);
        ProceduralParams p = ball();
        p.displacement = 0.1;
        p.noise.warp = 0.1;
        p.noise.evolution = 1;
        p.noise.seed = seed;
        return make(p, 0.3).find("density")->component[0].values();
    };
    EXPECT_EQ(density(1, 1), density(2, 1));
    EXPECT_NE(density(1, 1), density(1, 2));
}

// Sparse: tiles without fluid are not there, and no fluid is lost with them.
TEST(Procedural, KeepsTheTilesThatHoldSomething) {
    ProceduralParams p = ball();
    p.radius = 0.2;
    p.displacement = 0.02;
    const Frame frame = make(p);
    const TileField<float>& density = frame.find("density")->component[0];
    EXPECT_LE(density.map().size(), 4 * 4 * 4);
    for (int t = 0; t < density.map().size(); ++t) {
        float most = 0;
        for (int i = 0; i < tile_values; ++i) most = std::max(most, density.tile(t)[i]);
        ASSERT_GT(most, 0);
    }
    EXPECT_GT(total(frame), 0.01);
}

TEST(Procedural, NothingAnywhereIsAFrameWithoutTiles) {
    ProceduralParams p = ball();
    p.position = Vec3d(100, 0, 0);
    EXPECT_EQ(make(p).find("density")->map().size(), 0);
}

// The mesh of a ball lies within its facets' height of it, and so does the depth.
TEST(Procedural, AMeshOfABallIsTheBall) {
    ProceduralParams p = ball();
    p.position = Vec3d(0.1, 0, 0);
    p.displacement = 0.03;
    const Frame expected = make(p);
    p.shape = ProceduralShape::Mesh;
    p.mesh.file = "ball.ply";
    p.mesh.scale = 0.4;
    p.mesh.rotate_degrees = Vec3d(20, 30, 40);
    const MeshDistance mesh = filled_mesh(p.mesh, ball_mesh(2, 5));
    Job job;
    const Frame frame = make_procedural(p, up, 0, job, &mesh);
    // Facets of level 5 leave 0.3 mm; the density rises by 15 per metre at most.
    const Field &a = *expected.find("density"), &b = *frame.find("density");
    double most = 0;
    for (const double x : {-0.72, -0.3, 0.4, 0.85}) {
        for (double y = -0.9; y < 0.9; y += 0.03) {
            for (double z = -0.9; z < 0.9; z += 0.03) {
                most = std::max(most, std::abs(double(a.sample({x, y, z}) - b.sample({x, y, z}))));
            }
        }
    }
    EXPECT_LT(most, 15 * 0.0003);
    EXPECT_NEAR(total(frame) / total(expected), 1, 0.002);
}

TEST(Procedural, AMeshMustBeClosedAndThere) {
    ProceduralParams p = ball();
    p.shape = ProceduralShape::Mesh;
    p.mesh.file = "bowl.ply";
    EXPECT_THROW(make(p), Error);
    Mesh open = ball_mesh(1, 2);
    open.triangles.pop_back();
    try {
        filled_mesh(p.mesh, open);
        FAIL() << "an open mesh was taken";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_EQ(e.where(), "bowl.ply");
        EXPECT_NE(e.fact().find("not closed"), std::string::npos);
    }
}

// The level set is the distance to the ball within three cells, with the sign kept everywhere.
TEST(Procedural, TheSurfaceIsADistance) {
    ProceduralParams p = ball();
    p.radius = 0.6;
    p.surface = true;
    const Frame frame = make(p);
    const Field& surface = *frame.find("surface");
    EXPECT_EQ(surface.kind, FieldClass::LevelSet);
    const double h = 2.0 / 64, band = 3 * h;
    for (double x = -0.95; x < 1; x += 0.0137) {
        const Vec3d at(x, 0.1, -0.2);
        const double expected = std::clamp(length(at) - 0.6, -band, band);
        // Trilinear interpolation of a distance: a quarter of 3 h^2 / (2 r), and the band's kink.
        const bool is_at_kink = std::abs(std::abs(length(at) - 0.6) - band) < 2 * h;
        ASSERT_NEAR(surface.sample(at), expected, is_at_kink ? 0.5 * h : 0.002) << x;
    }
    // Asking for it changes nothing else.
    p.surface = false;
    EXPECT_NEAR(total(frame), total(make(p)), 1e-9);
}

// Noise moves the level set as it moves the density, which rises from there on.
TEST(Procedural, TheSurfaceIsWhereDensityBegins) {
    ProceduralParams p = ball();
    p.radius = 0.6;
    p.displacement = 0.05;
    p.noise.octaves = 3;
    p.surface = true;
    const Frame frame = make(p);
    const auto &surface = frame.find("surface")->component[0].values(),
               &density = frame.find("density")->component[0].values();
    int inside = 0;
    for (std::size_t i = 0; i < surface.size(); ++i) {
        ASSERT_EQ(surface[i]<0, density[i]> 0);
        inside += surface[i] < 0;
    }
    EXPECT_GT(inside, 1000);
}

// A number over time is what it is at that time.
TEST(Procedural, KeyframesAreTheirValuesAtTheTime) {
    ProceduralParams moving = ball(), still = ball();
    moving.radius = Keyed<double>({0, 2}, {0.4, 0.8});
    still.radius = 0.6;
    moving.displacement = Keyed<double>({0, 2}, {0, 0.1});
    still.displacement = 0.05;
    moving.threshold = Keyed<double>({0, 2}, {-3, 1});
    still.threshold = -1;
    moving.density = Keyed<double>({0, 1}, {0, 2});
    still.density = 2;
    moving.edge = Keyed<double>({0, 2}, {0.1, 0.3});
    still.edge = 0.2;
    moving.noise.warp = Keyed<double>({0, 2}, {0, 0.2});
    still.noise.warp = 0.1;
    EXPECT_EQ(make(moving, 1).find("density")->component[0].values(),
              make(still).find("density")->component[0].values());
    EXPECT_EQ(make(moving, 0).find("density")->map().size(), 0);
    EXPECT_NE(make(moving, 0.8).find("density")->component[0].values(),
              make(moving, 1).find("density")->component[0].values());
}

TEST(Procedural, RefusesWhatHasNoMeaningAndStopsWhenAsked) {
    ProceduralParams p = ball();
    p.max.x = p.min.x;
    EXPECT_THROW(make(p), Error);
    p = ball();
    p.edge = 0.0;
    EXPECT_THROW(make(p), Error);
    Job job;
    job.cancel();
    EXPECT_THROW(make_procedural(ball(), up, 0, job), Error);
}

// Against the sum of many small steps, for each interpolation and either direction of time.
TEST(KeyframeIntegral, IsTheSumOfManySmallSteps) {
    for (const auto kind :
         {KeyInterpolation::Step, KeyInterpolation::Linear, KeyInterpolation::Smooth}) {
        const Keyed<double> value({-1, 0.5, 2}, {1, -3, 4}, kind);
        for (const double time : {-2.0, 0.3, 1.7, 5.0}) {
            constexpr int steps = 200000;
            double sum = 0;
            for (int i = 0; i < steps; ++i) sum += value.at((i + 0.5) / steps * time);
            EXPECT_NEAR(integral(value, time), sum * time / steps, 2e-4);
        }
    }
    EXPECT_DOUBLE_EQ(integral(Keyed<double>(3), 2), 6);
}

}  // namespace
}  // namespace gischt
