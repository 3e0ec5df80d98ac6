// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "math/vec.h"

namespace gischt {

template <class V>
class Variants;

enum class ProbeEvery { Frame, Step };

// What every probe has. Places are metres of the fluid's own space; in 2-D their z is ignored.
struct ProbeCommon {
    std::string name;   // of its table
    std::string fluid;  // may be empty where there is one fluid
    ProbeEvery every = ProbeEvery::Frame;
    std::optional<double> start, stop;  // s, both included
    bool mean = false;                  // a second table: the mean over time
};

// Velocity, pressure, temperature and density at points.
struct PointProbe : ProbeCommon {
    std::vector<Vec3d> points;
};
// The same at points of equal distance on a line, its ends among them.
struct LineProbe : ProbeCommon {
    Vec3d from{0, 0, 0}, to{1, 0, 0};
    int count = 65;
};
// Kinetic energy, enstrophy, largest speed.
struct EnergyProbe : ProbeCommon {};

enum class DomainSide { XMin, XMax, YMin, YMax, ZMin, ZMax };
// Heat that is conducted into the fluid through a side of the domain.
struct HeatFluxProbe : ProbeCommon {
    DomainSide side = DomainSide::XMin;
    std::optional<double> wall_temperature;           // K; unset: what the domain holds it at
    std::optional<double> delta_temperature, length;  // K, m: of the Nusselt number
    bool local = false;                               // a row for each cell on the side
};
// Force and torque of the fluid on a solid.
struct ForceProbe : ProbeCommon {
    std::string solid;
    bool viscous = true;                                    // count the friction
    std::optional<double> reference_speed, reference_area;  // m/s; m^2, in 2-D m
    Vec3d direction{1, 0, 0};                               // of the drag
    std::optional<Vec3d> lift_direction;
};
// Amounts of smoke and heat in a box; without corners in the whole domain.
struct MassProbe : ProbeCommon {
    std::optional<Vec3d> min, max;
};

enum class FrontQuantity { Density, Temperature };
// How far along a direction a scalar exceeds a threshold.
struct FrontProbe : ProbeCommon {
    Vec3d direction{0, 0, 1};
    FrontQuantity quantity = FrontQuantity::Density;
    double threshold = 0.5;  // 1; K above (below, where negative) the ambient temperature
};
// Fluxes of a rising plume at heights, and the top-hat plume that has them (Morton, Taylor, Turner
// 1956).
struct PlumeProbe : ProbeCommon {
    std::vector<double> heights;  // m above `origin`, against gravity
    double origin = 0;            // m
    double threshold = 0.02;      // cells with less of the height's largest buoyancy do not count
};

using ProbeParams = std::variant<PointProbe, LineProbe, EnergyProbe, HeatFluxProbe, ForceProbe,
                                 MassProbe, FrontProbe, PlumeProbe>;

const ProbeCommon& probe_common(const ProbeParams& probe);
const Variants<ProbeParams>& probe_variants();

}  // namespace gischt
