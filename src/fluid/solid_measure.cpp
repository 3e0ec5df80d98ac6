// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "fluid/solid_field.h"

// Distances to solids at the points of the grid, found once per position of the solids.
namespace gischt {

// Twice the change of the distance over half a cell along each axis: some length times the normal.
Vec3d SolidField::gradient(const Vec3d& point) const {
    Vec3d g;
    for (int b = 0; b < domain_.axes(); ++b) {
        Vec3d step;
        step[b] = 0.5 * domain_.h;
        g[b] = signed_distance(point + step) - signed_distance(point - step);
    }
    return g;
}

void SolidField::find_normals(int axis) {
    const auto& points = face_ghosts_[static_cast<std::size_t>(axis)].points();
    auto& normals = face_normals_[static_cast<std::size_t>(axis)];
    normals.resize(points.size());
    parallel_for(static_cast<int>(points.size()), 64, [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        normals[at] = gradient(domain_.face_center(axis, points[at]));
    });
}

void SolidField::find_no_slip_ghosts(int axis) {
    const auto& points = face_ghosts_[static_cast<std::size_t>(axis)].points();
    auto& ghosts = no_slip_ghosts_[static_cast<std::size_t>(axis)];
    ghosts.resize(points.size());
    parallel_for(static_cast<int>(points.size()), 64, [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const Vec3d p = domain_.face_center(axis, points[at]), g = gradient(p);
        const double size = length(g), distance = signed_distance(p);
        const Vec3d normal = size > 0 ? g / size : Vec3d{};
        // The velocity that the surface has next to the point.
        const double wall = velocity(p - distance * normal)[axis];
        ghosts[at] =
            surface_ghost(domain_, axis, points[at], distance, normal, static_cast<float>(wall));
    });
}

// A surface may pass between faces of this block and of the next one: two cells more.
void SolidField::measure_block(int block) {
    const Box3i cells = blocks_.cells(block);
    const Vec3d lo = node(cells.lo), hi = node(cells.hi);
    const double margin = 2 * domain_.h, reach = 0.5 * length(hi - lo) + margin,
                 middle = signed_distance(0.5 * (lo + hi));
    if (middle > reach) return;
    const bool is_deep = middle < -reach;  // no surface near
    for (int a = 0; a < domain_.axes(); ++a) {
        for_cells(domain_.faces_of(cells, a), [&](const Vec3i& f) {
            const Vec3d p = domain_.face_center(a, f);
            const double distance = is_deep ? middle : signed_distance(p);
            distance_.ref(a, f) = static_cast<float>(distance);
            if (is_moving_ && distance < margin) {
                wall_.ref(a, f) = static_cast<float>(velocity(p)[a]);
            }
        });
    }
}

void SolidField::update_heat() {
    heat_distance_ = TileField<float>(domain_.map, std::numeric_limits<float>::max());
    heat_value_ = TileField<float>(domain_.map);
    heat_fraction_ = fraction_;
    parallel_for(blocks_.size(), 1, [&](int block) { measure_heat(block); });
    heat_ghosts_.clear();
    for (const Vec3i& c : center_ghosts_.points()) {
        if (heat_distance_.get(c) > 0) continue;
        const Vec3d p = domain_.center_of(c), g = gradient(p);
        const double size = length(g);
        heat_ghosts_.push_back(surface_ghost(domain_, -1, c,
                                             static_cast<double>(heat_distance_.get(c)),
                                             size > 0 ? g / size : Vec3d{}, heat_value_.get(c)));
    }
}

void SolidField::measure_heat(int block) {
    const Box3i cells = blocks_.cells(block);
    const Vec3d lo = node(cells.lo), hi = node(cells.hi);
    const double margin = 2 * domain_.h;
    if (signed_distance(0.5 * (lo + hi)) > 0.5 * length(hi - lo) + margin) return;
    const auto holds = [&](int s) {
        return s >= 0 && solids_[static_cast<std::size_t>(s)].temperature.has_value();
    };
    for_cells(cells, [&](const Vec3i& c) {
        const Vec3d p = domain_.center_of(c);
        const int s = nearest(p, true);
        if (s < 0) return;
        const auto at = static_cast<std::size_t>(s);
        // A cell whose centre lies on the surface is one of the fluid, as elsewhere.
        const double distance = shapes_[at].signed_distance(p), least = 1e-6 * domain_.h;
        heat_distance_.ref(c) =
            static_cast<float>(distance < 0 ? distance : std::max(distance, least));
        heat_value_.ref(c) = static_cast<float>(solids_[at].temperature->at(time_) - ambient_);
    });
    // Heat passes the surfaces that hold it: there the links to what they hold count, not faces.
    for (int a = 0; a < domain_.axes(); ++a) {
        for_cells(domain_.faces_of(cells, a), [&](const Vec3i& f) {
            if (heat_fraction_.get(a, f) == 1) return;
            if (holds(nearest(domain_.face_center(a, f), false))) heat_fraction_.ref(a, f) = 1;
        });
    }
}

}  // namespace gischt
