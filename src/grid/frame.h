// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "grid/field.h"
#include "grid/particles.h"
#include "math/transform.h"

namespace gischt {

enum class FieldClass { FogVolume, LevelSet, Unknown };

// One named quantity of a frame on its own sparse grid. Cell (i,j,k) has its centre at
// to_world.point(i+1/2, j+1/2, k+1/2) (metres); outside the tiles the value is `background`. One
// component, or three for a vector (cell-centred).
struct Field {
    std::vector<TileField<float>> component;  // 1 or 3, all on one TileMap
    std::array<float, 3> background{};
    Transform to_world;  // from cells to metres
    FieldClass kind = FieldClass::FogVolume;

    const TileMap& map() const { return component.front().map(); }
    bool is_vector() const { return component.size() == 3; }
    // Edge of a cell in metres, the largest of the three.
    double cell_size() const;
    // Box around all cells that may hold values, in metres.
    Box3d world_bounds() const;
    // Trilinear interpolation at a point in metres; slow, for probes and tests.
    float sample(const Vec3d& world, int axis = 0) const;
};

// One moment of one fluid: the whole contract between what moves and what is seen, and the content
// of one .vdb file. Customary fields: density (1, undiluted at the source), temperature (K), flame
// (1), velocity (m/s, vector), pressure (Pa).
struct Frame {
    int number = 0;   // frame number, first = 1 by custom
    double time = 0;  // s
    double dt = 0;    // s to the next frame; 0: unknown
    std::map<std::string, Field> fields;
    std::map<std::string, Particles> particles;
    std::map<std::string, std::string> metadata;  // creator, version, scene hash, units ...

    const Field* find(const std::string& name) const {
        const auto f = fields.find(name);
        return f == fields.end() ? nullptr : &f->second;
    }
    // Box around all fields' cells; empty where there are none.
    Box3d world_bounds() const;
};

}  // namespace gischt
