// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "grid/frame.h"
#include "grid/gather.h"

namespace gischt {
namespace {

float tag(const Vec3i& c) {
    return static_cast<float>(c.x + 100 * c.y + 10000 * c.z);
}

template <class F>
void for_cells(const Box3i& box, F&& f) {
    for (int k = box.lo.z; k < box.hi.z; ++k) {
        for (int j = box.lo.y; j < box.hi.y; ++j) {
            for (int i = box.lo.x; i < box.hi.x; ++i) f(Vec3i(i, j, k));
        }
    }
}

TEST(TileMap, CoversABoxAndLinksNeighbours) {
    for (const Vec3i n : {Vec3i(20, 9, 16), Vec3i(70, 33, 1)}) {
        const auto map = TileMap::box(n);
        std::size_t cells = 0;
        for (int t = 0; t < map->size(); ++t) {
            cells += volume(map->cells_of(t).size());
            EXPECT_EQ(map->find(map->coord(t)), t);
            EXPECT_EQ(map->neighbour(t, 0, 0, 0), t);
            const int right = map->neighbour(t, 1, 0, 0);
            if (right >= 0) {
                EXPECT_EQ(map->coord(right), map->coord(t) + Vec3i(1, 0, 0));
                EXPECT_EQ(map->neighbour(right, -1, 0, 0), t);
            }
        }
        EXPECT_EQ(cells, volume(n));
        EXPECT_EQ(map->find({-1, 0, 0}), -1);
    }
}

TEST(TileMap, FindsFarSparseTilesAndRefusesImpossibleOnes) {
    const std::vector<Vec3i> tiles{{0, 0, 0}, {-90000, 4, 70000}, {5000, 1, 1}, {0, 0, 0}};
    const auto map = TileMap::sparse(tiles, {{-1000000, 0, 0}, {1000000, 100, 1000000}});
    EXPECT_EQ(map->size(), 3);
    for (const Vec3i& c : tiles) EXPECT_EQ(map->coord(map->find(c)), c);
    EXPECT_EQ(map->find({1, 0, 0}), -1);
    EXPECT_THROW(TileMap::box({0, 4, 4}), Error);
    EXPECT_THROW(TileMap::box({1 << 15, 1 << 15, 8}), Error);
}

TEST(TileShape, IndexAndCellAreInverse) {
    for (const TileShape s : {tile_shape_3d, tile_shape_2d}) {
        std::set<int> seen;
        for_cells({{}, s.extent()}, [&](const Vec3i& c) {
            const int i = s.index(c.x, c.y, c.z);
            EXPECT_EQ(s.cell(i), c);
            seen.insert(i);
        });
        EXPECT_EQ(seen.size(), static_cast<std::size_t>(tile_values));
    }
}

class Gather : public testing::TestWithParam<Vec3i> {};

TEST_P(Gather, ContinuesCellsByEveryRule) {
    const Vec3i n = GetParam();
    TileField<float> f(TileMap::box(n));
    for_cells({{}, n}, [&](const Vec3i& c) { f.ref(c) = tag(c); });
    const Box3i region{{-3, -2, n.z == 1 ? 0 : -2}, {n.x + 3, n.y + 2, n.z == 1 ? 1 : n.z + 4}};
    std::vector<float> out(volume(region.size()));
    for (const Border rule :
         {Border::Clamp, Border::Even, Border::Odd, Border::Periodic, Border::Zero}) {
        gather(f, region, Borders::all(rule), out.data());
        std::size_t at = 0;
        for_cells(region, [&](const Vec3i& c) {
            float sign = 1;
            Vec3i from = c;
            for (int a = 0; a < 3; ++a) {
                if (c[a] >= 0 && c[a] < n[a]) continue;
                if (rule == Border::Clamp) from[a] = std::clamp(c[a], 0, n[a] - 1);
                if (rule == Border::Periodic) from[a] = (c[a] + n[a]) % n[a];
                if (rule == Border::Zero) sign = 0, from[a] = 0;
                if (rule == Border::Even || rule == Border::Odd) {
                    from[a] = c[a] < 0 ? -1 - c[a] : 2 * n[a] - 1 - c[a];
                    if (rule == Border::Odd) sign = -sign;
                }
            }
            EXPECT_EQ(out[at++], sign * tag(from)) << c.x << ' ' << c.y << ' ' << c.z;
        });
    }
}

TEST_P(Gather, ContinuesFacesAboutTheWall) {
    const Vec3i n = GetParam();
    FaceField f(TileMap::box(n));
    for (int axis = 0; axis < f.axes(); ++axis) {
        Vec3i count = n;
        count[axis] += 1;
        for_cells({{}, count}, [&](const Vec3i& c) { f.ref(axis, c) = tag(c); });
        Box3i region{{}, n};
        region.lo[axis] = -2;
        region.hi[axis] = n[axis] + 3;
        std::vector<float> out(volume(region.size()));
        for (const Border rule : {Border::Odd, Border::Clamp, Border::Periodic}) {
            gather_faces(f, axis, region, Borders::all(rule), out.data());
            std::size_t at = 0;
            for_cells(region, [&](const Vec3i& c) {
                Vec3i from = c;
                float sign = 1;
                if (c[axis] < 0 || c[axis] > n[axis]) {
                    if (rule == Border::Clamp) from[axis] = std::clamp(c[axis], 0, n[axis]);
                    if (rule == Border::Periodic) from[axis] = (c[axis] + n[axis]) % n[axis];
                    if (rule == Border::Odd) {
                        from[axis] = c[axis] < 0 ? -c[axis] : 2 * n[axis] - c[axis];
                        sign = -1;
                    }
                }
                EXPECT_EQ(out[at++], sign * tag(from));
            });
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Boxes, Gather,
                         testing::Values(Vec3i(16, 8, 8), Vec3i(19, 9, 13), Vec3i(40, 21, 1)));

TEST(Field, SamplesLinearFunctionsExactlyAtAnyPlacement) {
    Field f;
    f.component.emplace_back(TileMap::box({16, 16, 16}));
    f.to_world = Transform::scale_translate(0.25, {-1, 2, 3});
    for_cells({{}, Vec3i(16)}, [&](const Vec3i& c) {
        const Vec3d p = f.to_world.point(Vec3d(c) + Vec3d(0.5));
        f.component[0].ref(c) = static_cast<float>(p.x + 2 * p.y - 3 * p.z);
    });
    const Vec3d p(0.3, 3.7, 4.1);
    EXPECT_NEAR(f.sample(p), p.x + 2 * p.y - 3 * p.z, 1e-5);
    EXPECT_EQ(f.world_bounds(), (Box3d{{-1, 2, 3}, {3, 6, 7}}));
    EXPECT_EQ(f.cell_size(), 0.25);
}

}  // namespace
}  // namespace gischt
