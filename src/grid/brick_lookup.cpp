// SPDX-License-Identifier: Apache-2.0
// The look-up of many points of one brick, compiled once per instruction set.
#include "grid/brick_volume.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grid/brick_lookup.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gischt {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

constexpr int row = BrickVolume::row;

// Cell and fraction of a local coordinate, clamped to [0,8].
struct Split {
    VI cell;
    VF fraction;
};
HWY_INLINE Split split(VF local) {
    const F f;
    const I i;
    const VF inside =
        hn::Min(hn::Max(local, hn::Zero(f)), hn::Set(f, float{BrickVolume::brick_edge}));
    const VI cell = hn::Min(hn::ConvertTo(i, inside), hn::Set(i, BrickVolume::brick_edge - 1));
    return {cell, hn::Sub(inside, hn::ConvertTo(f, cell))};
}

HWY_INLINE VF mix(VF a, VF b, VF t) {
    return hn::MulAdd(hn::Sub(b, a), t, a);
}

// The samples at index and index + 1, interpolated: one gather of two codes, or two of floats.
HWY_INLINE VF pair(const std::uint16_t* base, VI index, VF t) {
    const F f;
    const I i;
    const VI both =
        hn::GatherOffset(i, reinterpret_cast<const std::int32_t*>(base), hn::ShiftLeft<1>(index));
    const VF low = hn::ConvertTo(f, hn::And(both, hn::Set(i, 0xffff)));
    const hn::RebindToUnsigned<F> u;
    const VF high = hn::ConvertTo(f, hn::BitCast(i, hn::ShiftRight<16>(hn::BitCast(u, both))));
    return mix(low, high, t);
}
HWY_INLINE VF pair(const float* base, VI index, VF t) {
    const F f;
    return mix(hn::GatherIndex(f, base, index), hn::GatherIndex(f, base + 1, index), t);
}

template <class T>
HWY_INLINE VF trilinear(const T* base, VF x, VF y, VF z) {
    const I i;
    const Split sx = split(x), sy = split(y), sz = split(z);
    const VI rows = hn::Add(sy.cell, hn::Mul(sz.cell, hn::Set(i, row)));
    const VI index = hn::Add(sx.cell, hn::Mul(rows, hn::Set(i, row)));
    const VF near =
        mix(pair(base, index, sx.fraction), pair(base + row, index, sx.fraction), sy.fraction);
    base += row * row;
    const VF far =
        mix(pair(base, index, sx.fraction), pair(base + row, index, sx.fraction), sy.fraction);
    return mix(near, far, sz.fraction);
}

template <class T>
HWY_INLINE void along(const T* base, const BrickLine& line, float* HWY_RESTRICT out) {
    const F f;
    const std::size_t lanes = hn::Lanes(f), n = static_cast<std::size_t>(line.count);
    const VF ex = hn::Set(f, line.entry.x), ey = hn::Set(f, line.entry.y),
             ez = hn::Set(f, line.entry.z);
    const VF sx = hn::Set(f, line.step.x), sy = hn::Set(f, line.step.y),
             sz = hn::Set(f, line.step.z);
    const VF offset = hn::Set(f, line.offset), scale = hn::Set(f, line.scale);
    for (std::size_t at = 0; at < n; at += lanes) {
        const auto mask = hn::FirstN(f, n - at);
        const VF t = hn::MaskedLoad(mask, f, line.t + at);
        const VF v =
            trilinear(base, hn::MulAdd(t, sx, ex), hn::MulAdd(t, sy, ey), hn::MulAdd(t, sz, ez));
        hn::BlendedStore(hn::MulAdd(v, scale, offset), mask, f, out + at);
    }
}

void along_compact(const std::uint16_t* base, const BrickLine& line, float* out) {
    along(base, line, out);
}
void along_full(const float* base, const BrickLine& line, float* out) {
    along(base, line, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace gischt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gischt {

HWY_EXPORT(along_compact);
HWY_EXPORT(along_full);

void BrickVolume::along(int brick, const Vec3f& entry, const Vec3f& step, const float* t, int n,
                        float* out) const {
    const auto b = static_cast<std::size_t>(brick);
    const std::size_t first = b * samples;
    if (is_compact()) {
        const BrickLine line{entry, step, decode_[b].x, decode_[b].y, t, n};
        HWY_DYNAMIC_DISPATCH(along_compact)(compact_.data() + first, line, out);
    } else {
        HWY_DYNAMIC_DISPATCH(along_full)(full_.data() + first, {entry, step, 0, 1, t, n}, out);
    }
}

}  // namespace gischt
#endif
