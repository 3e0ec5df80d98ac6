// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/transfer_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "solve/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {

// A fine tile covers an octant (a quadrant in 2-D) of its coarse tile: rows of 4 (16) coarse cells,
// worked on 4 at a time.
using Four = hn::CappedTag<float, 4>;
using Vec4 = hn::Vec<Four>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Four()));  // 4, or 1 without vectors

struct TransferArguments {
    const StencilLevel& fine;
    const StencilLevel& coarse;
    const SplitField& from;
    const SplitField& r;
    SplitField& to;
};

// The octant of a fine tile: its coarse tile and its first cell there.
struct Octant {
    int tile;
    Vec3i first;
    Octant(const StencilLevel& fine, const StencilLevel& coarse, int fine_tile) {
        const Vec3i c = fine.map->coord(fine_tile), e = fine.shape().extent();
        tile = coarse.map->find({c.x >> 1, c.y >> 1, c.z >> 1});
        first = {(c.x & 1) * e.x / 2, (c.y & 1) * e.y / 2, (c.z & 1) * e.z / 2};
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

// A quarter of the coarse face fractions of a natural row, -x +x -y +y -z +z.
template <bool is_2d>
struct QuarterFractions {
    Vec4 v[6];
    QuarterFractions(const StencilLevel& coarse, const StencilBlock& block, int x, int j, int k) {
        const Four d;
        const Vec4 scale = hn::Set(d, 0.25f / coarse.weight);
        for (int a = 0; a < Shape<is_2d>::directions; ++a) {
            const Direction direction =
                a / 2 == 1 ? ((j & 1) == (a & 1) ? OtherRow : SameRow) : static_cast<Direction>(a);
            v[a] = hn::Mul(scale, load_row<is_2d>(block.weight[0][direction], x, j, k,
                                                  direction_count * color_values));
        }
    }
};

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

    static Vec4 row(const Halves& h, const Octant& o, const StencilLevel& coarse, int x, int j,
                    int k) {
        const Four d;
        const Vec4 x0 = hn::Load(d, h.x[0][k][j] + 4 + x), x1 = hn::Load(d, h.x[1][k][j] + 4 + x);
        Vec4 own[6] = {x0, x1, hn::Load(d, h.y[0][k][j + 1] + x),
                       hn::Load(d, h.y[1][k][j + 1] + x)};
        Vec4 next[6] = {hn::LoadU(d, h.x[1][k][j] + 3 + x), hn::LoadU(d, h.x[0][k][j] + 5 + x),
                        hn::Load(d, h.y[1][k][j] + x), hn::Load(d, h.y[0][k][j + 2] + x)};
        if constexpr (!is_2d) {
            own[4] = hn::Load(d, h.z[0][k + 1][j] + x);
            own[5] = hn::Load(d, h.z[1][k + 1][j] + x);
            next[4] = hn::Load(d, h.z[1][k][j] + x);
            next[5] = hn::Load(d, h.z[0][k + 2][j] + x);
        }
        const QuarterFractions<is_2d> f(coarse, coarse.block_of(o.tile), o.first.x + x,
                                        o.first.y + j, o.first.z + k);
        Vec4 sum = hn::Add(x0, x1);
        for (int a = 0; a < S::directions; ++a) {
            sum = hn::MulAdd(f.v[a], hn::Sub(next[a], own[a]), sum);
        }
        return sum;
    }

    static void run(const TransferArguments& a, int tile, std::size_t) {
        const Four d;
        const Octant o(a.fine, a.coarse, tile);
        const Around res = around(a.fine, tile, a.from, 0);
        Halves h;
        load_own(res, h);
        load_halo(res, h);
        float* red = a.to.tile(o.tile);
        for (int k = 0; k < nz; ++k) {
            for (int j = 0; j < ny; j += 2) {
                for (int x = 0; x < nx; x += lanes) {
                    const Vec4 lower = row(h, o, a.coarse, x, j, k);
                    const Vec4 upper = row(h, o, a.coarse, x, j + 1, k);
                    const int at = o.first.x + x +
                                   S::width * ((o.first.y + j) / 2 + S::rows * (o.first.z + k));
                    const bool even = ((o.first.z + k) & 1) == 0;
                    hn::Store(even ? odd_even(upper, lower, x) : odd_even(lower, upper, x), d,
                              red + at);
                    hn::Store(even ? odd_even(lower, upper, x) : odd_even(upper, lower, x), d,
                              red + at + color_values);
                }
            }
        }
    }
};

template <bool is_2d, bool constant>
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

    static void run(const TransferArguments& a, int tile, std::size_t) {
        const Four d;
        const Octant o(a.fine, a.coarse, tile);
        const StencilBlock& fine_block = a.fine.block_of(tile);
        const Around e = around(a.coarse, o.tile, a.from, 0);
        Patch p;
        load(e, o, p);
        const float* r = a.r.tile(tile);
        float* z = a.to.tile(tile);
        for (int k = 0; k < nz; ++k) {
            for (int j = 0; j < ny; ++j) {
                for (int x = 0; x < nx; x += lanes) {
                    const float* at = p.e[k + 1][j + 1] + 4 + x;
                    const QuarterFractions<is_2d> f(a.coarse, a.coarse.block_of(o.tile),
                                                    o.first.x + x, o.first.y + j, o.first.z + k);
                    const Vec4 own = hn::Load(d, at);
                    constexpr int step[6] = {
                        -1, 1, -stride, stride, -stride * (ny + 2), stride * (ny + 2)};
                    Vec4 g[6];
                    for (int i = 0; i < S::directions; ++i) {
                        g[i] = hn::Mul(f.v[i], hn::Sub(hn::LoadU(d, at + step[i]), own));
                    }
                    const Vec4 x0 = hn::Add(own, g[0]), x1 = hn::Add(own, g[1]);
                    const int row = 2 * x + S::width * (j + S::rows * 2 * k);
                    for (int plane = 0; plane < (is_2d ? 1 : 2); ++plane) {
                        Vec4 even = hn::Add(x0, g[2 + plane]), odd = hn::Add(x1, g[3 - plane]);
                        if constexpr (!is_2d) {
                            even = hn::Add(even, g[4 + plane]);
                            odd = hn::Add(odd, g[4 + plane]);
                        }
                        const int to = row + plane * S::plane;
                        HWY_ALIGN float correction[8];
                        hn::StoreInterleaved2(even, odd, d, correction);
                        for (int i = 0; i < 2 * lanes; i += lanes) {
                            // Nothing beyond an open side, which black cells are about to read.
                            const Vec4 inverse =
                                hn::Load(d, fine_block.inverse_diagonal[0] + to + i);
                            const Vec4 value = hn::MulAdd(inverse, hn::Load(d, r + to + i),
                                                          hn::Load(d, correction + i));
                            hn::Store(hn::IfThenElseZero(hn::Gt(inverse, hn::Zero(d)), value), d,
                                      z + to + i);
                        }
                    }
                }
            }
        }
    }
};

void RestrictRed(const TileRange& fine, const StencilLevel& coarse, const SplitField& res,
                 SplitField& coarse_r) {
    for_tiles<RestrictKernel>(fine, TransferArguments{fine.level, coarse, res, res, coarse_r});
}
void ProlongRed(const TileRange& fine, const StencilLevel& coarse, const SplitField& e,
                const SplitField& r, SplitField& z) {
    for_tiles<ProlongKernel>(fine, TransferArguments{fine.level, coarse, e, r, z});
}

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {

HWY_EXPORT(RestrictRed);
HWY_EXPORT(ProlongRed);

void restrict_red(const TileRange& fine, const StencilLevel& coarse, const SplitField& res,
                  SplitField& coarse_r) {
    HWY_DYNAMIC_DISPATCH(RestrictRed)(fine, coarse, res, coarse_r);
}
void prolong_red(const TileRange& fine, const StencilLevel& coarse, const SplitField& e,
                 const SplitField& r, SplitField& z) {
    HWY_DYNAMIC_DISPATCH(ProlongRed)(fine, coarse, e, r, z);
}

}  // namespace gischt
#endif  // HWY_ONCE
