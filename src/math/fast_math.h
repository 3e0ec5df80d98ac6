// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace gischt {

// exp(x) within 2e-7 of its value for x in [-87, 88], clamped beyond; no branch and no call, so
// that loops over it vectorize. Range reduction and polynomial of Cephes (Moshier 1989).
inline float fast_exp(float x) {
    x = x < -87.0f ? -87.0f : x > 88.0f ? 88.0f : x;
    const float scaled = x * 1.44269504f;
    const auto n = static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5f : 0.5f));
    const auto f = static_cast<float>(n);
    const float r = (x - f * 0.693359375f) + f * 2.12194440e-4f;
    float p = 1.9875691500e-4f;
    p = p * r + 1.3981999507e-3f;
    p = p * r + 8.3334519073e-3f;
    p = p * r + 4.1665795894e-2f;
    p = p * r + 1.6666665459e-1f;
    p = p * r + 5.0000001201e-1f;
    p = p * r * r + r + 1.0f;
    return p * std::bit_cast<float>((n + 127) << 23);
}

// Natural logarithm within 2e-7 (absolute near 1, relative elsewhere) for positive normal x; the
// same kind of code.
inline float fast_log(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    // Exponent such that the mantissa lies in [sqrt(1/2), sqrt(2)).
    const std::int32_t e = (bits - 0x3f3504f3) >> 23;
    const float m = std::bit_cast<float>(bits - (e << 23)) - 1.0f;
    const auto n = static_cast<float>(e);
    float p = 7.0376836292e-2f;
    p = p * m - 1.1514610310e-1f;
    p = p * m + 1.1676998740e-1f;
    p = p * m - 1.2420140846e-1f;
    p = p * m + 1.4249322787e-1f;
    p = p * m - 1.6668057665e-1f;
    p = p * m + 2.0000714765e-1f;
    p = p * m - 2.4999993993e-1f;
    p = p * m + 3.3333331174e-1f;
    const float z = m * m;
    return m + (p * m * z - n * 2.12194440e-4f - 0.5f * z) + n * 0.693359375f;
}

}  // namespace gischt
