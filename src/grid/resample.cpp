// SPDX-License-Identifier: Apache-2.0
#include "grid/resample.h"

#include "base/parallel.h"
#include "grid/brick_volume.h"

namespace gischt {

Field resample(const Field& source, int axis, const Transform& to_world, Job& job) {
    const BrickVolume volume(source, {.axis = axis}, job);
    Field out;
    out.background[0] = volume.background();
    out.to_world = to_world;
    out.kind = source.kind;

    // Tiles of the target that may see a value.
    const Transform inverse = to_world.inverse();
    const Vec3i low = floor(Vec3d(volume.support().lo)), high = volume.support().hi;
    const Box3d box = (inverse * volume.to_world()).bounds({Vec3d(low), Vec3d(high)});
    const Box3i cells{floor(box.lo), floor(box.hi) + Vec3i(1)};
    std::vector<Vec3i> tiles;
    const Vec3i first = tile_shape_3d.tile_of(cells.lo),
                last = tile_shape_3d.tile_of(cells.hi - Vec3i(1));
    for (int z = first.z; volume.size() > 0 && z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) tiles.emplace_back(x, y, z);
        }
    }
    out.component.emplace_back(TileMap::sparse(std::move(tiles), cells), volume.background());

    const TileMap& map = out.map();
    const Transform to_lattice = volume.to_lattice() * to_world;
    parallel_for(map.size(), 4, [&](int t) {
        job.check();
        float* values = out.component[0].tile(t);
        for (int i = 0; i < tile_values; ++i) {
            const Vec3i cell = map.first_cell(t) + map.shape().cell(i);
            values[i] = volume.at(to_lattice.point(Vec3d(cell) + Vec3d(0.5)));
        }
    });
    return out;
}

}  // namespace gischt
