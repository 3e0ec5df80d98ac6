// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/gradient_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "solve/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gischt::HWY_NAMESPACE {

struct MultiplyArguments {
    const StencilLevel& level;
    const SplitField& p;
    double* sum;
};

template <bool is_2d, bool constant>
struct MultiplyKernel {
    template <int color>
    static void half(const MultiplyArguments& a, int tile, double& sum) {
        const Coefficients<is_2d, constant> c(a.level, tile);
        const Around other = around(a.level, tile, a.p, 1 - color);
        const float* own = a.p.tile(tile) + color * color_values;
        Accumulator total;
        for_vectors<is_2d>(
            [&](int x, int row, int plane, int at) GISCHT_KERNEL {
                const Vec p = hn::Load(Floats(), own + at);
                const Neighbours n = load_neighbours<is_2d, color>(other, x, row, plane);
                total.add(hn::Mul(p, c.apply(p, n, color, at)));
            },
            [&]() GISCHT_KERNEL { total.end_plane(); });
        sum += total.sum();
    }
    static void run(const MultiplyArguments& a, int tile, std::size_t at) {
        double sum = 0;
        half<0>(a, tile, sum);
        half<1>(a, tile, sum);
        a.sum[at] = sum;
    }
};

struct AdvanceArguments {
    const StencilLevel& level;
    float step;
    const SplitField& p;
    float* x;
    SplitField& r;
    SplitField& z;
    float* largest;
};

template <bool is_2d, bool constant>
struct AdvanceKernel {
    static void run(const AdvanceArguments& a, int tile, std::size_t position) {
        const Floats d;
        const Coefficients<is_2d, constant> c(a.level, tile);
        const Around red = around(a.level, tile, a.p, 0), black = around(a.level, tile, a.p, 1);
        float* r = a.r.tile(tile);
        float* z = a.z.tile(tile);
        float* user = a.x + static_cast<std::size_t>(tile) * tile_values;
        const Vec step = hn::Set(d, a.step);
        Vec largest = hn::Zero(d);
        for_vectors<is_2d>(
            [&](int x, int row, int plane, int at) GISCHT_KERNEL {
                const Vec p0 = hn::Load(d, red.own + at), p1 = hn::Load(d, black.own + at);
                const Vec q0 = c.apply(p0, load_neighbours<is_2d, 0>(black, x, row, plane), 0, at);
                const Vec q1 = c.apply(p1, load_neighbours<is_2d, 1>(red, x, row, plane), 1, at);
                const Vec r0 = hn::NegMulAdd(step, q0, hn::Load(d, r + at));
                const Vec r1 = hn::NegMulAdd(step, q1, hn::Load(d, r + at + color_values));
                hn::Store(r0, d, r + at);
                hn::Store(r1, d, r + at + color_values);
                hn::Store(hn::Mul(c.inverse_diagonal(0, at), r0), d, z + at);
                largest = hn::Max(largest, hn::Max(hn::Abs(r0), hn::Abs(r1)));
                // Rows 2 row and 2 row + 1 of x: the even lanes of the first are red in even
                // planes.
                const bool even = (plane & 1) == 0;
                const Vec lower = even ? odd_even(p1, p0, x) : odd_even(p0, p1, x);
                const Vec upper = even ? odd_even(p0, p1, x) : odd_even(p1, p0, x);
                float* x0 = user + x + Shape<is_2d>::width * 2 * (row + Shape<is_2d>::rows * plane);
                float* x1 = x0 + Shape<is_2d>::width;
                hn::Store(hn::MulAdd(step, lower, hn::Load(d, x0)), d, x0);
                hn::Store(hn::MulAdd(step, upper, hn::Load(d, x1)), d, x1);
            },
            []() {});
        a.largest[position] = hn::GetLane(hn::MaxOfLanes(d, largest));
    }
};

struct DirectionArguments {
    float factor;
    const SplitField& z;
    SplitField& p;
};

template <bool, bool>
struct DirectionKernel {
    static void run(const DirectionArguments& a, int tile, std::size_t) {
        const Floats d;
        const Vec factor = hn::Set(d, a.factor);
        const float* z = a.z.tile(tile);
        float* p = a.p.tile(tile);
        for (int i = 0; i < tile_values; i += static_cast<int>(hn::Lanes(d))) {
            hn::Store(hn::MulAdd(factor, hn::Load(d, p + i), hn::Load(d, z + i)), d, p + i);
        }
    }
};

struct DotArguments {
    const SplitField& r;
    const SplitField& z;
    double* sum;
};

template <bool, bool>
struct DotKernel {
    static void run(const DotArguments& a, int tile, std::size_t at) {
        const Floats d;
        Accumulator total;
        for (int i = 0; i < tile_values; i += static_cast<int>(hn::Lanes(d))) {
            total.add(hn::Mul(hn::Load(d, a.r.tile(tile) + i), hn::Load(d, a.z.tile(tile) + i)));
            if (i % 64 == 0) total.end_plane();
        }
        total.end_plane();
        a.sum[at] = total.sum();
    }
};

struct MaxArguments {
    const SplitField& r;
    float* largest;
};

template <bool, bool>
struct MaxKernel {
    static void run(const MaxArguments& a, int tile, std::size_t at) {
        const Floats d;
        Vec m = hn::Zero(d);
        for (int i = 0; i < tile_values; i += static_cast<int>(hn::Lanes(d))) {
            m = hn::Max(m, hn::Abs(hn::Load(d, a.r.tile(tile) + i)));
        }
        a.largest[at] = hn::GetLane(hn::MaxOfLanes(d, m));
    }
};

struct SplitArguments {
    const StencilLevel& level;
    const float* natural;
    SplitField& field;
};

template <bool is_2d, bool constant>
struct SplitKernel {
    static void run(const SplitArguments& a, int tile, std::size_t) {
        const Floats d;
        const Vec zero = hn::Zero(d);
        const Coefficients<is_2d, constant> c(a.level, tile);
        const float* user = a.natural + static_cast<std::size_t>(tile) * tile_values;
        float* field = a.field.tile(tile);
        for_vectors<is_2d>(
            [&](int x, int row, int plane, int at) GISCHT_KERNEL {
                const float* x0 =
                    user + x + Shape<is_2d>::width * 2 * (row + Shape<is_2d>::rows * plane);
                const Vec lower = hn::Load(d, x0), upper = hn::Load(d, x0 + Shape<is_2d>::width);
                const bool even = (plane & 1) == 0;
                const Vec red = even ? odd_even(upper, lower, x) : odd_even(lower, upper, x);
                const Vec black = even ? odd_even(lower, upper, x) : odd_even(upper, lower, x);
                const auto has_red = hn::Gt(c.inverse_diagonal(0, at), zero);
                const auto has_black = hn::Gt(c.inverse_diagonal(1, at), zero);
                hn::Store(hn::IfThenElseZero(has_red, red), d, field + at);
                hn::Store(hn::IfThenElseZero(has_black, black), d, field + at + color_values);
            },
            []() {});
    }
};

void MultiplySum(const TileRange& range, const SplitField& p, double* sum) {
    for_tiles<MultiplyKernel>(range, MultiplyArguments{range.level, p, sum});
}
void Advance(const TileRange& range, float step, const SplitField& p, float* x, SplitField& r,
             SplitField& z, float* largest) {
    for_tiles<AdvanceKernel>(range, AdvanceArguments{range.level, step, p, x, r, z, largest});
}
void Dot(const TileRange& range, const SplitField& r, const SplitField& z, double* sum) {
    for_tiles<DotKernel>(range, DotArguments{r, z, sum});
}
void MaxMagnitude(const TileRange& range, const SplitField& r, float* largest) {
    for_tiles<MaxKernel>(range, MaxArguments{r, largest});
}
void Direct(const TileRange& range, float factor, const SplitField& z, SplitField& p) {
    for_tiles<DirectionKernel>(range, DirectionArguments{factor, z, p});
}
void Split(const TileRange& range, const float* natural, SplitField& field) {
    for_tiles<SplitKernel>(range, SplitArguments{range.level, natural, field});
}

}  // namespace gischt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {

HWY_EXPORT(MultiplySum);
HWY_EXPORT(Advance);
HWY_EXPORT(Dot);
HWY_EXPORT(MaxMagnitude);
HWY_EXPORT(Direct);
HWY_EXPORT(Split);

void multiply_sum(const TileRange& range, const SplitField& p, std::span<double> sum) {
    HWY_DYNAMIC_DISPATCH(MultiplySum)(range, p, sum.data());
}
void advance(const TileRange& range, float step, const SplitField& p, float* x, SplitField& r,
             SplitField& z, std::span<float> largest) {
    HWY_DYNAMIC_DISPATCH(Advance)(range, step, p, x, r, z, largest.data());
}
void dot(const TileRange& range, const SplitField& r, const SplitField& z, std::span<double> sum) {
    HWY_DYNAMIC_DISPATCH(Dot)(range, r, z, sum.data());
}
void max_magnitude(const TileRange& range, const SplitField& r, std::span<float> largest) {
    HWY_DYNAMIC_DISPATCH(MaxMagnitude)(range, r, largest.data());
}
void direction(const TileRange& range, float factor, const SplitField& z, SplitField& p) {
    HWY_DYNAMIC_DISPATCH(Direct)(range, factor, z, p);
}
void split(const TileRange& range, const float* natural, SplitField& field) {
    HWY_DYNAMIC_DISPATCH(Split)(range, natural, field);
}

}  // namespace gischt
#endif  // HWY_ONCE
