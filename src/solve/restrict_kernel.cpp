// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/restrict_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "solve/transfer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {

// Sums over the red children of a row of coarse cells. Child (plane k of 2, lane x of 2): the red
// ones lie in row (k + x) & 1.
struct RedChildren {
    Vec4 v[2][2];
};
template <bool is_2d>
HWY_INLINE RedChildren load_children(const float* res, int x, int j, int k) {
    using S = Shape<is_2d>;
    const Four d;
    RedChildren c;
    const float* row = res + 2 * x + S::width * (j + S::rows * 2 * k);
    hn::LoadInterleaved2(d, row, c.v[0][0], c.v[0][1]);
    if constexpr (is_2d) {
        c.v[1][0] = c.v[1][1] = hn::Zero(d);
    } else {
        hn::LoadInterleaved2(d, row + S::plane, c.v[1][0], c.v[1][1]);
    }
    return c;
}
HWY_INLINE Vec4 half_sum(const RedChildren& c, int axis, int end) {
    if (axis == 0) return hn::Add(c.v[0][end], c.v[1][end]);
    if (axis == 1) return hn::Add(c.v[0][end], c.v[1][1 - end]);
    return hn::Add(c.v[end][0], c.v[end][1]);
}

struct RestrictArguments {
    const StencilLevel& fine;
    const StencilLevel& coarse;
    const SplitField& res;
    SplitField& coarse_r;
};

// R is the sum over the children after an exchange between the children on both sides of every
// coarse face: R_c = S_c + sum over the faces of w/4 (H_n - H_c), H being the sum over the children
// that touch the face.
template <bool is_2d, bool>
struct RestrictKernel {
    using S = Shape<is_2d>;
    static constexpr int nx = S::width / 2, ny = S::rows, nz = is_2d ? 1 : S::planes / 2;
    static constexpr int stride = nx + 8;  // a row with a vector of halo before and after

    // The sums of an octant that its neighbours touch, with a halo; [row] counts from -1.
    struct Halves {
        HWY_ALIGN float x[2][nz][ny][stride];
        HWY_ALIGN float y[2][nz][ny + 2][nx];
        HWY_ALIGN float z[2][is_2d ? 1 : nz + 2][ny][nx];
    };

    static void load_own(const Around& res, Halves& h) {
        const Four d;
        for (int k = 0; k < nz; ++k) {
            for (int j = 0; j < ny; ++j) {
                for (int x = 0; x < nx; x += lanes) {
                    const RedChildren c = load_children<is_2d>(res.own, x, j, k);
                    for (int end = 0; end < 2; ++end) {
                        hn::Store(half_sum(c, 0, end), d, h.x[end][k][j] + 4 + x);
                        hn::Store(half_sum(c, 1, end), d, h.y[end][k][j + 1] + x);
                        if constexpr (!is_2d) {
                            hn::Store(half_sum(c, 2, end), d, h.z[end][k + 1][j] + x);
                        }
                    }
                }
            }
        }
    }
    static void load_halo(const Around& res, Halves& h) {
        const Four d;
        for (int k = 0; k < nz; ++k) {
            for (int j = 0; j < ny; ++j) {
                const int row = S::width * (j + S::rows * (is_2d ? 0 : 2 * k));
                const float* low = res.beside[0] + row + S::width - 1;
                const float* high = res.beside[1] + row;
                h.x[1][k][j][3] = low[0] + (is_2d ? 0.0f : low[S::plane]);
                h.x[0][k][j][4 + nx] = high[0] + (is_2d ? 0.0f : high[S::plane]);
            }
            for (int x = 0; x < nx; x += lanes) {
                const RedChildren low = load_children<is_2d>(res.beside[2], x, ny - 1, k);
                const RedChildren high = load_children<is_2d>(res.beside[3], x, 0, k);
                hn::Store(half_sum(low, 1, 1), d, h.y[1][k][0] + x);
                hn::Store(half_sum(high, 1, 0), d, h.y[0][k][ny + 1] + x);
            }
        }
        if constexpr (!is_2d) {
            for (int j = 0; j < ny; ++j) {
                for (int x = 0; x < nx; x += lanes) {
                    const RedChildren low = load_children<is_2d>(res.beside[4], x, j, nz - 1);
                    const RedChildren high = load_children<is_2d>(res.beside[5], x, j, 0);
                    hn::Store(half_sum(low, 2, 1), d, h.z[1][0][j] + x);
                    hn::Store(half_sum(high, 2, 0), d, h.z[0][nz + 1][j] + x);
                }
            }
        }
    }

    // One natural row of R res.
    template <bool constant>
    static HWY_INLINE Vec4 row(const Halves& h, const Octant& o, const StencilLevel& coarse, int x,
                               int j, int k) {
        const Four d;
        const Vec4 x0 = hn::Load(d, h.x[0][k][j] + 4 + x), x1 = hn::Load(d, h.x[1][k][j] + 4 + x);
        Vec4 next[6] = {hn::LoadU(d, h.x[1][k][j] + 3 + x), hn::LoadU(d, h.x[0][k][j] + 5 + x),
                        hn::Load(d, h.y[1][k][j] + x), hn::Load(d, h.y[0][k][j + 2] + x)};
        if constexpr (!is_2d) {
            next[4] = hn::Load(d, h.z[1][k][j] + x);
            next[5] = hn::Load(d, h.z[0][k + 2][j] + x);
        }
        const Vec4 all = hn::Add(x0, x1);
        if constexpr (constant) {
            // All w are 1, and the six (four) H_c sum up to 3 (2) S_c.
            Vec4 sum = hn::Add(next[0], next[1]);
            for (int a = 2; a < S::directions; ++a) sum = hn::Add(sum, next[a]);
            const Vec4 quarter = hn::Set(d, 0.25f);
            return hn::Mul(quarter, hn::Add(sum, is_2d ? hn::Add(all, all) : all));
        } else {
            Vec4 own[6] = {x0, x1, hn::Load(d, h.y[0][k][j + 1] + x),
                           hn::Load(d, h.y[1][k][j + 1] + x)};
            if constexpr (!is_2d) {
                own[4] = hn::Load(d, h.z[0][k + 1][j] + x);
                own[5] = hn::Load(d, h.z[1][k + 1][j] + x);
            }
            const QuarterFractions<is_2d> f(coarse, o, x, j, k);
            Vec4 sum = all;
            for (int a = 0; a < S::directions; ++a) {
                sum = hn::MulAdd(f.v[a], hn::Sub(next[a], own[a]), sum);
            }
            return sum;
        }
    }

    template <bool constant>
    static void store(const Halves& h, const Octant& o, const RestrictArguments& a) {
        const Four d;
        float* red = a.coarse_r.tile(o.tile);
        for (int k = 0; k < nz; ++k) {
            const bool even = ((o.first.z + k) & 1) == 0;
            for (int j = 0; j < ny; j += 2) {
                float* at =
                    red + o.first.x + S::width * ((o.first.y + j) / 2 + S::rows * (o.first.z + k));
                for (int x = 0; x < nx; x += lanes) {
                    const Vec4 lower = row<constant>(h, o, a.coarse, x, j, k);
                    const Vec4 upper = row<constant>(h, o, a.coarse, x, j + 1, k);
                    hn::Store(even ? odd_even(upper, lower, x) : odd_even(lower, upper, x), d,
                              at + x);
                    hn::Store(even ? odd_even(lower, upper, x) : odd_even(upper, lower, x), d,
                              at + x + color_values);
                }
            }
        }
    }

    static void run(const RestrictArguments& a, int tile, std::size_t) {
        const Octant o(a.fine, a.coarse, tile);
        const Around res = around(a.fine, tile, a.res, 0);
        Halves h;
        load_own(res, h);
        load_halo(res, h);
        o.constant ? store<true>(h, o, a) : store<false>(h, o, a);
    }
};

void RestrictRed(const TileRange& fine, const StencilLevel& coarse, const SplitField& res,
                 SplitField& coarse_r) {
    for_tiles<RestrictKernel>(fine, RestrictArguments{fine.level, coarse, res, coarse_r});
}

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {

HWY_EXPORT(RestrictRed);

void restrict_red(const TileRange& fine, const StencilLevel& coarse, const SplitField& res,
                  SplitField& coarse_r) {
    HWY_DYNAMIC_DISPATCH(RestrictRed)(fine, coarse, res, coarse_r);
}

}  // namespace gischt
#endif  // HWY_ONCE
