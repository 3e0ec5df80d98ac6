// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "math/keyframes.h"
#include "math/vec.h"
#include "optics/phase.h"
#include "schema/table.h"

namespace gischt {

// An approximation of multiple scattering for methods that follow light once (Wrenninge, Kulla,
// Lundqvist 2013, "Oz: the great and volumetric"): octave i adds scattered light with the
// scattering coefficient times contribution^i, the extinction towards the light times
// attenuation^i and the phase function's mean cosine times eccentricity^i. Looks, not physics:
// methods that follow every path ignore it.
struct MultipleScattering {
    int octaves = 0;  // beyond single scattering; 0: none
    double attenuation = 0.5, contribution = 0.5, eccentricity = 0.5;
};

enum class EmissionKind { None, Blackbody, Flame };

// What a fluid does to light. `density` of the frame times the coefficients gives 1/m.
struct MediumParams {
    std::string density_field = "density";
    Keyed<double> density_scale{1.0};
    // 1/m at density 1, per channel: extinction and albedo, or absorption and scattering.
    Keyed<Vec3d> extinction{Vec3d(10.0)};
    Keyed<Vec3d> albedo{Vec3d(0.9)};
    std::optional<Keyed<Vec3d>> absorption, scattering;

    PhaseKind phase = PhaseKind::HenyeyGreenstein;
    Keyed<double> g{0.0};
    double g2 = -0.3, lobe_weight = 0.7;  // of two lobes: the second, the share of the first
    double droplet_diameter = 10;         // micrometres, of the Mie phase

    EmissionKind emission = EmissionKind::None;
    Keyed<double> emission_scale{1.0};
    std::optional<std::string> emission_field;  // unset: "temperature" or "flame", by the kind
    std::optional<Vec2d> temperature_range;     // K where the field is 0 and 1

    MultipleScattering multiple_scattering;
};

const Table<MediumParams>& medium_table();

}  // namespace gischt
