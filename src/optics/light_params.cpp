// SPDX-License-Identifier: Apache-2.0
#include "optics/light_params.h"

namespace gischt {
namespace {

const Table<LightParams>& common_table() {
    static const Table<LightParams> table =
        Table<LightParams>("light", "What all lights have")
            .add("name", &LightParams::name, {.help = "For messages and --set"})
            .add("group", &LightParams::group,
                 {.help = "Lights of one group get the layer light_GROUP of an EXR, where the "
                          "method can tell them apart"})
            .add("color", &LightParams::color,
                 {.help = "Factor per channel; (1, 1, 1) is a flat spectrum",
                  .min = 0,
                  .broadcast = true})
            .add("temperature", &LightParams::temperature,
                 {.unit = "K",
                  .help = "Colour of a black body as a further factor of luminance 1; 0 for none",
                  .min = 0,
                  .max = 1e5});
    return table;
}

// Shared by sun and sky.
template <class T>
void add_sun_angles(Table<T>& table) {
    table
        .add(
            "azimuth_degrees", &T::azimuth_degrees,
            {.unit = "degrees",
             .help = "Where the sun stands, counterclockwise seen from above: 0 over the front (-y "
                     "where z is up, +z where y is up), 90 over +x"})
        .add("elevation_degrees", &T::elevation_degrees,
             {.unit = "degrees",
              .help = "Height of the sun over the horizon",
              .min = -90,
              .max = 90});
}

template <class T>
void add_sun_size(Table<T>& table) {
    table.add("angular_diameter_degrees", &T::angular_diameter_degrees,
              {.unit = "degrees",
               .help = "Of the sun's disc; 0 makes all shadows sharp",
               .min = 0,
               .max = 90});
}

template <class T>
void add_visibility(Table<T>& table) {
    table.add("camera_visible", &T::camera_visible,
              {.help = "Whether the camera sees the light itself behind everything"});
}

const Table<PointParams>& point_table() {
    static const Table<PointParams> table =
        Table<PointParams>("point", "A point that shines in all directions")
            .add("position", &PointParams::position, {.unit = "m", .help = "Where it is"})
            .add("intensity", &PointParams::intensity,
                 {.unit = "W/sr", .help = "Power per solid angle", .min = 0})
            .base(common_table());
    return table;
}

const Table<SpotParams>& spot_table() {
    static const Table<SpotParams> table =
        Table<SpotParams>("spot", "A point that shines into a cone")
            .add("position", &SpotParams::position, {.unit = "m", .help = "Where it is"})
            .add("target", &SpotParams::target, {.unit = "m", .help = "A point on the cone's axis"})
            .add("intensity", &SpotParams::intensity,
                 {.unit = "W/sr", .help = "Power per solid angle inside the cone", .min = 0})
            .add("cone_degrees", &SpotParams::cone_degrees,
                 {.unit = "degrees",
                  .help = "Full angle of the cone",
                  .min = 0,
                  .max = 360,
                  .min_open = true})
            .add("softness", &SpotParams::softness,
                 {.help = "Share of the angle over which the light fades at the cone's edge",
                  .min = 0,
                  .max = 1})
            .base(common_table());
    return table;
}

const Table<SunParams>& sun_table() {
    static const Table<SunParams> table = [] {
        auto t = Table<SunParams>("sun", "Light from one far direction");
        t.add("direction", &SunParams::direction,
              {.help = "Points towards the sun, in place of the two angles"});
        add_sun_angles(t);
        t.add("irradiance", &SunParams::irradiance,
              {.unit = "W/m^2", .help = "On a plane that faces the sun", .min = 0});
        add_sun_size(t);
        add_visibility(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

const Table<ConstantParams>& constant_table() {
    static const Table<ConstantParams> table = [] {
        auto t = Table<ConstantParams>("constant", "The same light from all directions");
        t.add("radiance", &ConstantParams::radiance,
              {.unit = "W/(m^2 sr)", .help = "From every direction", .min = 0});
        add_visibility(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

const Table<EnvironmentParams>& environment_table() {
    static const Table<EnvironmentParams> table = [] {
        auto t = Table<EnvironmentParams>("environment", "Light from a picture of all directions");
        t.add("file", &EnvironmentParams::file,
              {.help = "Picture in latitude and longitude (.hdr or .exr), its middle towards +x",
               .required = true})
            .add("strength", &EnvironmentParams::strength,
                 {.help = "Factor on the picture's radiance", .min = 0})
            .add("rotation_degrees", &EnvironmentParams::rotation_degrees,
                 {.unit = "degrees", .help = "Around up, counterclockwise seen from above"})
            .add("up", &EnvironmentParams::up,
                 {.help = "Direction of the picture's top; the scene's up axis when not given"});
        add_visibility(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

const Table<SkyParams>& sky_table() {
    static const Table<SkyParams> table = [] {
        auto t = Table<SkyParams>(
            "sky", "A clear sky and its sun, computed from the scattering of light in air");
        add_sun_angles(t);
        t.add("turbidity", &SkyParams::turbidity,
              {.help = "1 for pure air, 2 clear, 3 slightly hazy, 6 hazy", .min = 1, .max = 20})
            .add("ground_albedo", &SkyParams::ground_albedo,
                 {.help = "Share of light that the land around reflects", .min = 0, .max = 1})
            .add("strength", &SkyParams::strength,
                 {.help = "Factor; 1 gives the physical radiance, about 80 W/(m^2 sr) for the sky "
                          "and 600 W/m^2 for the sun",
                  .min = 0})
            .add("sun", &SkyParams::sun, {.help = "Whether the sun shines, beside the dome"});
        add_sun_size(t);
        add_visibility(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

const Table<AreaLightParams>& area_table() {
    static const Table<AreaLightParams> table = [] {
        auto t = Table<AreaLightParams>("area", "What lights that have a size have");
        t.add("position", &AreaLightParams::position, {.unit = "m", .help = "Its middle"})
            .add("radiance", &AreaLightParams::radiance,
                 {.unit = "W/(m^2 sr)", .help = "What it gives off", .min = 0})
            .add("power", &AreaLightParams::power,
                 {.unit = "W", .help = "What it gives off in all, in place of radiance", .min = 0});
        add_visibility(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

const Table<SheetLightParams>& sheet_light_table() {
    static const Table<SheetLightParams> table =
        Table<SheetLightParams>("sheet", "What flat lights have")
            .add("target", &SheetLightParams::target,
                 {.unit = "m", .help = "A point that it faces"})
            .add("two_sided", &SheetLightParams::two_sided,
                 {.help = "Whether it shines to its back too"})
            .base(area_table());
    return table;
}

const Table<RectLightParams>& rect_light_table() {
    static const Table<RectLightParams> table =
        Table<RectLightParams>("rect", "A rectangle that shines; for method 'path'")
            .add("size", &RectLightParams::size,
                 {.unit = "m",
                  .help = "Lengths of its horizontal edge and of the other",
                  .min = 0,
                  .min_open = true})
            .add("roll_degrees", &RectLightParams::roll_degrees,
                 {.unit = "degrees", .help = "Turned around the way to the target"})
            .base(sheet_light_table());
    return table;
}

const Table<DiscLightParams>& disc_light_table() {
    static const Table<DiscLightParams> table =
        Table<DiscLightParams>("disc", "A disc that shines; for method 'path'")
            .add("radius", &DiscLightParams::radius,
                 {.unit = "m", .help = "Its radius", .min = 0, .min_open = true})
            .base(sheet_light_table());
    return table;
}

const Table<SphereLightParams>& sphere_light_table() {
    static const Table<SphereLightParams> table =
        Table<SphereLightParams>("sphere", "A ball that shines; for method 'path'")
            .add("radius", &SphereLightParams::radius,
                 {.unit = "m", .help = "Its radius", .min = 0, .min_open = true})
            .base(area_table());
    return table;
}

}  // namespace

const Variants<AnyLightParams>& light_variants() {
    static const Variants<AnyLightParams> variants =
        Variants<AnyLightParams>("light", "A source of light outside of the media")
            .add("point", point_table())
            .add("spot", spot_table())
            .add("sun", sun_table())
            .add("constant", constant_table())
            .add("environment", environment_table())
            .add("sky", sky_table())
            .add("rect", rect_light_table())
            .add("disc", disc_light_table())
            .add("sphere", sphere_light_table());
    return variants;
}

const std::string& light_name(const AnyLightParams& light) {
    return std::visit([](const auto& l) -> const std::string& { return l.name; }, light);
}

}  // namespace gischt
