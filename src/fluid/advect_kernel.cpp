// SPDX-License-Identifier: Apache-2.0
#include "fluid/advect_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fluid/advect_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Inlined wherever it is used, which the many instances of a kernel would else keep the compiler
// from.
#ifndef GISCHT_INLINE_LAMBDA
#define GISCHT_INLINE_LAMBDA HWY_ATTR __attribute__((always_inline))
#endif

HWY_BEFORE_NAMESPACE();
// A namespace of its own: other rooms have kernels with the same short names.
namespace gischt::advection::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<Tag>;
using Floats = hn::Vec<Tag>;
using Ints = hn::Vec<IntTag>;

// Positions of one vector of points, in cells: the centre of the input's cell (i,j,k) is (i,j,k).
struct Positions {
    Floats x, y, z;
};

// The lower corner of the cell of interpolation points around each position, and the weights.
struct Stencil {
    HWY_ALIGN std::int32_t base[16];
    Floats fx, fy, fz;
};

// Indices up to 2^24 are exact in float, so that the address is found by two multiply-adds.
// `margin` is 0 for linear and 1 for cubic interpolation.
template <int Dim>
HWY_INLINE Stencil locate(const AdvectGeometry& g, const Positions& p, int axis, int margin) {
    const Tag d;
    const auto low = hn::Set(d, static_cast<float>(margin));
    // Just below the last point that has an upper neighbour.
    const auto high = [&](int n) HWY_ATTR {
        return hn::Set(d, static_cast<float>(n - 1 - margin) - 0.001f);
    };
    const auto half = hn::Set(d, 0.5f);
    const auto px = axis == 0 ? hn::Add(p.x, half) : p.x, py = axis == 1 ? hn::Add(p.y, half) : p.y;
    const auto x = hn::Min(hn::Max(px, low), high(g.size.x));
    const auto y = hn::Min(hn::Max(py, low), high(g.size.y));
    const auto ix = hn::Floor(x), iy = hn::Floor(y);
    auto base = hn::MulAdd(iy, hn::Set(d, static_cast<float>(g.size.x)), ix);
    Stencil s;
    s.fx = hn::Sub(x, ix);
    s.fy = hn::Sub(y, iy);
    s.fz = hn::Zero(d);
    if constexpr (Dim == 3) {
        const auto pz = axis == 2 ? hn::Add(p.z, half) : p.z;
        const auto z = hn::Min(hn::Max(pz, low), high(g.size.z)), iz = hn::Floor(z);
        base = hn::MulAdd(iz, hn::Set(d, static_cast<float>(g.size.x * g.size.y)), base);
        s.fz = hn::Sub(z, iz);
    }
    hn::Store(hn::ConvertTo(IntTag(), base), IntTag(), s.base);
    return s;
}

HWY_INLINE Floats mix(Floats a, Floats b, Floats t) {
    return hn::MulAdd(hn::Sub(b, a), t, a);
}

// Gathering instructions take as long as one load per lane and more. Neighbours along x come in one
// load instead, and are sorted by transposing blocks of 4 x 4 values.
#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

template <int Count>
HWY_INLINE void load_rows(const float* p, const std::int32_t* base, Floats* out) {
    const auto index = hn::Load(IntTag(), base);
    for (int i = 0; i < Count; ++i) out[i] = hn::GatherIndex(Tag(), p + i, index);
}

#else

using Block = hn::FixedTag<float, 4>;

// A vector made of one block of 128 bits per four lanes.
template <class F>
HWY_INLINE Floats join_blocks(F block) {
    constexpr std::size_t lanes = hn::MaxLanes(Tag());
    if constexpr (lanes == 4) {
        return block(0);
    } else if constexpr (lanes == 8) {
        return hn::Combine(Tag(), block(1), block(0));
    } else {
        const hn::Half<Tag> d;
        return hn::Combine(Tag(), hn::Combine(d, block(3), block(2)),
                           hn::Combine(d, block(1), block(0)));
    }
}

// out[i] of each lane = p[base + i], for i < Count, which is 2 or 4.
template <int Count>
HWY_INLINE void load_rows(const float* p, const std::int32_t* base, Floats* out) {
    const Tag d;
    const hn::Repartition<double, Tag> pairs;
    const auto lower = [&](Floats a, Floats b) GISCHT_INLINE_LAMBDA {
        return hn::BitCast(d, hn::InterleaveLower(hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
    };
    const auto upper = [&](Floats a, Floats b) GISCHT_INLINE_LAMBDA {
        return hn::BitCast(
            d, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
    };
    if constexpr (Count == 2) {
        // Rows of lanes n and n + 2 in one block: a0 b0 a2 b2 and a1 b1 a3 b3.
        const auto two = [&](std::size_t lane) GISCHT_INLINE_LAMBDA {
            return join_blocks([&](std::size_t b) GISCHT_INLINE_LAMBDA {
                const hn::FixedTag<float, 2> d2;
                return hn::Combine(Block(), hn::LoadU(d2, p + base[4 * b + lane + 2]),
                                   hn::LoadU(d2, p + base[4 * b + lane]));
            });
        };
        const Floats even = two(0), odd = two(1);
        const Floats low = hn::InterleaveLower(d, even, odd),
                     high = hn::InterleaveUpper(d, even, odd);
        out[0] = lower(low, high);
        out[1] = upper(low, high);
    } else {
        const auto row = [&](std::size_t lane) GISCHT_INLINE_LAMBDA {
            return join_blocks([&](std::size_t b) GISCHT_INLINE_LAMBDA {
                return hn::LoadU(Block(), p + base[4 * b + lane]);
            });
        };
        const Floats r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
        const Floats low01 = hn::InterleaveLower(d, r0, r1), low23 = hn::InterleaveLower(d, r2, r3),
                     high01 = hn::InterleaveUpper(d, r0, r1),
                     high23 = hn::InterleaveUpper(d, r2, r3);
        out[0] = lower(low01, low23);
        out[1] = upper(low01, low23);
        out[2] = lower(high01, high23);
        out[3] = upper(high01, high23);
    }
}

#endif

// The values at the corners of the interpolation cell: 4 in 2-D, 8 in 3-D, x fastest.
template <int Dim>
struct Corners {
    Floats v[Dim == 2 ? 4 : 8];
};

template <int Dim>
HWY_INLINE Corners<Dim> load_corners(const AdvectGeometry& g, const float* p, const Stencil& s) {
    const std::ptrdiff_t sy = g.size.x, sz = sy * g.size.y;
    Corners<Dim> c;
    for (int k = 0; k < (Dim == 2 ? 1 : 2); ++k) {
        for (int j = 0; j < 2; ++j) load_rows<2>(p + sy * j + sz * k, s.base, c.v + 2 * j + 4 * k);
    }
    return c;
}

template <int Dim>
HWY_INLINE Floats linear(const AdvectGeometry& g, const float* p, const Stencil& s) {
    const Corners<Dim> c = load_corners<Dim>(g, p, s);
    const auto low = mix(mix(c.v[0], c.v[1], s.fx), mix(c.v[2], c.v[3], s.fx), s.fy);
    if constexpr (Dim == 2) {
        return low;
    } else {
        return mix(low, mix(mix(c.v[4], c.v[5], s.fx), mix(c.v[6], c.v[7], s.fx), s.fy), s.fz);
    }
}

// monotone_cubic() of math/interpolate.h.
HWY_INLINE Floats monotone(Floats f0, Floats f1, Floats f2, Floats f3, Floats t) {
    const Tag d;
    const auto delta = hn::Sub(f2, f1), half = hn::Set(d, 0.5f), zero = hn::Zero(d);
    const auto bound = hn::Mul(hn::Set(d, 3.0f), hn::Abs(delta));
    const auto limit = [&](Floats slope) HWY_ATTR {
        const auto size = hn::CopySign(hn::Min(hn::Abs(slope), bound), delta);
        return hn::IfThenElse(hn::Gt(hn::Mul(slope, delta), zero), size, zero);
    };
    const auto d1 = limit(hn::Mul(half, hn::Sub(f2, f0))),
               d2 = limit(hn::Mul(half, hn::Sub(f3, f1)));
    const auto two = hn::Set(d, 2.0f);
    const auto a3 = hn::Sub(hn::Add(d1, d2), hn::Mul(two, delta));
    const auto a2 = hn::Sub(hn::Sub(hn::Mul(hn::Set(d, 3.0f), delta), hn::Mul(two, d1)), d2);
    return hn::MulAdd(hn::MulAdd(hn::MulAdd(a3, t, a2), t, d1), t, f1);
}

template <int Dim>
HWY_INLINE Floats cubic(const AdvectGeometry& g, const float* p, const Stencil& s) {
    const std::ptrdiff_t sy = g.size.x, sz = sy * g.size.y;
    const auto plane = [&](const float* q) HWY_ATTR {
        Floats rows[4], f[4];
        for (int j = 0; j < 4; ++j) {
            load_rows<4>(q + sy * (j - 1) - 1, s.base, f);
            rows[j] = monotone(f[0], f[1], f[2], f[3], s.fx);
        }
        return monotone(rows[0], rows[1], rows[2], rows[3], s.fy);
    };
    if constexpr (Dim == 2) {
        return plane(p);
    } else {
        Floats planes[4];
        for (int k = 0; k < 4; ++k) planes[k] = plane(p + sz * (k - 1));
        return monotone(planes[0], planes[1], planes[2], planes[3], s.fz);
    }
}

// The four weights of Lagrange's polynomial through points -1, 0, 1, 2.
struct CubicWeights {
    Floats w[4];
};

HWY_INLINE CubicWeights cubic_weights(Floats t) {
    const Tag d;
    const auto one = hn::Set(d, 1.0f), sixth = hn::Set(d, 1.0f / 6), half = hn::Set(d, 0.5f);
    const auto up = hn::Add(t, one), down = hn::Sub(t, one), far = hn::Sub(down, one);
    return {{hn::Neg(hn::Mul(hn::Mul(t, sixth), hn::Mul(down, far))),
             hn::Mul(hn::Mul(up, half), hn::Mul(down, far)),
             hn::Neg(hn::Mul(hn::Mul(up, half), hn::Mul(t, far))),
             hn::Mul(hn::Mul(up, sixth), hn::Mul(t, down))}};
}

HWY_INLINE Floats weighed(const CubicWeights& w, const Floats* f) {
    return hn::MulAdd(w.w[3], f[3],
                      hn::MulAdd(w.w[2], f[2], hn::MulAdd(w.w[1], f[1], hn::Mul(w.w[0], f[0]))));
}

template <int Dim>
HWY_INLINE Floats lagrange(const AdvectGeometry& g, const float* p, const Stencil& s) {
    const std::ptrdiff_t sy = g.size.x, sz = sy * g.size.y;
    const CubicWeights wx = cubic_weights(s.fx), wy = cubic_weights(s.fy);
    const auto plane = [&](const float* q) HWY_ATTR {
        Floats rows[4], f[4];
        for (int j = 0; j < 4; ++j) {
            load_rows<4>(q + sy * (j - 1) - 1, s.base, f);
            rows[j] = weighed(wx, f);
        }
        return weighed(wy, rows);
    };
    if constexpr (Dim == 2) {
        return plane(p);
    } else {
        Floats planes[4];
        for (int k = 0; k < 4; ++k) planes[k] = plane(p + sz * (k - 1));
        return weighed(cubic_weights(s.fz), planes);
    }
}

// Velocity at the points themselves: means of the nearest faces.
template <int Dim>
HWY_INLINE Positions velocity_at_points(const AdvectGeometry& g, std::ptrdiff_t at) {
    const Tag d;
    const std::ptrdiff_t stride[3] = {1, g.size.x,
                                      static_cast<std::ptrdiff_t>(g.size.x) * g.size.y};
    Floats v[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int a = 0; a < Dim; ++a) {
        const float* u = g.velocity[static_cast<std::size_t>(a)] + at;
        if (a == g.face_axis) {
            v[a] = hn::LoadU(d, u);
        } else {
            v[a] = hn::Add(hn::LoadU(d, u), hn::LoadU(d, u + stride[a]));
            if (g.face_axis < 0) {
                v[a] = hn::Mul(hn::Set(d, 0.5f), v[a]);
            } else {
                const float* w = u - stride[g.face_axis];
                v[a] = hn::Add(v[a], hn::Add(hn::LoadU(d, w), hn::LoadU(d, w + stride[a])));
                v[a] = hn::Mul(hn::Set(d, 0.25f), v[a]);
            }
        }
    }
    return {v[0], v[1], v[2]};
}

template <int Dim>
HWY_INLINE Positions velocity_at(const AdvectGeometry& g, const Positions& p) {
    Positions v{linear<Dim>(g, g.velocity[0], locate<Dim>(g, p, 0, 0)),
                linear<Dim>(g, g.velocity[1], locate<Dim>(g, p, 1, 0)), hn::Zero(Tag())};
    if constexpr (Dim == 3) v.z = linear<Dim>(g, g.velocity[2], locate<Dim>(g, p, 2, 0));
    return v;
}

HWY_INLINE Positions moved(const Positions& p, const Positions& v, float time) {
    const auto t = hn::Set(Tag(), time);
    return {hn::MulAdd(v.x, t, p.x), hn::MulAdd(v.y, t, p.y), hn::MulAdd(v.z, t, p.z)};
}

// Where the fluid at `start` is after `time` (in s/m times h, negative: where it came from).
template <int Dim, Interpolation Kind>
HWY_INLINE Positions trace(const AdvectGeometry& g, const Positions& start, const Positions& v,
                           float time) {
    const Positions middle = velocity_at<Dim>(g, moved(start, v, 0.5f * time));
    if constexpr (Kind == Interpolation::Cubic) {
        const Positions late = velocity_at<Dim>(g, moved(start, middle, 0.75f * time));
        return moved(moved(moved(start, v, time * 2 / 9), middle, time / 3), late, time * 4 / 9);
    } else {
        return moved(start, middle, time);
    }
}

template <int Dim, Interpolation Kind>
HWY_INLINE Floats interpolate(const AdvectGeometry& g, const float* p, const Stencil& s) {
    if constexpr (Kind == Interpolation::Linear) {
        return linear<Dim>(g, p, s);
    } else if constexpr (Kind == Interpolation::MonotoneCubic) {
        return cubic<Dim>(g, p, s);
    } else {
        return lagrange<Dim>(g, p, s);
    }
}

// Brings a value into the range of the corners around the origin.
template <int Dim>
HWY_INLINE Floats limited(const AdvectGeometry& g, const float* p, const Stencil& origin,
                          Floats value) {
    const Corners<Dim> c = load_corners<Dim>(g, p, origin);
    auto low = c.v[0], high = c.v[0];
    for (int i = 1; i < (Dim == 2 ? 4 : 8); ++i) {
        low = hn::Min(low, c.v[i]);
        high = hn::Max(high, c.v[i]);
    }
    return hn::Min(hn::Max(value, low), high);
}

// Predicted value plus half the error of the way back, kept inside the range of the corners.
template <int Dim, Interpolation Kind>
HWY_INLINE Floats corrected(const AdvectGeometry& g, const AdvectedBlock& q, std::ptrdiff_t at,
                            const Stencil& origin, const Stencil& target) {
    const Tag d;
    const auto error =
        hn::Sub(hn::LoadU(d, q.before + at), interpolate<Dim, Kind>(g, q.predicted, target));
    const auto value = hn::MulAdd(hn::Set(d, 0.5f), error, hn::LoadU(d, q.predicted + at));
    return limited<Dim>(g, q.before, origin, value);
}

template <int Dim, Interpolation Kind>
HWY_INLINE Floats carried_along(const AdvectGeometry& g, const AdvectedBlock& q,
                                const Stencil& origin) {
    const Floats value = interpolate<Dim, Kind>(g, q.before, origin);
    if constexpr (Kind == Interpolation::Cubic) {
        if (q.limited) return limited<Dim>(g, q.before, origin, value);
    }
    return value;
}

HWY_INLINE void store(const AdvectedBlock& q, std::ptrdiff_t to, Floats value) {
    const Tag d;
    value = hn::Mul(value, hn::Set(d, q.factor));
    const auto keep = hn::Ge(hn::Abs(value), hn::Set(d, q.floor));
    hn::StoreU(hn::IfThenElseZero(keep, value), d, q.out + to);
}

template <int Dim, Interpolation Kind>
void advect(const AdvectGeometry& g, std::span<const AdvectedBlock> quantities) {
    const Tag d;
    const int margin = Kind == Interpolation::Linear ? 0 : 1;
    const std::ptrdiff_t sy = g.size.x, sz = sy * g.size.y;
    bool corrects = false;
    for (const AdvectedBlock& q : quantities) corrects |= q.predicted != nullptr;
    const auto shift = [&](int axis) { return axis == g.face_axis ? -0.5f : 0.0f; };
    for (int k = 0; k < g.count.z; ++k) {
        for (int j = 0; j < g.count.y; ++j) {
            for (int i = 0; i < g.count.x; i += static_cast<int>(hn::Lanes(d))) {
                const Vec3i c = g.first + Vec3i(i, j, k);
                const std::ptrdiff_t at = c.x + sy * c.y + sz * c.z;
                const Positions start{hn::Iota(d, static_cast<float>(c.x) + shift(0)),
                                      hn::Set(d, static_cast<float>(c.y) + shift(1)),
                                      hn::Set(d, static_cast<float>(c.z) + shift(2))};
                const Positions v = velocity_at_points<Dim>(g, at);
                const Stencil origin = locate<Dim>(g, trace<Dim, Kind>(g, start, v, -g.dt_over_h),
                                                   g.face_axis, margin);
                Stencil target = origin;
                if (corrects) {
                    target = locate<Dim>(g, trace<Dim, Kind>(g, start, v, g.dt_over_h), g.face_axis,
                                         margin);
                }
                const std::ptrdiff_t to = i + g.out_stride_y * j + g.out_stride_z * k;
                for (const AdvectedBlock& q : quantities) {
                    store(q, to,
                          q.predicted ? corrected<Dim, Kind>(g, q, at, origin, target)
                                      : carried_along<Dim, Kind>(g, q, origin));
                }
            }
        }
    }
}

template <int Dim>
void advect_by(const AdvectGeometry& g, std::span<const AdvectedBlock> quantities) {
    switch (g.interpolation) {
        case Interpolation::Linear:
            return advect<Dim, Interpolation::Linear>(g, quantities);
        case Interpolation::MonotoneCubic:
            return advect<Dim, Interpolation::MonotoneCubic>(g, quantities);
        case Interpolation::Cubic:
            return advect<Dim, Interpolation::Cubic>(g, quantities);
    }
}

void advect_2d_or_3d(const AdvectGeometry& g, std::span<const AdvectedBlock> quantities) {
    if (g.is_2d) {
        advect_by<2>(g, quantities);
    } else {
        advect_by<3>(g, quantities);
    }
}

}  // namespace gischt::advection::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {
namespace advection {

HWY_EXPORT(advect_2d_or_3d);

static void dispatch(const AdvectGeometry& geometry, std::span<const AdvectedBlock> quantities) {
    HWY_DYNAMIC_DISPATCH(advect_2d_or_3d)(geometry, quantities);
}

}  // namespace advection

void advect_block(const AdvectGeometry& geometry, std::span<const AdvectedBlock> quantities) {
    advection::dispatch(geometry, quantities);
}

}  // namespace gischt
#endif
