// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/smooth_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "solve/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {

struct SmoothArguments {
    const StencilLevel& level;
    Smooth what;
    const SplitField& r;
    SplitField& z;
    double* sum;
};

template <bool is_2d, bool constant>
struct FirstKernel {
    static void run(const SmoothArguments& a, int tile, std::size_t) {
        const Floats d;
        const Coefficients<is_2d, constant> c(a.level, tile);
        const float* r = a.r.tile(tile);
        float* z = a.z.tile(tile);
        for (int i = 0; i < color_values; i += static_cast<int>(hn::Lanes(d))) {
            hn::Store(hn::Mul(c.inverse_diagonal(0, i), hn::Load(d, r + i)), d, z + i);
        }
    }
};

template <bool is_2d, bool constant>
struct SmoothKernel {
    template <int color, bool sums>
    static double half(const SmoothArguments& a, int tile) {
        const Floats d;
        const Coefficients<is_2d, constant> c(a.level, tile);
        const Around other = around(a.level, tile, a.z, 1 - color);
        const float* r = a.r.tile(tile) + color * color_values;
        float* z = a.z.tile(tile) + color * color_values;
        Accumulator total;
        for_vectors<is_2d>(
            [&](int x, int row, int plane, int at) GISCHT_KERNEL {
                const Neighbours n = load_neighbours<is_2d, color>(other, x, row, plane);
                const Vec rhs = hn::Load(d, r + at);
                const Vec value =
                    hn::Mul(c.inverse_diagonal(color, at), hn::Add(rhs, c.sum(n, color, at)));
                hn::Store(value, d, z + at);
                if constexpr (sums) total.add(hn::Mul(rhs, value));
            },
            [&]() GISCHT_KERNEL {
                if constexpr (sums) total.end_plane();
            });
        return total.sum();
    }
    static void run(const SmoothArguments& a, int tile, std::size_t at) {
        const bool red = a.what.color == 0;
        if (a.sum == nullptr) {
            red ? half<0, false>(a, tile) : half<1, false>(a, tile);
            return;
        }
        const double sum = red ? half<0, true>(a, tile) : half<1, true>(a, tile);
        a.sum[at] = a.what.add ? a.sum[at] + sum : sum;
    }
};

template <bool is_2d, bool constant>
struct ResidualKernel {
    static void run(const SmoothArguments& a, int tile, std::size_t) {
        const Coefficients<is_2d, constant> c(a.level, tile);
        const Around black = around(a.level, tile, a.z, 1);
        float* red = a.z.tile(tile);
        for_vectors<is_2d>(
            [&](int x, int row, int plane, int at) GISCHT_KERNEL {
                const Neighbours n = load_neighbours<is_2d, 0>(black, x, row, plane);
                hn::Store(c.sum(n, 0, at), Floats(), red + at);
            },
            []() {});
    }
};

struct FullResidualArguments {
    const StencilLevel& level;
    const SplitField& r;
    const SplitField& z;
    SplitField& res;
};

template <bool is_2d, bool constant>
struct FullResidualKernel {
    template <int color>
    static void half(const FullResidualArguments& a, int tile) {
        const Floats d;
        const Coefficients<is_2d, constant> c(a.level, tile);
        const Around other = around(a.level, tile, a.z, 1 - color);
        const int first = color * color_values;
        const float* r = a.r.tile(tile) + first;
        const float* z = a.z.tile(tile) + first;
        float* res = a.res.tile(tile) + first;
        for_vectors<is_2d>(
            [&](int x, int row, int plane, int at) GISCHT_KERNEL {
                const Neighbours n = load_neighbours<is_2d, color>(other, x, row, plane);
                const Vec q = c.apply(hn::Load(d, z + at), n, color, at);
                hn::Store(hn::Sub(hn::Load(d, r + at), q), d, res + at);
            },
            []() {});
    }
    static void run(const FullResidualArguments& a, int tile, std::size_t) {
        half<0>(a, tile);
        half<1>(a, tile);
    }
};

void SmoothRedFirst(const TileRange& range, const SplitField& r, SplitField& z) {
    for_tiles<FirstKernel>(range, SmoothArguments{range.level, {}, r, z, nullptr});
}
void SmoothColor(const TileRange& range, const Smooth& what, const SplitField& r, SplitField& z,
                 double* sum) {
    for_tiles<SmoothKernel>(range, SmoothArguments{range.level, what, r, z, sum});
}
void RedResidual(const TileRange& range, SplitField& z) {
    for_tiles<ResidualKernel>(range, SmoothArguments{range.level, {}, z, z, nullptr});
}
void FullResidual(const TileRange& range, const SplitField& r, const SplitField& z,
                  SplitField& res) {
    for_tiles<FullResidualKernel>(range, FullResidualArguments{range.level, r, z, res});
}

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {

HWY_EXPORT(SmoothRedFirst);
HWY_EXPORT(SmoothColor);
HWY_EXPORT(RedResidual);
HWY_EXPORT(FullResidual);

void smooth_red_first(const TileRange& range, const SplitField& r, SplitField& z) {
    HWY_DYNAMIC_DISPATCH(SmoothRedFirst)(range, r, z);
}
void smooth(const TileRange& range, const Smooth& what, const SplitField& r, SplitField& z,
            std::span<double> sum) {
    HWY_DYNAMIC_DISPATCH(SmoothColor)(range, what, r, z, sum.data());
}
void red_residual(const TileRange& range, SplitField& z) {
    HWY_DYNAMIC_DISPATCH(RedResidual)(range, z);
}
void residual(const TileRange& range, const SplitField& r, const SplitField& z, SplitField& res) {
    HWY_DYNAMIC_DISPATCH(FullResidual)(range, r, z, res);
}

}  // namespace gischt
#endif  // HWY_ONCE
