// SPDX-License-Identifier: Apache-2.0
#include "render/field/quantity.h"

#include <cmath>

namespace gischt {
namespace {

float component(const Field& f, int axis, const Vec3i& cell) {
    const auto a = static_cast<std::size_t>(axis);
    return f.component[a].get(cell, f.background[a]);
}

// Metres per cell along an axis.
double spacing(const Field& f, int axis) {
    return length(f.to_world.column[static_cast<std::size_t>(axis)]);
}

// Component of a vector along an axis of the cells, which may be turned in space.
float along_cells(const Field& f, int axis, const Vec3i& cell) {
    const Vec3f v{component(f, 0, cell), component(f, 1, cell), component(f, 2, cell)};
    const Vec3d& edge = f.to_world.column[static_cast<std::size_t>(axis)];
    return dot(v, Vec3f(normalize(edge)));
}

// d u_of / d x_along in 1/s, both along axes of the cells, one-sided at the bounds of the field,
// beyond which it means nothing.
double derivative(const Field& f, int of, int along, const Vec3i& cell) {
    const Box3i& box = f.map().bounds();
    Vec3i ahead = cell, behind = cell;
    if (cell[along] + 1 < box.hi[along]) ++ahead[along];
    if (cell[along] > box.lo[along]) --behind[along];
    const int cells = ahead[along] - behind[along];
    if (cells == 0) return 0;
    const float difference = along_cells(f, of, ahead) - along_cells(f, of, behind);
    return static_cast<double>(difference) / (cells * spacing(f, along));
}

Quantity of_velocity(const Field& velocity, std::string_view name, int normal) {
    Quantity q;
    q.name = name;
    q.unit = "m/s";
    q.field = &velocity;
    const Field* v = &velocity;
    if (name == "speed" || name == "velocity") {
        q.name = "speed";
        q.at = [v](const Vec3i& cell) {
            return length(
                Vec3f{component(*v, 0, cell), component(*v, 1, cell), component(*v, 2, cell)});
        };
        return q;
    }
    q.is_signed = true;
    if (name == "vorticity") {
        q.unit = "1/s";
        const int a = (normal + 1) % 3, b = (normal + 2) % 3;
        q.at = [v, a, b](const Vec3i& cell) {
            return static_cast<float>(derivative(*v, b, a, cell) - derivative(*v, a, b, cell));
        };
        return q;
    }
    const int axis = name.back() - 'x';
    q.at = [v, axis](const Vec3i& cell) { return component(*v, axis, cell); };
    return q;
}

bool is_made_from_velocity(std::string_view name) {
    return name == "speed" || name == "velocity" || name == "vorticity" || name == "velocity_x" ||
           name == "velocity_y" || name == "velocity_z";
}

}  // namespace

Quantity find_quantity(const Frame& frame, std::string_view name, int normal) {
    if (is_made_from_velocity(name)) {
        const Field* velocity = frame.find("velocity");
        if (velocity && velocity->is_vector()) return of_velocity(*velocity, name, normal);
    }
    Quantity q;
    q.name = name;
    const Field* field = frame.find(q.name);
    if (!field) return q;
    q.field = field;
    if (field->is_vector()) {
        q.at = [field](const Vec3i& cell) {
            return length(Vec3f{component(*field, 0, cell), component(*field, 1, cell),
                                component(*field, 2, cell)});
        };
    } else {
        q.at = [field](const Vec3i& cell) { return component(*field, 0, cell); };
    }
    if (name == "temperature") q.unit = "K";
    if (name == "pressure") q.unit = "Pa", q.is_signed = true;
    if (name == "temperature" || name == "flame") q.colormap = ColormapKind::Inferno;
    if (field->kind == FieldClass::LevelSet) q.unit = "m", q.is_signed = true;
    return q;
}

std::vector<std::string> quantity_names(const Frame& frame) {
    std::vector<std::string> names;
    for (const auto& [name, field] : frame.fields) {
        if (name == "velocity" && field.is_vector()) {
            for (const char* n : {"speed", "velocity_x", "velocity_y", "velocity_z", "vorticity"}) {
                names.emplace_back(n);
            }
        } else {
            names.push_back(name);
        }
    }
    return names;
}

}  // namespace gischt
