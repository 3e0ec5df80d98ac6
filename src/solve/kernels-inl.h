// SPDX-License-Identifier: Apache-2.0
// SIMD access to a tile in split order; included once per instruction set by the kernel files,
// after hwy/foreach_target.h.
#if defined(GISCHT_SOLVE_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GISCHT_SOLVE_KERNELS_INL_H
#undef GISCHT_SOLVE_KERNELS_INL_H
#else
#define GISCHT_SOLVE_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include "solve/kernels.h"

// Attributes of the lambdas that for_vectors calls: the target's instructions, no call.
#undef GISCHT_KERNEL
#define GISCHT_KERNEL HWY_ATTR __attribute__((always_inline))

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// At most 8 lanes: a row of a 3-D tile.
using Floats = hn::CappedTag<float, 8>;
using Vec = hn::Vec<Floats>;

// Odd lanes of one vector and even lanes of the other, for the lanes that begin at x of a row; a
// machine without vectors has one lane.
template <class V>
HWY_INLINE V odd_even(V odd, V even, [[maybe_unused]] int x) {
#if HWY_TARGET == HWY_SCALAR
    return (x & 1) != 0 ? odd : even;
#else
    return hn::OddEven(odd, even);
#endif
}

// Compile-time numbers of a tile shape.
template <bool is_2d>
struct Shape {
    static constexpr TileShape shape = is_2d ? tile_shape_2d : tile_shape_3d;
    static constexpr int width = 1 << shape.log_x;       // lanes of a packed row
    static constexpr int rows = (1 << shape.log_y) / 2;  // packed rows of a plane
    static constexpr int planes = 1 << shape.log_z;
    static constexpr int plane = width * rows;  // values of a plane, one colour
    static constexpr int directions = is_2d ? 4 : 6;
};

// One colour of a field at a tile and at its six neighbours.
struct Around {
    const float* own;
    const float* beside[6];
};
inline Around around(const StencilLevel& level, int tile, const SplitField& field, int color) {
    Around a;
    a.own = field.tile(tile) + color * color_values;
    const auto& n = level.neighbours[static_cast<std::size_t>(tile)];
    for (std::size_t i = 0; i < 6; ++i) a.beside[i] = field.tile(n[i]) + color * color_values;
    return a;
}

// The neighbours of one vector of cells, by Direction.
struct Neighbours {
    Vec v[direction_count];
};

// Loads the neighbours, which all have colour 1 - `color`, of the cells of colour `color` in lanes
// [x, x + Lanes) of packed row (row, plane).
template <bool is_2d, int color>
HWY_INLINE Neighbours load_neighbours(const Around& a, int x, int row, int plane) {
    using S = Shape<is_2d>;
    const Floats d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int in_row = S::width * (row + S::rows * plane), at = in_row + x;
    Neighbours n;
    n.v[Left] = hn::LoadU(d, a.own + at - 1);
    if (x == 0) {
        n.v[Left] = hn::IfThenElse(hn::FirstN(d, 1), hn::Set(d, a.beside[0][in_row + S::width - 1]),
                                   n.v[Left]);
    }
    n.v[Right] = hn::LoadU(d, a.own + at + 1);
    if (x + lanes == S::width) {
        n.v[Right] = hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(lanes - 1)), n.v[Right],
                                    hn::Set(d, a.beside[1][in_row]));
    }
    n.v[SameRow] = hn::Load(d, a.own + at);
    const float* before =
        row > 0 ? a.own + at - S::width : a.beside[2] + at + (S::rows - 1) * S::width;
    const float* after =
        row + 1 < S::rows ? a.own + at + S::width : a.beside[3] + at - (S::rows - 1) * S::width;
    const Vec y0 = hn::Load(d, before), y1 = hn::Load(d, after);
    // Cells of the lower row, whose other row is the one before, lie in the even lanes where plane
    // + color is even.
    n.v[OtherRow] = ((plane + color) & 1) == 0 ? odd_even(y1, y0, x) : odd_even(y0, y1, x);
    if constexpr (!is_2d) {
        n.v[Back] = hn::Load(
            d, plane > 0 ? a.own + at - S::plane : a.beside[4] + at + (S::planes - 1) * S::plane);
        n.v[Front] =
            hn::Load(d, plane + 1 < S::planes ? a.own + at + S::plane
                                              : a.beside[5] + at - (S::planes - 1) * S::plane);
    }
    return n;
}

// Coefficients of a tile: numbers where they are the same in all cells, else its block's.
template <bool is_2d, bool constant>
class Coefficients {
  public:
    Coefficients(const StencilLevel& level, int tile) : block_(level.block_of(tile)) {
        const Floats d;
        weight_ = hn::Set(d, block_.weight[0][0][0]);
        extra_ = hn::Set(d, block_.extra[0][0]);
        inverse_ = hn::Set(d, block_.inverse_diagonal[0][0]);
    }

    // Sum of w x over the neighbours.
    HWY_INLINE Vec sum(const Neighbours& n, int color, int at) const {
        const Floats d;
        if constexpr (constant) {
            Vec s = hn::Add(hn::Add(n.v[Left], n.v[Right]), hn::Add(n.v[SameRow], n.v[OtherRow]));
            if constexpr (!is_2d) s = hn::Add(s, hn::Add(n.v[Back], n.v[Front]));
            return hn::Mul(weight_, s);
        } else {
            Vec s = hn::Mul(hn::Load(d, block_.weight[color][0] + at), n.v[0]);
            for (int i = 1; i < Shape<is_2d>::directions; ++i) {
                s = hn::MulAdd(hn::Load(d, block_.weight[color][i] + at), n.v[i], s);
            }
            return s;
        }
    }

    // A x; differences first, since x varies by far less than its size.
    HWY_INLINE Vec apply(Vec x, const Neighbours& n, int color, int at) const {
        const Floats d;
        if constexpr (constant) {
            Vec s = hn::Add(hn::Sub(x, n.v[0]), hn::Sub(x, n.v[1]));
            for (int i = 2; i < Shape<is_2d>::directions; i += 2) {
                s = hn::Add(s, hn::Add(hn::Sub(x, n.v[i]), hn::Sub(x, n.v[i + 1])));
            }
            return hn::MulAdd(weight_, s, hn::Mul(extra_, x));
        } else {
            Vec s = hn::Mul(hn::Load(d, block_.extra[color] + at), x);
            for (int i = 0; i < Shape<is_2d>::directions; ++i) {
                s = hn::MulAdd(hn::Load(d, block_.weight[color][i] + at), hn::Sub(x, n.v[i]), s);
            }
            return s;
        }
    }

    HWY_INLINE Vec inverse_diagonal(int color, int at) const {
        if constexpr (constant) return inverse_;
        return hn::Load(Floats(), block_.inverse_diagonal[color] + at);
    }

  private:
    const StencilBlock& block_;
    Vec weight_, extra_, inverse_;
};

// Sums floats of a plane per lane, planes in double.
class Accumulator {
  public:
    // Written out, since what the compiler adds itself lacks the target's attributes.
    Accumulator() : plane_(hn::Zero(Floats())), sum_(0) {}
    HWY_INLINE void add(Vec v) { plane_ = hn::Add(plane_, v); }
    HWY_INLINE void end_plane() {
        const Floats d;
        HWY_ALIGN float lane[8];
        hn::Store(plane_, d, lane);
        for (std::size_t i = 0; i < hn::Lanes(d); ++i) sum_ += static_cast<double>(lane[i]);
        plane_ = hn::Zero(d);
    }
    double sum() const { return sum_; }

  private:
    Vec plane_;
    double sum_;
};

// Calls f(x, row, plane, offset) for all vectors of one colour of a tile, and after each plane
// end().
template <bool is_2d, class F, class End>
HWY_INLINE void for_vectors(const F& f, const End& end) {
    using S = Shape<is_2d>;
    const int lanes = static_cast<int>(hn::Lanes(Floats()));
    for (int plane = 0; plane < S::planes; ++plane) {
        for (int row = 0; row < S::rows; ++row) {
            for (int x = 0; x < S::width; x += lanes) {
                f(x, row, plane, x + S::width * (row + S::rows * plane));
            }
        }
        end();
    }
}

// Calls Kernel<is_2d, constant>::run(arguments, tile, position) for each tile of a range.
template <template <bool, bool> class Kernel, class Arguments>
void for_tiles(const TileRange& range, const Arguments& arguments) {
    const StencilLevel& level = range.level;
    for (int i = range.begin; i < range.end; ++i) {
        const int t = level.active[static_cast<std::size_t>(i)];
        const bool constant =
            level.block[static_cast<std::size_t>(t)] == StencilLevel::constant_block;
        const auto at = static_cast<std::size_t>(i);
        if (level.is_2d()) {
            constant ? Kernel<true, true>::run(arguments, t, at)
                     : Kernel<true, false>::run(arguments, t, at);
        } else {
            constant ? Kernel<false, true>::run(arguments, t, at)
                     : Kernel<false, false>::run(arguments, t, at);
        }
    }
}

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GISCHT_SOLVE_KERNELS_INL_H
