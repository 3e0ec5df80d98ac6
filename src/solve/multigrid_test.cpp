// SPDX-License-Identifier: Apache-2.0
#include "solve/multigrid.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "solve/stencil_solver.h"
#include "solve/test_problem.h"
#include "solve/transfer.h"

namespace gischt {
namespace {

using namespace test;

SideRules rules(const Sides& sides) {
    SideRules r;
    for (std::size_t s = 0; s < 6; ++s) {
        r[s].kind = sides[s] == Side::Wall   ? SideRule::Kind::Closed
                    : sides[s] == Side::Open ? SideRule::Kind::Fixed
                                             : SideRule::Kind::Periodic;
    }
    return r;
}

// Random numbers on the cells that take part, zero elsewhere.
SplitField noise(const StencilLevel& level, std::uint64_t seed) {
    SplitField field(level.tiles_with_ghosts);
    for (const int t : level.active) {
        for (int v = 0; v < tile_values; ++v) {
            const auto& inverse = level.block_of(t).inverse_diagonal;
            if (!(inverse[v / color_values][v % color_values] > 0)) continue;
            const auto key = random_key(seed, static_cast<std::uint64_t>(t));
            field.tile(t)[v] = random_uniform(key, static_cast<std::uint32_t>(v)) - 0.5f;
        }
    }
    return field;
}

double inner(const StencilLevel& level, const SplitField& a, const SplitField& b) {
    double sum = 0;
    for (const int t : level.active) {
        for (int v = 0; v < tile_values; ++v) {
            const auto& inverse = level.block_of(t).inverse_diagonal;
            if (!(inverse[v / color_values][v % color_values] > 0)) continue;
            sum += static_cast<double>(a.tile(t)[v]) * static_cast<double>(b.tile(t)[v]);
        }
    }
    return sum;
}

struct Problem {
    Vec3i n;
    Sides sides;
    bool sphere;
    double place = 0.4;  // of the sphere, in edges
};

const Problem problems[] = {
    {Vec3i(32, 48, 40), closed_box, true},
    {Vec3i(32, 32, 32), all_periodic, true},
    {Vec3i(29, 33, 40), open_top, true},
    {Vec3i(27, 25, 22), all_periodic, true},
    {Vec3i(24, 24, 2), all_open, false},
    {Vec3i(45, 31, 33), all_open, true},
    {Vec3i(128, 64, 1), open_top, true},
    {Vec3i(131, 67, 1), all_periodic, true},
    // The first faces are closed; the last ones are the same faces, whatever is in their place.
    {Vec3i(64, 40, 40), all_periodic, true, 0.0},
};

class OnProblem : public testing::TestWithParam<Problem> {
  protected:
    OnProblem() : map_(TileMap::box(GetParam().n)) {
        const Vec3d center = GetParam().place * Vec3d(GetParam().n);
        fraction_ = fractions(map_, [&](const Vec3d& p) {
            return sphere_distance(p, {center.x, center.y, map_->is_2d() ? p.z : center.z}, 6.3);
        });
        spec_.map = map_;
        spec_.sides = rules(GetParam().sides);
        if (GetParam().sphere) spec_.fraction = &fraction_;
    }

    TileMap::Ptr map_;
    FaceField fraction_;
    StencilSpec spec_;
};

// A p by the kernel that the iteration uses: r - 1 A p from r = 0.
SplitField multiply(const StencilLevel& level, SplitField& p) {
    const int tiles = level.tiles_with_ghosts;
    SplitField r(tiles), z(tiles);
    AlignedVector<float> x(static_cast<std::size_t>(level.map->size()) * tile_values, 0);
    std::vector<float> largest(level.active.size());
    fill_ghosts(level, p);
    const int count = static_cast<int>(level.active.size());
    advance({level, 0, count}, -1.0f, p, x.data(), r, z, largest);
    return r;
}

TEST_P(OnProblem, OperatorIsTheOneOfTheHeader) {
    const StencilLevel level = make_finest(spec_);
    TileField<float> x(map_);
    SplitField p = noise(level, 1);
    for (const int t : level.active) {
        for (int v = 0; v < tile_values; ++v) {
            x.tile(t)[v] = p.tile(t)[split_index(level.shape(), level.shape().cell(v))];
        }
    }
    const SplitField q = multiply(level, p);
    for_cells(GetParam().n, [&](const Vec3i& c) {
        const int t = map_->find(level.shape().tile_of(c));
        const Vec3i local = c - map_->first_cell(t);
        ASSERT_NEAR(q.tile(t)[split_index(level.shape(), local)],
                    test::apply(x, GetParam().sides, spec_.fraction, c), 2e-6);
    });
}

TEST_P(OnProblem, OperatorAndPreconditionerAreSymmetricAndPositive) {
    Multigrid multigrid(spec_);
    const StencilLevel& level = multigrid.finest();
    const int tiles = level.tiles_with_ghosts, count = static_cast<int>(level.active.size());
    SplitField x = noise(level, 1), y = noise(level, 2);
    const SplitField ax = multiply(level, x), ay = multiply(level, y);
    const double xx = inner(level, x, x);
    EXPECT_NEAR(inner(level, y, ax), inner(level, x, ay), 1e-6 * xx);
    EXPECT_GT(inner(level, x, ax), 0);
    std::vector<double> sums(level.active.size());
    multiply_sum({level, 0, count}, x, sums);
    EXPECT_NEAR(tree_sum(sums), inner(level, x, ax), 1e-6 * xx);

    SplitField mx(tiles), my(tiles);
    smooth_red_first({level, 0, count}, x, mx);
    const double xmx = multigrid.precondition(x, mx);
    smooth_red_first({level, 0, count}, y, my);
    multigrid.precondition(y, my);
    EXPECT_NEAR(xmx, inner(level, x, mx), 1e-6 * xx);
    const double size = std::sqrt(inner(level, y, y) * inner(level, mx, mx));
    EXPECT_NEAR(inner(level, y, mx), inner(level, x, my), 1e-7 * size);
    EXPECT_GT(xmx, 0);
}

// Fast against slow, and one against the transpose of the other.
void compare_transfers(const StencilLevel& fine, const StencilLevel& coarse) {
    SplitField r = noise(fine, 1), e = noise(coarse, 2), zero(fine.tiles_with_ghosts);
    SplitField re(coarse.tiles_with_ghosts), pe(fine.tiles_with_ghosts);
    restrict_wrapped(fine, coarse, r, re);
    prolong_wrapped(fine, coarse, e, pe);
    EXPECT_NEAR(inner(coarse, re, e), inner(fine, r, pe), 1e-5 * inner(fine, r, r));
    if (!fine.copies.empty()) return;

    // The fast ones read and write red cells only.
    for (const int t : fine.active) std::fill_n(r.tile(t) + color_values, color_values, 0.0f);
    restrict_wrapped(fine, coarse, r, re);
    SplitField fast_re(coarse.tiles_with_ghosts), fast_pe(fine.tiles_with_ghosts);
    const int count = static_cast<int>(fine.active.size());
    restrict_red({fine, 0, count}, coarse, r, fast_re);
    fill_ghosts(coarse, e);
    prolong_red({fine, 0, count}, coarse, e, zero, fast_pe);
    for (const int t : coarse.active) {
        for (int v = 0; v < tile_values; ++v) {
            const auto& inverse = coarse.block_of(t).inverse_diagonal;
            if (!(inverse[v / color_values][v % color_values] > 0)) continue;
            ASSERT_NEAR(re.tile(t)[v], fast_re.tile(t)[v], 1e-6) << t << ' ' << v;
        }
    }
    for (const int t : fine.active) {
        for (int v = 0; v < color_values; ++v) {
            if (!(fine.block_of(t).inverse_diagonal[0][v] > 0)) continue;
            ASSERT_NEAR(pe.tile(t)[v], fast_pe.tile(t)[v], 1e-6) << t << ' ' << v;
        }
    }
}

TEST_P(OnProblem, TransfersFollowTheirDefinitionAndAreTransposed) {
    StencilLevel fine = make_finest(spec_);
    while (volume(fine.cells) > DenseInverse::max_cells) {
        StencilLevel coarse = make_coarser(fine);
        compare_transfers(fine, coarse);
        fine = std::move(coarse);
    }
}

INSTANTIATE_TEST_SUITE_P(Levels, OnProblem, testing::ValuesIn(problems));

TEST(Multigrid, CoarseWeightsOfAnOpenBoxAreSumsOverTheFaces) {
    // The same box once as open, once with fractions that are all 1 but for one corner face, so
    // that every tile around it sums up its children.
    const auto map = TileMap::box({44, 30, 26});
    FaceField fraction(map, 1);
    StencilSpec spec;
    spec.map = map;
    spec.sides = rules(open_top);
    const StencilLevel open = make_coarser(make_coarser(make_finest(spec)));
    for (int k = 0; k < 26; k += 4) {
        for (int j = 0; j < 30; j += 4) {
            for (int i = 1; i < 44; i += 4) fraction.ref(0, {i, j, k}) = 0.5f;
        }
    }
    spec.fraction = &fraction;
    const StencilLevel summed = make_coarser(make_coarser(make_finest(spec)));
    for (int t = 0; t < open.map->size(); ++t) {
        ASSERT_TRUE(summed.is_own(t));
        const Vec3i size = open.map->cells_of(t).size();
        for_cells(size, [&](const Vec3i& c) {
            for (int a = 0; a < 3; ++a) {
                for (int end = 0; end < 2; ++end) {
                    // The changed faces lie inside coarse cells.
                    EXPECT_NEAR(face_weight(open, t, c, a, end), face_weight(summed, t, c, a, end),
                                1e-5);
                }
            }
        });
    }
}

TEST(Multigrid, AllInstructionSetsAgree) {
    for (const Vec3i n : {Vec3i(40, 36, 33), Vec3i(140, 70, 1)}) {
        const auto map = TileMap::box(n);
        const FaceField fraction =
            fractions(map, [&](const Vec3d& p) { return sphere_distance(p, 0.4 * Vec3d(n), 6); });
        const TileField<float> b = plume(map, open_top, &fraction);
        TileField<float> reference;
        int paths = 0;
        // All that this machine has of what the library holds, from the best one to none.
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            hwy::GetChosenTarget().Update(target);
            TileField<float> x(map);
            Job job;
            PoissonSolver solver(map, open_top, &fraction);
            EXPECT_TRUE(solver.solve(b, x, 1e-6, 30, job).converged);
            float largest = 0, difference = 0;
            if (paths == 0) reference = x;
            for (std::size_t i = 0; i < x.values().size(); ++i) {
                largest = std::max(largest, std::abs(reference.values()[i]));
                difference = std::max(difference, std::abs(x.values()[i] - reference.values()[i]));
            }
            EXPECT_LE(difference, 1e-5f * largest) << hwy::TargetName(target);
            ++paths;
        }
        hwy::GetChosenTarget().DeInit();
        RecordProperty("paths", paths);
        EXPECT_GE(paths, 2);
    }
}

}  // namespace
}  // namespace gischt
