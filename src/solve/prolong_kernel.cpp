// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/prolong_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "solve/transfer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {

struct ProlongArguments {
    const StencilLevel& fine;
    const StencilLevel& coarse;
    const SplitField& e;
    const SplitField& r;
    SplitField& z;
};

template <bool is_2d, bool>
struct ProlongKernel {
    using S = Shape<is_2d>;
    static constexpr int nx = S::width / 2, ny = S::rows, nz = is_2d ? 1 : S::planes / 2;
    static constexpr int stride = nx + 8;

    // The correction of the octant in natural order with one cell of halo on the six sides.
    struct Patch {
        HWY_ALIGN float e[nz + 2][ny + 2][stride];
    };

    // Natural rows of the coarse tile, or of the neighbour that holds them.
    static const float* tile_of(const Around& e, int& j, int& k) {
        constexpr int height = 2 * S::rows;
        const float* tile = e.own;
        if (j < 0) tile = e.beside[2], j += height;
        if (j >= height) tile = e.beside[3], j -= height;
        if (k < 0) tile = e.beside[4], k += S::planes;
        if (k >= S::planes) tile = e.beside[5], k -= S::planes;
        return tile;
    }
    static void load(const Around& e, const Octant& o, Patch& p) {
        const Four d;
        for (int k = is_2d ? 0 : -1; k < (is_2d ? 1 : nz + 1); ++k) {
            for (int j = -1; j <= ny; ++j) {
                const bool edge_j = j < 0 || j == ny, edge_k = k < 0 || k == nz;
                if (edge_j && edge_k) continue;
                int cj = o.first.y + j, ck = o.first.z + k;
                const float* tile = tile_of(e, cj, ck);
                float* row = p.e[k + 1][j + 1] + 4;
                for (int x = 0; x < nx; x += lanes) {
                    hn::Store(load_row<is_2d>(tile, o.first.x + x, cj, ck, color_values), d,
                              row + x);
                }
                if (edge_j || edge_k) continue;
                const int low = o.first.x - 1, high = o.first.x + nx;
                row[-1] = low >= 0 ? e.own[split_index(S::shape, low, cj, ck)]
                                   : e.beside[0][split_index(S::shape, S::width - 1, cj, ck)];
                row[nx] = high < S::width ? e.own[split_index(S::shape, high, cj, ck)]
                                          : e.beside[1][split_index(S::shape, 0, cj, ck)];
            }
        }
    }

    // The four red children of coarse cells: own value plus a slope along each axis.
    template <bool constant>
    static void store(const Patch& patch, const Octant& o, const ProlongArguments& a, int tile) {
        const Four d;
        const StencilBlock& fine_block = a.fine.block_of(tile);
        const float* r = a.r.tile(tile);
        float* z = a.z.tile(tile);
        for (int k = 0; k < nz; ++k) {
            for (int j = 0; j < ny; ++j) {
                for (int x = 0; x < nx; x += lanes) {
                    const float* at = patch.e[k + 1][j + 1] + 4 + x;
                    const Vec4 own = hn::Load(d, at);
                    Vec4 g[6];
                    slopes<constant>(at, own, o, a.coarse, x, j, k, g);
                    const Vec4 x0 = hn::Add(own, g[0]), x1 = hn::Add(own, g[1]);
                    const int to = 2 * x + S::width * (j + S::rows * 2 * k);
                    for (int plane = 0; plane < (is_2d ? 1 : 2); ++plane) {
                        // Red is in row `plane` on the even lanes, in the other one on the odd.
                        Vec4 even = hn::Add(x0, g[2 + plane]), odd = hn::Add(x1, g[3 - plane]);
                        if constexpr (!is_2d) {
                            even = hn::Add(even, g[4 + plane]);
                            odd = hn::Add(odd, g[4 + plane]);
                        }
                        const int row = to + plane * S::plane;
                        correct<constant>(even, odd, fine_block.inverse_diagonal[0] + row, r + row,
                                          z + row);
                    }
                }
            }
        }
    }

    // A quarter of w (e_n - e_c) towards the six neighbours.
    template <bool constant>
    static HWY_INLINE void slopes(const float* at, Vec4 own, const Octant& o,
                                  const StencilLevel& coarse, int x, int j, int k, Vec4 (&g)[6]) {
        const Four d;
        constexpr int step[6] = {-1, 1, -stride, stride, -stride * (ny + 2), stride * (ny + 2)};
        for (int i = 0; i < S::directions; ++i) g[i] = hn::Sub(hn::LoadU(d, at + step[i]), own);
        if constexpr (constant) {
            const Vec4 quarter = hn::Set(d, 0.25f);
            for (int i = 0; i < S::directions; ++i) g[i] = hn::Mul(quarter, g[i]);
        } else {
            const QuarterFractions<is_2d> f(coarse, o, x, j, k);
            for (int i = 0; i < S::directions; ++i) g[i] = hn::Mul(f.v[i], g[i]);
        }
    }

    // z = d r + correction, two vectors of one packed row. Nothing where a cell is left out, as
    // beyond an open side: black cells are about to read it.
    template <bool constant>
    static HWY_INLINE void correct(Vec4 even, Vec4 odd, const float* inverse, const float* r,
                                   float* z) {
        const Four d;
        HWY_ALIGN float correction[8];
        hn::StoreInterleaved2(even, odd, d, correction);
        for (int i = 0; i < 2 * lanes; i += lanes) {
            const Vec4 id = hn::Load(d, inverse + i);
            const Vec4 value = hn::MulAdd(id, hn::Load(d, r + i), hn::Load(d, correction + i));
            hn::Store(constant ? value : hn::IfThenElseZero(hn::Gt(id, hn::Zero(d)), value), d,
                      z + i);
        }
    }

    static void run(const ProlongArguments& a, int tile, std::size_t) {
        const Octant o(a.fine, a.coarse, tile);
        const Around e = around(a.coarse, o.tile, a.e, 0);
        Patch patch;
        load(e, o, patch);
        o.constant ? store<true>(patch, o, a, tile) : store<false>(patch, o, a, tile);
    }
};

void ProlongRed(const TileRange& fine, const StencilLevel& coarse, const SplitField& e,
                const SplitField& r, SplitField& z) {
    for_tiles<ProlongKernel>(fine, ProlongArguments{fine.level, coarse, e, r, z});
}

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {

HWY_EXPORT(ProlongRed);

void prolong_red(const TileRange& fine, const StencilLevel& coarse, const SplitField& e,
                 const SplitField& r, SplitField& z) {
    HWY_DYNAMIC_DISPATCH(ProlongRed)(fine, coarse, e, r, z);
}

}  // namespace gischt
#endif  // HWY_ONCE
