// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "math/keyframes.h"
#include "optics/medium.h"
#include "optics/medium_params.h"
#include "schema/table.h"

namespace gischt {

// The media of a scene file that do not come from a fluid.

// What all of them but air have: what they do to light, the density being 1 or that of the layer.
struct PlacedMedium {
    std::string name;
    MediumParams medium;
};

struct BoxMedium : PlacedMedium {
    Keyed<Vec3d> center{Vec3d{0, 0, 0}};
    Vec3d size{1, 1, 1};                            // m
    Keyed<Vec3d> rotation_degrees{Vec3d{0, 0, 0}};  // around x, then y, then z
    Keyed<double> temperature{0};                   // K, of emission 'blackbody'
};

struct SphereMedium : PlacedMedium {
    Keyed<Vec3d> center{Vec3d{0, 0, 0}};
    Keyed<double> radius{1};
    Keyed<double> temperature{0};
};

// Fog without end, the same everywhere.
struct UnboundedMedium : PlacedMedium {
    UnboundedMedium();
};

// Fog that gets thinner with height, density exp(-(z - base) / scale_height), and has its density
// at the base below.
struct HeightFog : PlacedMedium {
    HeightFog();

    std::optional<Vec3d> up;         // unset: the scene's up axis
    double base = 0;                 // m, along up from the origin
    Keyed<double> scale_height{10};  // m
    std::optional<double> top;       // m above the base
};

// The air around a planet, as a layer of molecules (Rayleigh), one of haze (Mie) and one of ozone.
// Coefficients that are not given are the Earth's (atmosphere.h).
struct PlanetAir {
    std::string name;
    std::optional<Keyed<Vec3d>> center;  // unset: the origin lies on the ground
    double radius = 6.36e6;              // m
    double top = 100e3;                  // m above the ground
    double turbidity = 2;                // of the haze
    Keyed<double> density_scale{1};      // of everything
    double ozone = 1;                    // factor of the ozone
    std::optional<Vec3d> rayleigh_scattering, mie_scattering, mie_absorption;  // 1/m at the ground
    double rayleigh_scale_height = 8000, mie_scale_height = 1200;              // m
    double mie_g = 0.76;
};

using PlacedMediumParams =
    std::variant<BoxMedium, SphereMedium, UnboundedMedium, HeightFog, PlanetAir>;

const Variants<PlacedMediumParams>& placed_media_variants();

// The media of one section at a moment: one, or the up to three of the air, of which those that do
// nothing are left out. Throws Error{Usage} for sizes that are not positive.
std::vector<std::shared_ptr<const Medium>> place_media(const PlacedMediumParams& params,
                                                       double time, const Vec3d& scene_up);

}  // namespace gischt
