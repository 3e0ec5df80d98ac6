// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "optics/ggx_energy.h"
#include "optics/surface.h"
#include "optics/surface_params.h"
#include "shape/shape.h"

namespace gischt {

// What a SurfaceSet holds; for the files that build and query it.

// A surface at the moments of a shutter.
struct SurfaceEntry {
    SurfaceParams params;
    SurfaceInfo info;
    Shape shape;              // at the middle of the shutter
    bool is_stopping = true;  // blocks light: all but material None
    Transform to_board;       // a point into the frame of checker board and coordinates

    Vec3f albedo, checker;
    double checker_size = 0;
    // The scattering with the albedo yet to be put in.
    BsdfLobe lobe;
    std::shared_ptr<const EnergyTable> energy;
    std::shared_ptr<const DielectricEnergyTable> dielectric_energy;
};

struct SurfaceSet::Content {
    std::vector<SurfaceEntry> surfaces;
    std::vector<std::shared_ptr<const SurfaceLight>> lights;
    double time = 0, shutter = 0;
    Vec3d scene_up;

    double time_at(float moment) const {
        return time + (static_cast<double>(moment) - 0.5) * shutter;
    }
    // The shape of a surface at a moment; `moved` is where it is put when it moves.
    const Shape& shape(const SurfaceEntry& s, float moment, Shape& moved) const;
};

// Throws Error{Usage} on a size that is not positive.
Shape shape_at(const SurfaceParams& surface, double time, const Vec3d& scene_up);
SurfaceEntry make_surface(const SurfaceParams& surface, double time, double shutter,
                          const Vec3d& scene_up);

// The local frame of a shape: a sphere's centre, a box's corner, a plane's point with its normal
// along z.
Transform local_frame(const Shape& shape);

const Material& material_of(const SurfaceParams& surface);
// Null when it is no sheet.
const SheetPlace* sheet_of(const SurfaceParams& surface);

}  // namespace gischt
