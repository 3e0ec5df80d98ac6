// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/heat_flux.h"

#include <fmt/format.h>

namespace gischt {
namespace {

// What lies beyond a side: its deviation from the ambient, and how far from the cells' centres.
struct Beyond {
    double deviation = 0;  // K
    double distance = 0;   // m; 0: insulated
};

Beyond beyond_side(const SmokeSolver& solver, int axis, int end,
                   const std::optional<double>& wall_temperature) {
    const Domain& d = solver.domain();
    if (d.side_of(axis, end) == SideKind::Periodic) {
        throw Error(ErrorKind::Usage, "probe",
                    fmt::format("no heat flux through {}_{}, which is periodic", "xyz"[axis],
                                end == 0 ? "min" : "max"),
                    "measure a wall or an open side");
    }
    const double ambient = solver.params().ambient_temperature;
    if (wall_temperature) return {*wall_temperature - ambient, 0.5 * d.h};
    const ScalarHold& held = d.held.temperature;
    const auto deviation =
        static_cast<double>(held.value[static_cast<std::size_t>(2 * axis + end)]);
    switch (held.borders(axis, end)) {
        case Border::Zero:
            return {deviation, d.h};
        case Border::Odd:
            return {deviation, 0.5 * d.h};
        default:
            return {};
    }
}

}  // namespace

SideFlux measure_side_flux(const SmokeSolver& solver, int axis, int end,
                           const std::optional<double>& wall_temperature) {
    const Domain& d = solver.domain();
    const Beyond beyond = beyond_side(solver, axis, end, wall_temperature);
    const double area = d.is_2d() ? d.h : d.h * d.h;
    Box3i cells{{}, d.cells};
    if (end == 0) {
        cells.hi[axis] = 1;
    } else {
        cells.lo[axis] = d.cells[axis] - 1;
    }
    SideFlux flux;
    for_cells(cells, [&](const Vec3i& c) {
        Vec3i face = c;
        face[axis] += end;
        const double open = solver.solids().is_empty()
                                ? 1.0
                                : static_cast<double>(solver.solids().fraction().get(axis, face));
        if (open == 0) return;
        const auto theta = static_cast<double>(solver.state().temperature.values.get(c));
        const double local = beyond.distance == 0
                                 ? 0.0
                                 : solver.params().thermal_diffusivity *
                                       (beyond.deviation - theta) / beyond.distance;
        flux.place.push_back(d.face_center(axis, face));
        flux.local.push_back(local);
        flux.total += open * area * local;
        flux.area += open * area;
    });
    return flux;
}

}  // namespace gischt
