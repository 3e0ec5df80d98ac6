// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "math/keyframes.h"
#include "schema/table.h"

namespace gischt {

enum class SideKind { Open, FreeSlip, NoSlip, Periodic, Inflow };
enum class SideProfile { Uniform, Parabolic };

// What one side of a domain holds. What is unset follows from the side's kind.
struct SideParams {
    std::optional<Keyed<Vec3d>> velocity;  // m/s: of a no-slip wall, or of what flows in
    SideProfile profile = SideProfile::Uniform;
    std::optional<Keyed<double>> temperature;  // K; unset: walls are insulated, else the ambient's
    std::optional<Keyed<double>> density;      // of what flows in
};
const Table<SideParams>& side_table();

struct SidesParams {
    std::optional<SideParams> x_min, x_max, y_min, y_max, z_min, z_max;

    // In the order -x, +x, -y, +y, -z, +z.
    std::array<SideParams, 6> all() const;
};
const Table<SidesParams>& sides_table();

// Throws Error{Usage}, naming the key, where a side holds what its kind cannot: a velocity of an
// open, periodic or free-slip side, one that goes through a wall or out of an inflow, an inflow
// without a velocity, or one that no open side relieves. `axes`: 2 in 2-D, where z has no sides.
void check_sides(const std::array<SideKind, 6>& kinds, const std::array<SideParams, 6>& sides,
                 int axes);

}  // namespace gischt
