// SPDX-License-Identifier: Apache-2.0
// What restrict and prolong have in common; included once per instruction set like kernels-inl.h.
#if defined(GISCHT_SOLVE_TRANSFER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GISCHT_SOLVE_TRANSFER_INL_H
#undef GISCHT_SOLVE_TRANSFER_INL_H
#else
#define GISCHT_SOLVE_TRANSFER_INL_H
#endif

#include "solve/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {

// A fine tile covers an octant (a quadrant in 2-D) of its coarse tile: rows of 4 (16) coarse cells,
// worked on 4 at a time.
using Four = hn::CappedTag<float, 4>;
using Vec4 = hn::Vec<Four>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Four()));  // 4, or 1 without vectors

// The octant of a fine tile: its coarse tile and its first cell there.
struct Octant {
    int tile;
    Vec3i first;
    bool constant;  // all weights around the coarse tile's cells are equal, so the fine ones' too
    Octant(const StencilLevel& fine, const StencilLevel& coarse, int fine_tile) {
        const Vec3i c = fine.map->coord(fine_tile), e = fine.shape().extent();
        tile = coarse.map->find({c.x >> 1, c.y >> 1, c.z >> 1});
        first = {(c.x & 1) * e.x / 2, (c.y & 1) * e.y / 2, (c.z & 1) * e.z / 2};
        constant = coarse.block[static_cast<std::size_t>(tile)] == StencilLevel::constant_block;
    }
};

// Natural row (j, k), lanes [x, x + 4) of one quantity in split order; `black_step` lies between
// its red and black values.
template <bool is_2d>
HWY_INLINE Vec4 load_row(const float* red, int x, int j, int k, int black_step) {
    using S = Shape<is_2d>;
    const Four d;
    const int at = x + S::width * ((j >> 1) + S::rows * k), even = (j + k) & 1;
    return odd_even(hn::Load(d, red + at + (1 - even) * black_step),
                    hn::Load(d, red + at + even * black_step), x);
}

// A quarter of the face fractions of the coarse cells in row (j, k) of an octant, -x +x -y +y -z
// +z.
template <bool is_2d>
struct QuarterFractions {
    Vec4 v[6];
    HWY_INLINE QuarterFractions(const StencilLevel& coarse, const Octant& o, int x, int j, int k) {
        const Vec4 scale = hn::Set(Four(), 0.25f / coarse.weight);
        const StencilBlock& block = coarse.block_of(o.tile);
        for (int a = 0; a < Shape<is_2d>::directions; ++a) {
            const Direction direction =
                a / 2 == 1 ? ((j & 1) == (a & 1) ? OtherRow : SameRow) : static_cast<Direction>(a);
            v[a] = hn::Mul(scale,
                           load_row<is_2d>(block.weight[0][direction], o.first.x + x, o.first.y + j,
                                           o.first.z + k, direction_count * color_values));
        }
    }
};

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GISCHT_SOLVE_TRANSFER_INL_H
