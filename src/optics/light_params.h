// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "math/keyframes.h"
#include "math/vec.h"
#include "schema/table.h"

namespace gischt {

// The lights of a scene file.

// What all lights have: a strength in their own unit, times a colour, times that of a black body.
struct LightParams {
    std::string name, group;
    Keyed<Vec3d> color{Vec3d{1, 1, 1}};
    Keyed<double> temperature{0};  // K; its colour has luminance 1; 0: none
};

struct PointParams : LightParams {
    Keyed<Vec3d> position{Vec3d{0, 0, 5}};  // m
    Keyed<double> intensity{100};           // W/sr
};

struct SpotParams : LightParams {
    Keyed<Vec3d> position{Vec3d{0, 0, 5}}, target{Vec3d{0, 0, 0}};  // m
    Keyed<double> intensity{100};                                   // W/sr inside the cone
    Keyed<double> cone_degrees{45};                                 // full angle
    double softness = 0.2;  // share of the cone's angle over which it fades at its edge
};

struct SunParams : LightParams {
    std::optional<Keyed<Vec3d>> direction;  // towards the sun; in place of the two angles
    Keyed<double> azimuth_degrees{-60}, elevation_degrees{40};
    Keyed<double> irradiance{3};  // W/m^2 on a plane that faces it
    double angular_diameter_degrees = 0.53;
    bool camera_visible = false;
};

struct ConstantParams : LightParams {
    Keyed<double> radiance{1};  // W/(m^2 sr)
    bool camera_visible = true;
};

struct EnvironmentParams : LightParams {
    std::string file;                   // a lat-long picture, HDR or EXR
    Keyed<double> strength{1};          // factor on the picture
    Keyed<double> rotation_degrees{0};  // around up, counterclockwise seen from above
    std::optional<Vec3d> up;            // unset: the scene's up axis
    bool camera_visible = true;
};

struct SkyParams : LightParams {
    Keyed<double> azimuth_degrees{-60}, elevation_degrees{40};  // of the sun
    double turbidity = 2;
    double ground_albedo = 0.3;
    Keyed<double> strength{1};  // factor on physical W/(m^2 sr) and W/m^2
    bool sun = true;            // the sun beside the dome
    double angular_diameter_degrees = 0.53;
    bool camera_visible = true;
};

// Lights that have a size. They are surfaces: seen, hit by light paths, and they cast shadows.
struct AreaLightParams : LightParams {
    Keyed<Vec3d> position{Vec3d{0, 0, 5}};  // m, of the middle
    Keyed<double> radiance{10};             // W/(m^2 sr)
    std::optional<Keyed<double>> power;     // W, in place of radiance
    bool camera_visible = true;
};
struct SheetLightParams : AreaLightParams {
    Keyed<Vec3d> target{Vec3d{0, 0, 0}};  // m, a point that the light faces
    bool two_sided = false;
};
struct RectLightParams : SheetLightParams {
    Vec2d size{1, 1};         // m, of the horizontal edge and the other
    double roll_degrees = 0;  // around the way to the target
};
struct DiscLightParams : SheetLightParams {
    double radius = 0.5;  // m
};
struct SphereLightParams : AreaLightParams {
    double radius = 0.5;  // m
};

using AnyLightParams =
    std::variant<PointParams, SpotParams, SunParams, ConstantParams, EnvironmentParams, SkyParams,
                 RectLightParams, DiscLightParams, SphereLightParams>;

const Variants<AnyLightParams>& light_variants();

// The name that the light has in the scene file; may be empty.
const std::string& light_name(const AnyLightParams& light);

}  // namespace gischt
