// SPDX-License-Identifier: Apache-2.0
#include "image/colormap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "image/color.h"
#include "image/draw.h"

namespace gischt {
namespace {

// sRGB codes at t = k / 32; between them the codes are interpolated linearly.
using Table = std::array<std::uint32_t, 33>;

// clang-format off
constexpr Table viridis{
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453781, 0x424086, 0x3e4989,
    0x3b528b, 0x375b8d, 0x33638d, 0x2f6b8e, 0x2c728e, 0x297a8e, 0x26828e, 0x23898e,
    0x21908c, 0x1f978b, 0x1f9f88, 0x21a685, 0x27ad81, 0x31b57b, 0x3ebc74, 0x4dc26c,
    0x5cc863, 0x6ece58, 0x82d34d, 0x95d840, 0xaadc32, 0xc0df25, 0xd5e21a, 0xeae51a,
    0xfde725};
constexpr Table magma{
    0x000004, 0x030312, 0x0a0822, 0x130d34, 0x1d1147, 0x29115a, 0x36106b, 0x440f76,
    0x50127c, 0x5d177f, 0x691c81, 0x762181, 0x822681, 0x8f2a81, 0x9c2e7f, 0xa9337d,
    0xb6367a, 0xc33b75, 0xcf4070, 0xdb476a, 0xe65164, 0xee5c5e, 0xf46a5c, 0xf9785d,
    0xfb8861, 0xfd9668, 0xfea571, 0xfeb47b, 0xfec287, 0xfed194, 0xfde0a1, 0xfceeb0,
    0xfcfdbf};
constexpr Table inferno{
    0x000004, 0x040312, 0x0b0724, 0x150b37, 0x210c4a, 0x2f0a5b, 0x3d0965, 0x4a0c6b,
    0x56106e, 0x63156e, 0x70196e, 0x7d1e6d, 0x89226a, 0x962766, 0xa32c61, 0xaf315b,
    0xbb3654, 0xc63d4d, 0xd14545, 0xda4f3c, 0xe35932, 0xeb6529, 0xf1721e, 0xf67f14,
    0xf98c0a, 0xfb9b06, 0xfcaa0f, 0xfbba1f, 0xf9c932, 0xf5d949, 0xf2e865, 0xf3f586,
    0xfcffa4};
constexpr Table coolwarm{
    0x3b4cc0, 0x445acc, 0x4e68d7, 0x5875e1, 0x6282ea, 0x6c8ef1, 0x779af7, 0x82a5fb,
    0x8db0fe, 0x98b9ff, 0xa3c2ff, 0xaec9fd, 0xb8d0f9, 0xc2d5f4, 0xccd9ee, 0xd5dbe6,
    0xdddddd, 0xe5d8d1, 0xecd3c6, 0xf1ccb9, 0xf5c4ad, 0xf7bba0, 0xf7b194, 0xf7a687,
    0xf49a7b, 0xf18d6f, 0xec7f63, 0xe57057, 0xde614c, 0xd55042, 0xcb3e38, 0xc0282f,
    0xb40426};
// clang-format on

Vec3f unpack(std::uint32_t code) {
    return Vec3f(static_cast<float>(code >> 16), static_cast<float>(code >> 8 & 0xff),
                 static_cast<float>(code & 0xff)) /
           255.0f;
}

Vec3f look_up(const Table& table, float t) {
    const float x = t * static_cast<float>(table.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(x), table.size() - 2);
    const Vec3f lo = unpack(table[k]), hi = unpack(table[k + 1]);
    return lo + (x - static_cast<float>(k)) * (hi - lo);
}

Vec3f encoded(ColormapKind kind, float t) {
    switch (kind) {
        case ColormapKind::Viridis:
            return look_up(viridis, t);
        case ColormapKind::Magma:
            return look_up(magma, t);
        case ColormapKind::Inferno:
            return look_up(inferno, t);
        case ColormapKind::Coolwarm:
            return look_up(coolwarm, t);
        case ColormapKind::Grey:
            break;
    }
    return Vec3f(t);
}

}  // namespace

const std::vector<std::string>& colormap_names() {
    static const std::vector<std::string> names{"viridis", "magma", "inferno", "coolwarm", "grey"};
    return names;
}

ColormapKind colormap_kind(std::string_view name) {
    for (std::size_t i = 0; i < colormap_names().size(); ++i) {
        if (colormap_names()[i] == name) return static_cast<ColormapKind>(i);
    }
    throw Error(ErrorKind::Usage, "colormap", fmt::format("unknown color map '{}'", name),
                hint_for(name, colormap_names()));
}

Vec3f colormap(ColormapKind kind, float t) {
    if (std::isnan(t)) return {1, 0, 1};
    const Vec3f c = encoded(kind, std::clamp(t, 0.0f, 1.0f));
    return {srgb_decode(c.x), srgb_decode(c.y), srgb_decode(c.z)};
}

void draw_colormap(Image& image, Vec2i at, Vec2i size, ColormapKind kind) {
    const bool upright = size.y > size.x;
    const int steps = upright ? size.y : size.x;
    for (int i = 0; i < steps; ++i) {
        const float t = steps > 1 ? static_cast<float>(i) / static_cast<float>(steps - 1) : 0;
        const Vec3f color = colormap(kind, t);
        if (upright) {
            fill_rectangle(image, {at.x, at.y + steps - 1 - i}, {size.x, 1}, color);
        } else {
            fill_rectangle(image, {at.x + i, at.y}, {1, size.y}, color);
        }
    }
}

}  // namespace gischt
