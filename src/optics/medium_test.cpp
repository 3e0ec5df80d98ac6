// SPDX-License-Identifier: Apache-2.0
#include "optics/medium.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "math/quadrature.h"
#include "optics/medium_bake.h"
#include "optics/medium_depth.h"

namespace gischt {
namespace {

MediumParams grey(double absorption, double scattering) {
    MediumParams p;
    p.absorption = Keyed<Vec3d>(Vec3d(absorption));
    p.scattering = Keyed<Vec3d>(Vec3d(scattering));
    return p;
}

template <class F>
Field field_of(const Vec3i& cells, const Transform& to_world, F&& f) {
    Field field;
    field.component.emplace_back(TileMap::box(cells));
    field.to_world = to_world;
    for (int k = 0; k < cells.z; ++k) {
        for (int j = 0; j < cells.y; ++j) {
            for (int i = 0; i < cells.x; ++i) {
                field.component[0].ref({i, j, k}) =
                    static_cast<float>(f(to_world.point(Vec3d(i + 0.5, j + 0.5, k + 0.5))));
            }
        }
    }
    return field;
}

Frame frame_of(const std::string& name, Field field) {
    Frame frame;
    frame.fields.emplace(name, std::move(field));
    return frame;
}

// A bump of radius 1 around the origin, zero with its slope at the border.
double bump(const Vec3d& p) {
    const double r2 = dot(p, p);
    return r2 < 1 ? (1 - r2) * (1 - r2) : 0;
}
const Transform bump_lattice = Transform::scale_translate(0.05, Vec3d(-1.2));

TEST(Medium, AbsorbsLikeBeerAndLambertOverTheDiscOfASphere) {
    for (const auto& [tau, expected] : {std::pair{1.0, 0.528482}, std::pair{5.0, 0.076766}}) {
        const double radius = 0.7;
        const Medium medium(Region::sphere({1, 2, 3}, radius), grey(tau / (2 * radius), 0), 0);
        // Mean of the transmittance over the disc by rings, the half chord being the variable.
        const double mean = GaussLegendre(32).integrate(0, 1, [&](double c) {
            const Ray ray{{1 + radius * std::sqrt(1 - c * c), 2, -10}, {0, 0, 2}};
            const float t = density_integral(medium, ray, {});
            return 2 * c * std::exp(-static_cast<double>(t * medium.strength()));
        });
        EXPECT_NEAR(mean, expected, 2e-5);
    }
}

TEST(Medium, FillsRotatedBoxesAndEllipsoids) {
    Region box{Region::Kind::Box, {1, 0, 0}, {2, 4, 6}, Transform::rotation({0, 0, 1}, 0.5)};
    const Medium medium(box, grey(1, 0), 0);
    const Vec3d axis = box.rotation.vector({1, 0, 0});
    EXPECT_NEAR(density_integral(medium, {box.center - 10.0 * axis, axis}, {}), 2, 1e-6);
    EXPECT_NEAR(density_integral(medium, {box.center, axis}, {}), 1, 1e-6);  // from inside
    EXPECT_EQ(medium.density(box.center + 0.99 * axis), 1);
    EXPECT_EQ(medium.density(box.center + 1.01 * axis), 0);

    box.kind = Region::Kind::Ellipsoid;
    const Medium ellipsoid(box, grey(1, 0), 0);
    EXPECT_NEAR(density_integral(ellipsoid, {{1, 0, -10}, {0, 0, 1}}, {}), 6, 1e-5);
    EXPECT_EQ(density_integral(ellipsoid, {{1, 0, -10}, {0, 0, -1}}, {}), 0);
    EXPECT_THROW(Medium(Region::sphere({}, 0), grey(1, 0), 0), Error);
}

TEST(Medium, SumsOpticalDepthToSecondOrder) {
    Job job;
    const Medium medium(frame_of("density", field_of({48, 48, 48}, bump_lattice, bump)), grey(1, 0),
                        0, job);
    double coarse = 0, fine = 0;
    for (int i = 0; i < 200; ++i) {
        const Ray ray{{-2, 0.004 * i - 0.4, -0.05}, normalize(Vec3d(1, 0.03, 0.2))};
        const auto integral = [&](double step) {
            return static_cast<double>(density_integral(medium, ray, {step, 1e9f}));
        };
        const double exact = integral(0.1);
        coarse += std::pow(integral(4) - exact, 2) / 200;
        fine += std::pow(integral(1) - exact, 2) / 200;
        // The analytic integral of the bump, which the lattice knows to second order of its cell.
        const double analytic =
            GaussLegendre(64).integrate(0, 4, [&](double t) { return bump(ray.at(t)); });
        EXPECT_NEAR(exact, analytic, 5e-3 * analytic + 1e-4);
    }
    EXPECT_LT(std::sqrt(fine), std::sqrt(coarse) / 8);  // 16 for order two
    EXPECT_LT(std::sqrt(fine), 3e-4);
}

TEST(Medium, GivesTheSameDensitiesOnLinesAndAtPoints) {
    Job job;
    const Medium medium(frame_of("density", field_of({48, 48, 48}, bump_lattice, bump)), grey(1, 0),
                        0, job);
    const Ray ray{{-1.5, -0.7, 0.3}, {1, 0.4, -0.1}};
    std::vector<float> line(100);
    densities_on_line(medium, ray, 0.02, 0.03, line);
    for (std::size_t i = 0; i < line.size(); ++i) {
        EXPECT_NEAR(line[i], medium.density(ray.at(0.02 + 0.03 * static_cast<double>(i))), 1e-5);
    }
}

TEST(Medium, SegmentsBoundTheExtinction) {
    Job job;
    MediumParams params = grey(2, 3);
    params.density_scale = Keyed<double>(4.0);
    const Medium medium(frame_of("density", field_of({48, 48, 48}, bump_lattice, bump)), params, 0,
                        job);
    EXPECT_EQ(medium.strength(), 5);
    EXPECT_NEAR(medium.majorant(), 20, 0.1);
    for (const BrickGrain grain : {BrickGrain::Blocks, BrickGrain::Bricks}) {
        const Ray ray{{-1.5, -0.2, 0.1}, {1, 0.1, 0}};
        SegmentWalk walk = medium.segments(ray, grain);
        MediumSegment s;
        int count = 0;
        while (walk.next(s)) {
            ++count;
            for (const double w : {0.0, 0.3, 0.6, 1.0}) {
                const float e = 5 * medium.density(ray.at(s.t0 + w * (s.t1 - s.t0)));
                EXPECT_GE(e, s.min - 1e-4f);
                EXPECT_LE(e, s.max + 1e-4f);
            }
        }
        EXPECT_GT(count, 3);
    }
}

TEST(Medium, GlowsAsABlackBody) {
    MediumParams params = grey(2, 1);
    params.emission = EmissionKind::Blackbody;
    const Medium medium(Region::sphere({}, 1), params, 0, 2500);
    const Vec3f expected = 2.0f * blackbody_radiance(2500);
    EXPECT_NEAR(medium.at({}).emission.x / expected.x, 1, 1e-3);
    EXPECT_EQ(medium.at({2, 0, 0}).emission.x, 0);

    // The temperature may lie on another lattice than the density.
    Job job;
    Frame frame = frame_of("density", field_of({48, 48, 48}, bump_lattice, bump));
    frame.fields.emplace("temperature",
                         field_of({30, 40, 50}, Transform::scale_translate(0.08, {-1.2, -1.5, -2}),
                                  [](const Vec3d& p) { return 2000 + 500 * p.x; }));
    const Medium cloud(frame, params, 0, job);
    const Vec3d point(0.3, -0.2, 0.1);
    const Vec3f glow = blackbody_radiance(2150) * Vec3f(2 * cloud.density(point));
    EXPECT_NEAR(cloud.at(point).emission.x / glow.x, 1, 2e-3);
    // Look-ups along a segment agree with those at points.
    const Ray ray{point, {1, 0, 0}};
    SegmentWalk walk = cloud.segments(ray);
    MediumSegment s;
    ASSERT_TRUE(walk.next(s));
    const float t = 0;
    float density;
    Vec3f emission;
    cloud.densities(s, {&t, 1}, &density);
    cloud.emissions(s, {&t, 1}, &density, &emission);
    EXPECT_NEAR(emission.x / cloud.at(ray.at(s.t0)).emission.x, 1, 1e-3);
}

TEST(Medium, ShowsFlamesWhereThereIsNoDensity) {
    Job job;
    Frame frame = frame_of("density", field_of({48, 48, 48}, bump_lattice, [](const Vec3d& p) {
                               return bump(p - Vec3d(0, 0, 2));
                           }));
    frame.fields.emplace("flame", field_of({48, 48, 48}, bump_lattice, bump));
    MediumParams params = grey(1, 1);
    params.emission = EmissionKind::Flame;
    const Medium medium(frame, params, 0, job);
    const Ray ray{{-2, 0, -0.3}, {1, 0, 0}};
    SegmentWalk walk = medium.segments(ray);
    MediumSegment s;
    double covered = 0;
    while (walk.next(s)) covered += s.t1 - s.t0;
    EXPECT_GT(covered, 1.8);
    EXPECT_GT(medium.at({}).emission.x, 0);
    EXPECT_EQ(medium.at({0, 0, 1.15}).emission.x, 0);
}

// Trackers look up one place at a time, on bounds that must hold.
TEST(Medium, LooksUpSinglePlacesLikeMany) {
    Job job;
    Frame frame = frame_of("density", field_of({48, 48, 48}, bump_lattice, [](const Vec3d& p) {
                               return bump(p - Vec3d(0, 0, 0.5));
                           }));
    frame.fields.emplace("flame", field_of({48, 48, 48}, bump_lattice, bump));
    frame.fields.emplace("temperature", field_of({48, 48, 48}, bump_lattice,
                                                 [](const Vec3d& p) { return 1500 + 800 * p.y; }));
    for (const EmissionKind kind : {EmissionKind::Flame, EmissionKind::Blackbody}) {
        MediumParams params = grey(1, 1);
        params.emission = kind;
        const Medium medium(frame, params, 0, job);
        for (const BrickGrain grain : {BrickGrain::Blocks, BrickGrain::Bricks}) {
            const Ray ray{{-2, 0.11, -0.9}, normalize(Vec3d(1, 0.05, 0.4))};
            SegmentWalk walk = medium.segments(ray, grain);
            bool glows_without_density = false;
            for (MediumSegment s; walk.next(s);) {
                std::array<float, 7> t, density;
                std::array<Vec3f, 7> emission;
                for (std::size_t i = 0; i < 7; ++i) {
                    t[i] = static_cast<float>((s.t1 - s.t0) * double(i) / 6);
                }
                medium.densities(s, t, density.data());
                medium.emissions(s, t, density.data(), emission.data());
                for (std::size_t i = 0; i < 7; ++i) {
                    EXPECT_NEAR(medium.density_at(s, t[i]), density[i], 1e-6);
                    const Vec3f one = medium.emission_at(s, t[i], density[i]);
                    EXPECT_EQ(one, emission[i]);
                    EXPECT_LE(max_component(one), s.emission_max);
                }
                EXPECT_LE(s.emission_max, medium.emission_majorant());
                glows_without_density |= s.max == 0 && s.emission_max > 0;
            }
            EXPECT_EQ(glows_without_density, kind == EmissionKind::Flame);
        }
    }
}

// Colours dye what is scattered; what they take is absorbed.
TEST(Medium, TakesItsColorFromPlaceToPlace) {
    Job job;
    std::string warning;
    job.on_message = [&](Job::Level, std::string_view text) { warning = text; };
    Frame frame = frame_of("density", field_of({48, 48, 48}, bump_lattice, bump));
    const Transform coarse = Transform::scale_translate(0.1, Vec3d(-1.5));
    const auto red = [](const Vec3d& p) { return 0.5 + 0.3 * p.x; };
    frame.fields.emplace("color_r", field_of({30, 30, 30}, coarse, red));
    frame.fields.emplace("color_g", field_of({30, 30, 30}, coarse, [](const Vec3d&) { return 0; }));
    frame.fields.emplace("color_b", field_of({30, 30, 30}, coarse, [](const Vec3d&) { return 2; }));
    MediumParams params = grey(1, 4);
    EXPECT_FALSE(Medium(frame, params, 0, job).has_color());
    params.color_field = "color";
    const Medium medium(frame, params, 0, job);
    ASSERT_TRUE(medium.has_color());
    EXPECT_NE(warning.find("colours above 1 count as 1"), std::string::npos);
    const Vec3d point(0.3, -0.2, 0.1);
    const MediumPoint at = medium.at(point);
    const float d = medium.density(point);
    EXPECT_NEAR(at.scattering.x, 4 * d * red(point), 2e-3);
    EXPECT_EQ(at.scattering.y, 0);
    EXPECT_NEAR(at.scattering.z, 4 * d, 1e-4);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(at.extinction()[c], 5 * d, 1e-5);
    const Ray ray{{-2, -0.2, 0.1}, {1, 0, 0}};
    SegmentWalk walk = medium.segments(ray);
    for (MediumSegment s; walk.next(s);) {
        const auto t = static_cast<float>(0.5 * (s.t1 - s.t0));
        const float density = medium.density_at(s, t);
        if (density == 0) continue;
        const Vec3f color = medium.color_at(s, t, density);
        // Where there is next to nothing its 16 bits show.
        const double coarse_bits = density > 1e-3f ? 0 : 0.5;
        EXPECT_NEAR(color.x, red(ray.at(0.5 * (s.t0 + s.t1))), 6e-3 + coarse_bits);
        EXPECT_NEAR(color.z, 1, 1e-3 + coarse_bits);
    }
    // A vector field does the same; a scalar, or nothing, will not.
    Field vector = field_of({30, 30, 30}, coarse, red);
    vector.component.resize(3, vector.component[0]);
    frame.fields.emplace("dye", vector);
    params.color_field = "dye";
    EXPECT_NEAR(Medium(frame, params, 0, job).at(point).scattering.y, 4 * d * red(point), 2e-3);
    for (const char* name : {"color_r", "paint"}) {
        params.color_field = name;
        EXPECT_THROW(Medium(frame, params, 0, job), Error);
    }
}

TEST(Medium, FillsAllOfSpace) {
    const Medium fog(Region::everywhere(), grey(0.5, 1.5), 0);
    EXPECT_FALSE(fog.is_bounded());
    const Ray ray{{1e4, 0, 0}, {0, 2, 0}, 3};
    SegmentWalk walk = fog.segments(ray);
    MediumSegment s;
    ASSERT_TRUE(walk.next(s));
    EXPECT_EQ(s.t0, 3);
    EXPECT_TRUE(std::isinf(s.t1));
    EXPECT_EQ(s.max, 2);
    EXPECT_EQ(fog.density_at(s, 1e9f), 1);
    EXPECT_FALSE(walk.next(s));
    EXPECT_FLOAT_EQ(*fog.optical_depth(ray, 4, 7), 12);
    MediumParams glowing = grey(1, 0);
    glowing.emission = EmissionKind::Blackbody;
    EXPECT_THROW(Medium(Region::everywhere(), glowing, 0, 2000), Error);
}

TEST(Medium, SaysWhatIsWrongWithAFrame) {
    Job job;
    std::string warning;
    job.on_message = [&](Job::Level, std::string_view text) { warning = text; };
    try {
        Medium(frame_of("heat", field_of({8, 8, 8}, {}, bump)), grey(1, 0), 0, job);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_NE(e.hint().find("heat"), std::string::npos);
    }
    Field vector = field_of({8, 8, 8}, {}, bump);
    vector.component.resize(3, vector.component[0]);
    EXPECT_THROW(Medium(frame_of("density", vector), grey(1, 0), 0, job), Error);

    Field bad = field_of({8, 8, 8}, {}, [](const Vec3d&) { return 1; });
    bad.component[0].ref({4, 4, 4}) = std::nanf("");
    const Medium medium(frame_of("density", bad), grey(1, 0), 0, job);
    EXPECT_EQ(medium.density({4.5, 4.5, 4.5}), 0);
    EXPECT_NE(warning.find("1 values that are not finite"), std::string::npos);
}

// What rounding to float would turn into infinity on the way.
TEST(Medium, RefusesExtinctionsBeyondAllReckoning) {
    Job job;
    const Field dense = field_of({8, 8, 8}, {}, [](const Vec3d&) { return 1e30; });
    const Region ball = Region::sphere({}, 1);
    EXPECT_NO_THROW(Medium(frame_of("density", dense), grey(0.5, 0), 0, job));
    EXPECT_NO_THROW(Medium(ball, grey(1e29, 0), 0));
    for (const bool is_field : {false, true}) {
        try {
            if (is_field) {
                Medium(frame_of("density", dense), grey(20, 0), 0, job);
            } else {
                Medium(ball, grey(1e32, 0), 0);
            }
            FAIL();
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            EXPECT_NE(std::string(e.what()).find(is_field ? "'density'" : "'region'"),
                      std::string::npos)
                << e.what();
        }
    }
}

// Beside a voxel of 1e12 the rounding of the others may be of either sign.
TEST(Medium, IsNeverLessThanNothing) {
    Job job;
    Field field = field_of({8, 8, 8}, {}, [](const Vec3d&) { return 0.001; });
    field.component[0].ref({4, 4, 4}) = 1e12f;
    const Medium medium(frame_of("density", field), grey(1, 0), 0, job);
    for (int i = 0; i < 200; ++i) {
        const Ray ray{{0.02 * i + 2.5, 4.5, -5}, normalize(Vec3d(0.001 * i, 0.01, 1))};
        SegmentWalk walk = medium.segments(ray);
        MediumSegment s;
        while (walk.next(s)) {
            std::array<float, 50> t, density;
            for (std::size_t k = 0; k < t.size(); ++k) {
                t[k] = static_cast<float>(s.t0 - s.anchor +
                                          (s.t1 - s.t0) * double(k) / double(t.size() - 1));
                EXPECT_GE(medium.density_at(s, t[k]), 0);
            }
            medium.densities(s, t, density.data());
            EXPECT_GE(*std::min_element(density.begin(), density.end()), 0);
        }
    }
}

TEST(Medium, IsNothingWhereItIsEmpty) {
    Job job;
    const Medium medium(
        frame_of("density", field_of({16, 16, 16}, {}, [](const Vec3d&) { return 0; })), grey(1, 0),
        0, job);
    EXPECT_TRUE(medium.bounds().is_empty());
    EXPECT_EQ(medium.majorant(), 0);
    MediumSegment s;
    EXPECT_FALSE(medium.segments({{8, 8, -5}, {0, 0, 1}}).next(s));
    EXPECT_EQ(density_integral(medium, {{8, 8, -5}, {0, 0, 1}}, {}), 0);
}

TEST(Medium, BakesTheMeanOfEveryCell) {
    Job job;
    const auto medium =
        std::make_shared<const Medium>(Region::box({{0, 0, 0}, {1, 1, 1}}), grey(3, 0), 0);
    const std::vector<std::shared_ptr<const Medium>> media{medium, medium};
    const ExtinctionGrid grid = bake(media, {{-0.5, 0, 0}, {1.5, 1, 1}}, {4, 2, 2}, 4, job);
    EXPECT_NEAR(grid.extinction[grid.index({0, 0, 0})], 0, 1e-6);
    EXPECT_NEAR(grid.extinction[grid.index({1, 1, 0})], 6, 1e-5);
    const ExtinctionGrid shifted = bake(media, {{-0.25, 0, 0}, {1.75, 1, 1}}, {4, 1, 1}, 4, job);
    EXPECT_NEAR(shifted.extinction[0], 3, 1e-5);
}

}  // namespace
}  // namespace gischt
