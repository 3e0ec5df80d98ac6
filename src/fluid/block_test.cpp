// SPDX-License-Identifier: Apache-2.0
#include "fluid/block.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace gischt {
namespace {

float any_value(const Vec3i& c, int axis) {
    const auto u = [](int a) { return static_cast<std::uint64_t>(a + 1000); };
    return random_uniform(random_key(u(c.x), u(c.y), u(c.z)), static_cast<std::uint32_t>(axis));
}

FaceField any_faces(const Vec3i& n) {
    FaceField f(TileMap::box(n));
    for (int a = 0; a < f.axes(); ++a) {
        Vec3i count = n;
        count[a] += 1;
        for_cells({{}, count}, [&](const Vec3i& c) { f.ref(a, c) = any_value(c, a); });
    }
    return f;
}

class BlockOf : public testing::TestWithParam<Vec3i> {};

TEST_P(BlockOf, TilesCoverTheBox) {
    const auto map = TileMap::box(GetParam());
    const BlockMap blocks(map);
    std::size_t cells = 0;
    int next = 0;
    for (int b = 0; b < blocks.size(); ++b) {
        EXPECT_EQ(blocks.find(blocks.coord(b)), b);
        EXPECT_EQ(blocks.first_tile(b), next);
        next = blocks.end_tile(b);
        cells += volume(blocks.cells(b).size());
        for (int t = blocks.first_tile(b); t < next; ++t) {
            EXPECT_EQ(intersection(blocks.cells(b), map->cells_of(t)), map->cells_of(t));
        }
    }
    EXPECT_EQ(next, map->size());
    EXPECT_EQ(cells, volume(GetParam()));
}

// The fast gather is the one of the grid, for all borders, halos and placements.
TEST_P(BlockOf, GathersWhatTheGridGathers) {
    const Vec3i n = GetParam();
    const FaceField faces = any_faces(n);
    const BlockMap blocks(faces.component[0].map_ptr());
    const bool is_2d = n.z == 1;
    for (const Border rule :
         {Border::Clamp, Border::Even, Border::Odd, Border::Periodic, Border::Zero}) {
        for (const int halo : {1, 3, 9}) {
            for (int b = 0; b < blocks.size(); ++b) {
                const Lattice l = Lattice::around(blocks.cells(b), Vec3i(halo), true, is_2d);
                std::vector<float> expected(l.count()), got(l.count());
                gather(faces[0], l.region, Borders::all(rule), expected.data());
                gather_block(faces[0], l, Borders::all(rule), got.data());
                EXPECT_EQ(expected, got);
                for (int a = 0; a < faces.axes(); ++a) {
                    gather_faces(faces, a, l.region, Borders::all(rule), expected.data());
                    gather_block_faces(faces, a, l, Borders::all(rule), got.data());
                    EXPECT_EQ(expected, got);
                }
            }
        }
    }
}

TEST_P(BlockOf, ScattersWhatItGathered) {
    const Vec3i n = GetParam();
    const FaceField from = any_faces(n);
    FaceField to(from.component[0].map_ptr(), 7);
    const BlockMap blocks(from.component[0].map_ptr());
    for (int b = 0; b < blocks.size(); ++b) {
        const Lattice l = Lattice::around(blocks.cells(b), Vec3i(0), true, n.z == 1);
        std::vector<float> values(l.count());
        for (int a = 0; a < from.axes(); ++a) {
            gather_block_faces(from, a, l, Borders{}, values.data());
            scatter_block_faces(blocks, b, a, l, values.data(), to);
        }
    }
    for (int a = 0; a < from.axes(); ++a) {
        Vec3i count = n;
        count[a] += 1;
        for_cells({{}, count}, [&](const Vec3i& c) { EXPECT_EQ(from.get(a, c), to.get(a, c)); });
    }
}

INSTANTIATE_TEST_SUITE_P(Boxes, BlockOf,
                         testing::Values(Vec3i(32, 16, 16), Vec3i(37, 18, 25), Vec3i(5, 40, 16),
                                         Vec3i(130, 33, 1), Vec3i(20, 7, 1)));

}  // namespace
}  // namespace gischt
