// SPDX-License-Identifier: Apache-2.0
#include "render/billboards/billboards_params.h"

#include <cmath>

namespace gischt {

const Table<BillboardsParams>& billboards_table() {
    using P = BillboardsParams;
    static const Table<P> table =
        Table<P>("billboards", "Particles as pictures on squares, drawn by OpenGL")
            .choice("facing", &P::facing,
                    {{"camera", BillboardFacing::Camera,
                      "their normals are parallel to the view direction (eq. 3)"},
                     {"velocity", BillboardFacing::Velocity, "one edge along their motion"},
                     {"fixed", BillboardFacing::Fixed, "all across 'normal'"}},
                    {.help = "How the squares are turned"})
            .add("normal", &P::normal, {.help = "Of the squares with facing 'fixed'"})
            .add("size", &P::size,
                 {.help = "Half an edge, in radii of the particle", .min = 0.01, .max = 1000})
            .add("stretch", &P::stretch,
                 {.unit = "s",
                  .help = "With facing 'velocity': half of the way of this time is added to half "
                          "the length",
                  .min = 0})
            .add("spin", &P::spin, {.help = "Each is turned by an angle of its own"})
            .add("soft_fade", &P::soft_fade,
                 {.unit = "radii",
                  .help = "Distance before a surface over which they fade; 0 cuts them",
                  .min = 0})
            .choice("sprite", &P::sprite,
                    {{"soft", SpriteKind::Soft, "a disc that fades to its edge"},
                     {"puff", SpriteKind::Puff, "four puffs of smoke made of noise"},
                     {"disc", SpriteKind::Disc, "a sharp disc"}},
                    {.help = "The picture, if there is no file"})
            .add("file", &P::file,
                 {.help = "A picture with alpha, or a sheet of pictures, which multiplies the "
                          "particle's colour"})
            .add("sheet", &P::sheet,
                 {.help = "Columns and rows of pictures in the file", .min = 1, .max = 64})
            .choice("play", &P::play,
                    {{"life", FlipbookPlay::Life, "from the first to the last over age / life"},
                     {"random", FlipbookPlay::Random, "each particle keeps one"}},
                    {.help = "Which picture of a sheet is shown"})
            .flat(&P::draw, particle_draw_table())
            .check([](const P& p, const Fail& fail) {
                if (!(length(p.normal) > 0)) fail("normal", "has no length");
                if (p.sheet.x != std::floor(p.sheet.x) || p.sheet.y != std::floor(p.sheet.y)) {
                    fail("sheet", "counts columns and rows");
                }
            });
    return table;
}

}  // namespace gischt
