// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_grid.h"

#include <algorithm>

#include "base/parallel.h"

namespace gischt {

// out(c) = (in(c) + in(c + e_axis)) / 2, tile by tile: only the upper layer of cells asks the
// neighbour.
static TileField<float> average_up(const TileField<float>& in, int axis, float background) {
    const TileMap& map = in.map();
    const TileShape& shape = map.shape();
    const Vec3i n = shape.extent();
    TileField<float> out(in.map_ptr());
    parallel_for(map.size(), 16, [&](int t) {
        const int up = map.neighbour(t, axis == 0, axis == 1, axis == 2);
        const float* own = in.tile(t);
        const float* next = up < 0 ? nullptr : in.tile(up);
        float* to = out.tile(t);
        for (int m = 0; m < tile_values; ++m) {
            Vec3i c = shape.cell(m);
            float upper = background;
            if (++c[axis] < n[axis]) {
                upper = own[shape.index(c.x, c.y, c.z)];
            } else if (next) {
                c[axis] = 0;
                upper = next[shape.index(c.x, c.y, c.z)];
            }
            to[m] = 0.5f * (own[m] + upper);
        }
    });
    return out;
}

void center_components(Field& field) {
    for (int a = 0; a < static_cast<int>(field.component.size()); ++a) {
        const auto i = static_cast<std::size_t>(a);
        field.component[i] = average_up(field.component[i], a, field.background[i]);
    }
}

void shift_half_voxel(Field& field) {
    field.to_world.translation = field.to_world.point(Vec3d(0.5));
}

// The difference b - a of two translations in cells of a, or nothing when the axes differ.
static bool offset_in_cells(const Transform& a, const Transform& b, Vec3d& offset) {
    const double size = length(a.column[0]) + length(a.column[1]) + length(a.column[2]);
    for (std::size_t c = 0; c < 3; ++c) {
        if (length(a.column[c] - b.column[c]) > 1e-6 * size) return false;
    }
    offset = a.inverse().vector(b.translation - a.translation);
    return true;
}

static bool is_near(const Vec3d& a, const Vec3d& b) {
    return max_component(abs(a - b)) < 1e-3;
}

// Copies a field to a map that has all of its tiles.
static TileField<float> copy_to(const TileMap::Ptr& map, const Field& from) {
    TileField<float> out(map, from.background[0]);
    const TileField<float>& in = from.component[0];
    parallel_for(from.map().size(), 64, [&](int t) {
        std::copy_n(in.tile(t), tile_values, out.tile(map->find(from.map().coord(t))));
    });
    return out;
}

std::optional<Field> merge_components(const std::array<const Field*, 3>& components) {
    // Place: all alike, or faces: the transform of component a is half a cell low along axis a.
    Vec3d dy, dz;
    const bool alike = offset_in_cells(components[0]->to_world, components[1]->to_world, dy) &&
                       offset_in_cells(components[0]->to_world, components[2]->to_world, dz);
    const bool centered = alike && is_near(dy, {}) && is_near(dz, {});
    const bool faces = alike && is_near(dy, {0.5, -0.5, 0}) && is_near(dz, {0.5, 0, -0.5});
    if (!centered && !faces) return std::nullopt;

    std::vector<Vec3i> tiles;
    Box3i bounds = Box3i::empty();
    for (const Field* f : components) {
        if (f->map().shape() != components[0]->map().shape()) return std::nullopt;
        for (int t = 0; t < f->map().size(); ++t) tiles.push_back(f->map().coord(t));
        if (f->map().size() > 0) bounds.extend(f->map().bounds());
    }
    if (tiles.empty()) bounds = {};
    if (faces) bounds.lo -= Vec3i(1);  // whose upper faces may hold values
    const auto map = TileMap::sparse(std::move(tiles), bounds, components[0]->map().shape());
    Field out;
    out.kind = components[0]->kind;
    out.to_world = components[0]->to_world;
    for (std::size_t a = 0; a < 3; ++a) {
        out.component.push_back(copy_to(map, *components[a]));
        out.background[a] = components[a]->background[0];
    }
    if (faces) {
        out.to_world.translation += 0.5 * out.to_world.column[0];
        center_components(out);
    }
    return out;
}

}  // namespace gischt
