// SPDX-License-Identifier: Apache-2.0
#include "grid/brick_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "grid/brick_walk.h"

namespace gischt {
namespace {

// Deterministic stream of random numbers for a test.
struct Random {
    std::uint64_t key;
    std::uint32_t n = 0;
    double operator()() { return static_cast<double>(random_uniform(key, n++)); }
    double between(double lo, double hi) { return lo + (hi - lo) * (*this)(); }
    Vec3d vec(double lo, double hi) {
        const double x = between(lo, hi), y = between(lo, hi);
        return {x, y, between(lo, hi)};
    }
    Vec3d direction() { return normalize(vec(-1, 1)); }
};

Transform tilted(double cell) {
    return Transform::scale_translate(1, {3, -2, 5}) *
           Transform::rotation(normalize(Vec3d(1, 2, 3)), 0.7) *
           Transform::scale_translate(cell, {});
}

// About a third of the tiles of a box at negative and positive coordinates, with smooth blobs and
// some isolated voxels.
Field random_field(std::uint64_t seed, const Transform& to_world) {
    Random random{random_key(seed)};
    std::vector<Vec3i> tiles;
    for (int i = 0; i < 27; ++i) {
        if (random() < 0.35) tiles.emplace_back(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    }
    tiles.emplace_back(1, 1, 1);
    Field f;
    f.component.emplace_back(TileMap::sparse(tiles, {{-7, -8, -8}, {15, 16, 13}}));
    f.to_world = to_world;
    TileField<float>& v = f.component[0];
    for (int t = 0; t < f.map().size(); ++t) {
        const Box3i cells = f.map().cells_of(t);
        for (int z = cells.lo.z; z < cells.hi.z; ++z) {
            for (int y = cells.lo.y; y < cells.hi.y; ++y) {
                for (int x = cells.lo.x; x < cells.hi.x; ++x) {
                    const double wave = std::sin(0.5 * x) + std::cos(0.4 * y + z);
                    v.ref({x, y, z}) =
                        static_cast<float>(random() < 0.02 ? 5 * random() : std::max(0.0, wave));
                }
            }
        }
    }
    return f;
}

BrickVolume pack(const Field& field,
                 BrickOptions::Storage storage = BrickOptions::Storage::Compact) {
    Job job;
    return BrickVolume(field, {.storage = storage}, job);
}

TEST(BrickVolume, AgreesWithFieldSampleOnRandomSparseFields) {
    for (const auto storage : {BrickOptions::Storage::Compact, BrickOptions::Storage::Full}) {
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            const Field field = random_field(seed, tilted(0.25));
            const BrickVolume volume = pack(field, storage);
            // Half a step of the largest range, plus the rounding of positions.
            const double bound =
                storage == BrickOptions::Storage::Full ? 2e-5 : 5.0 / 131070 + 2e-5;
            Random random{random_key(seed, 1)};
            for (int i = 0; i < 20000; ++i) {
                const Vec3d p = field.to_world.point(random.vec(-12, 20));
                ASSERT_NEAR(volume.sample(p), field.sample(p), bound) << seed << " " << i;
            }
        }
    }
}

TEST(BrickVolume, ReproducesSamplesAtCellCentres) {
    const Field field = random_field(9, Transform::scale_translate(2, {1, 1, 1}));
    const BrickVolume volume = pack(field, BrickOptions::Storage::Full);
    for (int z = -8; z < 13; ++z) {
        for (int y = -8; y < 16; ++y) {
            for (int x = -7; x < 15; ++x) {
                ASSERT_EQ(volume.at({double(x), double(y), double(z)}),
                          field.component[0].get({x, y, z}));
            }
        }
    }
}

TEST(BrickVolume, BlocksBoundTheInterpolantAndHoldItsMean) {
    for (const auto storage : {BrickOptions::Storage::Compact, BrickOptions::Storage::Full}) {
        const BrickVolume volume = pack(random_field(2, tilted(1)), storage);
        for (int b = 0; b < volume.size(); ++b) {
            for (int i = 0; i < BrickVolume::brick_blocks; ++i) {
                const BrickVolume::Block block = volume.block(b, i);
                const Vec3f first(4 * Vec3f(float(i & 1), float(i >> 1 & 1), float(i >> 2)));
                double sum = 0;
                constexpr int n = 16;  // four midpoints per cell and axis are exact for trilinear
                for (int k = 0; k < n * n * n; ++k) {
                    const Vec3f p =
                        first + Vec3f((float(k % n) + 0.5f) / 4, (float(k / n % n) + 0.5f) / 4,
                                      (float(k / n / n) + 0.5f) / 4);
                    const float v = volume.at_local(b, p);
                    ASSERT_GE(v, block.min);
                    ASSERT_LE(v, block.max);
                    sum += static_cast<double>(v);
                }
                ASSERT_NEAR(sum / (n * n * n), block.mean, 1e-5);
                // Corners are where the bounds are attained.
                for (int k = 0; k < 125; ++k) {
                    const float v = volume.at_local(
                        b, first + Vec3f(float(k % 5), float(k / 5 % 5), float(k / 25)));
                    ASSERT_GE(v, block.min);
                    ASSERT_LE(v, block.max);
                }
            }
        }
    }
}

TEST(BrickVolume, StoresTheBricksOfAnother) {
    Job job;
    Field shape, color;
    shape.component.emplace_back(TileMap::box(Vec3i(40)));
    color.component.emplace_back(TileMap::box(Vec3i(64)));
    shape.component[0].ref({3, 4, 5}) = 1;
    shape.component[0].ref({30, 20, 38}) = 1;
    color.component[0].ref({60, 60, 60}) = 7;  // where the other has nothing
    color.component[0].ref({31, 20, 38}) = 2;
    const BrickVolume one(shape, {}, job), two(color, {.like = &one}, job);
    ASSERT_EQ(two.size(), one.size());
    for (int b = 0; b < one.size(); ++b) {
        EXPECT_EQ(two.coord(b), one.coord(b));
        EXPECT_EQ(two.find(two.coord(b)), b);
        EXPECT_EQ(two.occupied(b) & one.occupied(b), one.occupied(b));
    }
    EXPECT_EQ(two.at({31, 20, 38}), 2);
    EXPECT_EQ(two.at({60, 60, 60}), 0);
}

TEST(BrickVolume, KeepsOnlyBricksThatDifferFromTheBackground) {
    Field f;
    f.component.emplace_back(TileMap::box({64, 64, 64}));
    f.component[0].ref({20, 20, 20}) = 1;
    const BrickVolume inside = pack(f);
    EXPECT_EQ(inside.size(), 1);
    EXPECT_EQ(inside.support(), (Box3i{{16, 16, 16}, {24, 24, 24}}));
    // A sample on a brick's lower face reaches into the brick before.
    f.component[0].ref({20, 20, 20}) = 0;
    f.component[0].ref({16, 20, 20}) = 1;
    EXPECT_EQ(pack(f).size(), 2);
    EXPECT_EQ(pack(Field{{TileField<float>(TileMap::box({8, 8, 8}))}, {}, {}, {}}).size(), 0);
}

TEST(BrickVolume, TakesTheBackgroundOutside) {
    Field f;
    f.component.emplace_back(TileMap::box({16, 16, 16}), 300.0f);
    f.component[0].ref({8, 8, 8}) = 1000;
    f.background[0] = 300;
    const BrickVolume volume = pack(f);
    EXPECT_EQ(volume.at({-50, 2, 3}), 300);
    EXPECT_EQ(volume.at({1e300, 0, 0}), 300);
    EXPECT_EQ(volume.at({15.5, 2, 3}), 300);
    EXPECT_NEAR(volume.at({8, 8, 8}), 1000, 0.01);
    EXPECT_NEAR(volume.min(), 300, 1e-2);
}

TEST(BrickVolume, SurvivesNonFiniteAndNegativeSamples) {
    Field f;
    f.component.emplace_back(TileMap::box({24, 24, 24}), 1.0f);
    f.component[0].ref({16, 16, 16}) = std::nanf("");
    f.component[0].ref({3, 4, 5}) = INFINITY;
    f.component[0].ref({9, 9, 9}) = -2;
    Job job;
    const BrickVolume volume(f, {.non_negative = true}, job);
    EXPECT_EQ(volume.non_finite(), 2);
    EXPECT_EQ(volume.at({16, 16, 16}), 0);
    EXPECT_EQ(volume.at({9, 9, 9}), 0);
    EXPECT_EQ(volume.min(), 0);
    EXPECT_NEAR(volume.max(), 1, 1e-5);
}

TEST(BrickVolume, StoresOutliersAsFloats) {
    Field f;
    f.component.emplace_back(TileMap::box({16, 16, 16}), 1.0f);
    EXPECT_TRUE(pack(f, BrickOptions::Storage::Auto).is_compact());
    f.component[0].ref({4, 4, 4}) = 1e9f;
    const BrickVolume volume = pack(f, BrickOptions::Storage::Auto);
    EXPECT_FALSE(volume.is_compact());
    EXPECT_EQ(volume.at({1, 1, 1}), 1);
}

TEST(BrickVolume, PacksTwoDimensionalFields) {
    Field f;
    f.component.emplace_back(TileMap::box({70, 37, 1}));
    f.to_world = Transform::scale_translate(0.1, {});
    Random random{random_key(4)};
    for (int y = 0; y < 37; ++y) {
        for (int x = 0; x < 70; ++x) f.component[0].ref({x, y, 0}) = float(random());
    }
    const BrickVolume volume = pack(f);
    for (int i = 0; i < 5000; ++i) {
        const Vec3d p{random.between(-1, 8), random.between(-1, 5), random.between(-0.2, 0.3)};
        ASSERT_NEAR(volume.sample(p), f.sample(p), 2e-5);
    }
}

TEST(BrickVolume, FindsFarApartTilesAndRefusesTheImpossible) {
    Field f;
    f.component.emplace_back(
        TileMap::sparse({{-2000, 0, 0}, {2000, 5, -7}}, {Vec3i(-100000), Vec3i(100000)}));
    f.component[0].ref({-16000, 1, 1}) = 1;
    f.component[0].ref({16001, 42, -51}) = 2;
    const BrickVolume volume = pack(f);
    EXPECT_FLOAT_EQ(volume.at({-16000, 1, 1}), 1);
    EXPECT_FLOAT_EQ(volume.at({16001, 42, -51}), 2);
    EXPECT_EQ(volume.at({0, 0, 0}), 0);

    f.component[0] = TileField<float>(
        TileMap::sparse({Vec3i(-1000000), Vec3i(1000000)}, {Vec3i(-8000000), Vec3i(8000008)}),
        1.0f);
    EXPECT_THROW(pack(f), Error);
}

TEST(BrickVolume, KeepsBricksForAnotherVolume) {
    Field f, g;
    f.component.emplace_back(TileMap::box({32, 32, 32}));
    g = f;
    f.component[0].ref({4, 4, 4}) = 1;
    g.component[0].ref({28, 28, 28}) = 1;
    Job job;
    const BrickVolume flame(g, {}, job);
    const BrickVolume smoke(f, {.also = &flame}, job);
    EXPECT_EQ(smoke.size(), 2);
    const int kept = smoke.find({3, 3, 3});
    ASSERT_GE(kept, 0);
    EXPECT_EQ(smoke.occupied(kept), flame.occupied(flame.find({3, 3, 3})));
    EXPECT_EQ(smoke.block(kept, 7).max, 0);
}

// The same bits on one thread and on all.
TEST(BrickVolume, DoesNotDependOnThreads) {
    const Field field = random_field(3, tilted(0.5));
    const BrickVolume a = pack(field);
    const ThreadLimit one(1);
    const BrickVolume b = pack(field);
    ASSERT_EQ(a.size(), b.size());
    for (int i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a.coord(i), b.coord(i));
        EXPECT_EQ(a.block(i, 3).mean, b.block(i, 3).mean);
        EXPECT_EQ(a.at_local(i, {1.3f, 2.7f, 6.1f}), b.at_local(i, {1.3f, 2.7f, 6.1f}));
    }
}

// Checks a walk against brute force: runs ascend, touch or leave gaps, cover every point with a
// value, and look-ups inside them are those of the volume.
void check_walk(const BrickVolume& volume, const Ray& ray, BrickGrain grain) {
    BrickWalk walk(volume, ray, grain);
    BrickRun run;
    std::vector<BrickRun> runs;
    double last = ray.t_min;
    while (walk.next(run)) {
        ASSERT_LE(run.t0, run.t1);
        ASSERT_GE(run.t0, last);
        last = run.t1;
        runs.push_back(run);
        for (const double s : {0.01, 0.5, 0.99}) {
            const double t = run.t0 + s * (run.t1 - run.t0);
            const Vec3f local = run.entry + static_cast<float>(t - run.t0) * walk.step();
            const float v = volume.at_local(run.brick, local);
            ASSERT_NEAR(v, volume.sample(ray.at(t)), 1e-4);
            ASSERT_GE(v, run.bounds.min - 1e-4f);
            ASSERT_LE(v, run.bounds.max + 1e-4f);
        }
    }
    ASSERT_LE(last, ray.t_max);
    const double end = std::min(ray.t_max, 60.0);
    std::size_t r = 0;
    for (double t = ray.t_min; t < end; t += 0.01) {
        while (r < runs.size() && runs[r].t1 < t - 1e-9) ++r;
        const bool covered = r < runs.size() && runs[r].t0 <= t + 1e-9;
        if (!covered) {
            ASSERT_NEAR(volume.sample(ray.at(t)), 0, 1e-6) << "not covered at " << t;
        }
    }
}

void check_walk(const BrickVolume& volume, const Ray& ray) {
    check_walk(volume, ray, BrickGrain::Blocks);
    check_walk(volume, ray, BrickGrain::Bricks);
}

TEST(BrickWalk, CoversExactlyTheSupportOnRandomRays) {
    const BrickVolume volume = pack(random_field(5, tilted(0.5)));
    const Transform to_world = tilted(0.5);
    Random random{random_key(11)};
    for (int i = 0; i < 300; ++i) {
        const Vec3d target = to_world.point(random.vec(-8, 16));
        Ray ray{target, random.direction(), 0, 60};
        if (i % 3 != 0) ray.origin = target - 20.0 * ray.direction;  // every third starts inside
        ASSERT_NO_FATAL_FAILURE(check_walk(volume, ray)) << i;
    }
}

TEST(BrickWalk, CoversTheSupportOnAxisParallelRaysAndAlongFaces) {
    const BrickVolume volume = pack(random_field(6, Transform{}));
    for (int axis = 0; axis < 3; ++axis) {
        for (int sign = -1; sign <= 1; sign += 2) {
            // In cell space the planes q = 0, 4, 8 lie at 0.5, 4.5, 8.5.
            for (const double u : {-7.5, -3.5, 0.5, 2.25, 4.5, 8.5, 12.5}) {
                for (const double v : {-7.5, 0.5, 3.0, 8.5, 11.0}) {
                    Ray ray;
                    ray.origin[(axis + 1) % 3] = u;
                    ray.origin[(axis + 2) % 3] = v;
                    ray.origin[axis] = -30.0 * sign;
                    ray.direction = {};
                    ray.direction[axis] = sign;
                    ray.t_max = 60;
                    ASSERT_NO_FATAL_FAILURE(check_walk(volume, ray));
                }
            }
        }
    }
    // Along diagonals through edges and corners.
    for (const Vec3d& d : {Vec3d(1, 1, 0), Vec3d(1, -1, 1), Vec3d(-1, -1, -1), Vec3d(0, 1, -1)}) {
        Ray ray{Vec3d(0.5) - 20.0 * d, d, 0, 60};
        ASSERT_NO_FATAL_FAILURE(check_walk(volume, ray));
        ray.direction.x += 1e-25;
        ASSERT_NO_FATAL_FAILURE(check_walk(volume, ray));
    }
}

TEST(BrickWalk, EndsOnEmptyVolumesAndMissingRays) {
    BrickRun run;
    EXPECT_FALSE(BrickWalk(BrickVolume(), Ray{}).next(run));
    const BrickVolume volume = pack(random_field(7, Transform{}));
    EXPECT_FALSE(BrickWalk(volume, {{100, 0, 0}, {0, 0, 1}}).next(run));
    EXPECT_FALSE(BrickWalk(volume, {{0, 0, -50}, {0, 0, -1}}).next(run));
    EXPECT_FALSE(BrickWalk(volume, {{0, 0, -50}, {0, 0, 1}, 0, 10}).next(run));
    // No NaN comes out of an impossible direction.
    EXPECT_FALSE(BrickWalk(volume, {{100, 0, 0}, {0, 0, 0}, 0, 10}).next(run));
}

TEST(BrickVolume, LooksUpManyPointsAtOnce) {
    const BrickVolume volume = pack(random_field(8, Transform{}));
    Random random{random_key(12)};
    for (int i = 0; i < 200; ++i) {
        const int brick = static_cast<int>(random() * volume.size());
        const Vec3f entry(random.vec(0, 8));
        const Vec3f step = (Vec3f(random.vec(0, 8)) - entry) / 20.0f;
        float t[20], out[20];
        const int n = i % 20 + 1;
        for (int k = 0; k < n; ++k) t[k] = static_cast<float>(20 * random());
        volume.along(brick, entry, step, t, n, out);
        for (int k = 0; k < n; ++k) {
            ASSERT_NEAR(out[k], volume.at_local(brick, entry + t[k] * step), 5e-6);
        }
    }
}

}  // namespace
}  // namespace gischt
