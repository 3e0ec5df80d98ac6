// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "math/vec.h"

namespace gischt {

// Relative luminance of linear Rec.709 (ITU-R BT.709-6, item 3.2).
template <class T>
constexpr T luminance(const Vec3<T>& rgb) {
    return T(0.2126) * rgb.x + T(0.7152) * rgb.y + T(0.0722) * rgb.z;
}

// Transfer function of sRGB (IEC 61966-2-1), display-linear to encoded, odd around 0.
inline float srgb_encode(float linear) {
    const float a = std::abs(linear);
    const float e = a <= 0.0031308f ? 12.92f * a : 1.055f * std::pow(a, 1 / 2.4f) - 0.055f;
    return std::copysign(e, linear);
}
// Its inverse. The thresholds are the standard's rounded ones; the step there is below 1e-7.
inline float srgb_decode(float encoded) {
    const float a = std::abs(encoded);
    const float l = a <= 0.04045f ? a / 12.92f : std::pow((a + 0.055f) / 1.055f, 2.4f);
    return std::copysign(l, encoded);
}

// Factor on radiance for an exposure in stops: 2^ev.
inline float exposure_factor(double ev) {
    return static_cast<float>(std::exp2(ev));
}

// CIE 1931 XYZ with Y of white being 1, to and from linear Rec.709 with white D65 (x, y) =
// (0.3127, 0.3290); derived from the primaries of ITU-R BT.709-6 as in SMPTE RP 177.
constexpr Vec3d xyz_to_rec709(const Vec3d& c) {
    return {3.2409699419045226 * c.x - 1.5373831775700940 * c.y - 0.4986107602930034 * c.z,
            -0.9692436362808796 * c.x + 1.8759675015077204 * c.y + 0.0415550574071756 * c.z,
            0.0556300796969936 * c.x - 0.2039769588889765 * c.y + 1.0569715142428784 * c.z};
}
constexpr Vec3d rec709_to_xyz(const Vec3d& c) {
    return {0.4123907992659595 * c.x + 0.3575843393838780 * c.y + 0.1804807884018343 * c.z,
            0.2126390058715104 * c.x + 0.7151686787677559 * c.y + 0.0721923153607337 * c.z,
            0.0193308187155918 * c.x + 0.1191947797946260 * c.y + 0.9505321522496608 * c.z};
}

}  // namespace gischt
