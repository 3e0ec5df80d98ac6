// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "image/image.h"
#include "render/realtime/particle_stage.h"

namespace gischt {

enum class BillboardFacing { Camera, Velocity, Fixed };
enum class SpriteKind { Soft, Puff, Disc };
enum class FlipbookPlay { Life, Random };

// The parameters of the billboards.
struct BillboardsParams {
    ParticleDrawParams draw;
    BillboardFacing facing = BillboardFacing::Camera;
    Vec3d normal{0, -1, 0};  // of fixed ones
    double size = 1;         // half an edge, in radii of the particle
    double stretch = 0.02;   // s: facing the velocity, that much of the way is added to the length
    bool spin = true;        // each turned by an angle of its own; not those along the velocity
    double soft_fade = 1;    // radii over which they fade before a surface; 0: cut

    SpriteKind sprite = SpriteKind::Puff;
    std::string file;   // a picture, or a sheet of them, in place of that
    Vec2d sheet{1, 1};  // columns, rows
    FlipbookPlay play = FlipbookPlay::Life;
    // What `file` holds; who reads scenes fills it in, since files are read above this room.
    std::shared_ptr<const Image> picture;
};

const Table<BillboardsParams>& billboards_table();

}  // namespace gischt
