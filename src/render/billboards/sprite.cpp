// SPDX-License-Identifier: Apache-2.0
#include "render/billboards/sprite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/noise.h"

namespace gischt {
namespace {

constexpr int edge = 64;  // pixels of a picture that is made here

// Falls smoothly from 1 at 0 to 0 at 1.
double falloff(double r) {
    const double x = std::clamp(1 - r * r, 0.0, 1.0);
    return x * x;
}

double alpha_of(SpriteKind kind, double x, double y, int picture) {
    const double r = std::sqrt(x * x + y * y);
    switch (kind) {
        case SpriteKind::Disc:
            return std::clamp((0.95 - r) * 0.5 * edge + 0.5, 0.0, 1.0);
        case SpriteKind::Soft:
            return falloff(r);
        case SpriteKind::Puff: {
            // A soft disc whose rim and inside are frayed by noise.
            const Vec3d p(1.7 * x, 1.7 * y, 7.3 * picture);
            const auto n = static_cast<double>(fractal_noise(p, 4, 0.55f, 11));
            return std::min(1.0, falloff(std::min(1.0, r + 0.1)) *
                                     std::clamp(1.15 + 1.3 * n - 0.45 * r, 0.0, 1.5));
        }
    }
    return 0;
}

SpriteSheet generated(SpriteKind kind) {
    SpriteSheet sheet;
    sheet.width = sheet.height = edge;
    sheet.count = kind == SpriteKind::Puff ? 4 : 1;
    sheet.is_round = sheet.is_white = true;
    for (int i = 0; i < sheet.count; ++i) {
        for (int y = 0; y < edge; ++y) {
            for (int x = 0; x < edge; ++x) {
                const double u = (x + 0.5) * 2 / edge - 1, v = (y + 0.5) * 2 / edge - 1;
                sheet.texels.push_back(static_cast<float>(alpha_of(kind, u, v, i)));
            }
        }
    }
    return sheet;
}

// Images are premultiplied and run from top to bottom; a sheet is read row by row from its top.
SpriteSheet cut_out(const Image& image, int columns, int rows, FlipbookPlay play) {
    if (image.width % columns != 0 || image.height % rows != 0) {
        throw Error(ErrorKind::Input, "billboards",
                    fmt::format("the sheet of {}x{} pixels is not {}x{} equal pictures",
                                image.width, image.height, columns, rows),
                    "set render.billboards.sheet to its columns and rows");
    }
    SpriteSheet sheet;
    sheet.width = image.width / columns;
    sheet.height = image.height / rows;
    sheet.count = columns * rows;
    sheet.is_sequence = play == FlipbookPlay::Life;
    const auto color = image.color();
    const Channel* alpha = image.find("A");
    for (int i = 0; i < sheet.count; ++i) {
        for (int y = 0; y < sheet.height; ++y) {
            for (int x = 0; x < sheet.width; ++x) {
                const std::size_t at =
                    image.index(i % columns * sheet.width + x,
                                i / columns * sheet.height + sheet.height - 1 - y);
                const float a = alpha ? alpha->values[at] : 1;
                for (const auto& plane : color) {
                    sheet.texels.push_back(a > 0 ? plane[at] / a : 0);
                }
                sheet.texels.push_back(a);
            }
        }
    }
    return sheet;
}

}  // namespace

SpriteSheet make_sprites(const BillboardsParams& params) {
    if (params.file.empty() && !params.picture) return generated(params.sprite);
    if (!params.picture) {
        throw Error(ErrorKind::Usage, "billboards", "'" + params.file + "' was not read",
                    "pictures are read with the scene");
    }
    return cut_out(*params.picture, static_cast<int>(params.sheet.x),
                   static_cast<int>(params.sheet.y), params.play);
}

}  // namespace gischt
