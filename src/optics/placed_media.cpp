// SPDX-License-Identifier: Apache-2.0
#include "optics/placed_media.h"

#include "base/error.h"
#include "base/units.h"
#include "optics/atmosphere.h"

namespace gischt {
namespace {

// What belongs to the fields of a fluid cannot be heard here.
void check_medium(const PlacedMedium& m, const Fail& fail) {
    const MediumParams standard;
    if (m.medium.density_field != standard.density_field) {
        fail("density_field", "belongs to a fluid", "a [[medium]] has density 1");
    }
    if (m.medium.emission_field) fail("emission_field", "belongs to a fluid");
    if (m.medium.temperature_range) fail("temperature_range", "belongs to a fluid");
    if (m.medium.emission == EmissionKind::Flame) {
        fail("emission", "'flame' belongs to a fluid", "take 'blackbody' and a temperature");
    }
}

const Table<PlacedMedium>& common_table() {
    static const Table<PlacedMedium> table =
        Table<PlacedMedium>("placed_medium", "What all media that stand still have")
            .add("name", &PlacedMedium::name, {.help = "For messages and --set"})
            .flat(&PlacedMedium::medium, medium_table())
            .check(check_medium);
    return table;
}

template <class M>
void add_temperature(Table<M>& table) {
    table.add("temperature", &M::temperature,
              {.unit = "K", .help = "Of what glows with emission 'blackbody'", .min = 0});
}

const Table<BoxMedium>& box_table() {
    static const Table<BoxMedium> table = [] {
        auto t = Table<BoxMedium>("box_medium", "A box filled evenly");
        t.add("center", &BoxMedium::center, {.unit = "m", .help = "The middle"})
            .add("size", &BoxMedium::size,
                 {.unit = "m", .help = "Lengths of the edges", .min = 0, .min_open = true})
            .add("rotation_degrees", &BoxMedium::rotation_degrees,
                 {.unit = "degrees", .help = "Turned around x, then y, then z"});
        add_temperature(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

const Table<SphereMedium>& sphere_table() {
    static const Table<SphereMedium> table = [] {
        auto t = Table<SphereMedium>("sphere_medium", "A ball filled evenly");
        t.add("center", &SphereMedium::center, {.unit = "m", .help = "The middle"})
            .add("radius", &SphereMedium::radius,
                 {.unit = "m", .help = "The radius", .min = 0, .min_open = true});
        add_temperature(t);
        t.base(common_table());
        return t;
    }();
    return table;
}

// Fog without end cannot glow.
void check_dark(const PlacedMedium& m, const Fail& fail) {
    if (m.medium.emission != EmissionKind::None) {
        fail("emission", "must be 'none': the medium has no end", "take a box or a sphere");
    }
}

const Table<UnboundedMedium>& unbounded_table() {
    static const Table<UnboundedMedium> table =
        Table<UnboundedMedium>("unbounded", "Fog without end, the same everywhere")
            .base(common_table())
            .check(check_dark);
    return table;
}

const Table<HeightFog>& fog_table() {
    static const Table<HeightFog> table =
        Table<HeightFog>("height_fog",
                         "Fog without end that thins out upwards: density exp(-(height - base) / "
                         "scale_height), and 1 below the base")
            .add("up", &HeightFog::up,
                 {.help = "Direction in which it thins out; the scene's up axis when not given"})
            .add("base", &HeightFog::base,
                 {.unit = "m", .help = "Height, from the origin, from where on it thins out"})
            .add("scale_height", &HeightFog::scale_height,
                 {.unit = "m",
                  .help = "Height over which the density falls to 1/e",
                  .min = 0,
                  .min_open = true})
            .add("top", &HeightFog::top,
                 {.unit = "m",
                  .help = "Height above the base where the fog ends; by default where its density "
                          "is 2^-32, after 22 scale heights",
                  .min = 0,
                  .min_open = true})
            .base(common_table())
            .check(check_dark);
    return table;
}

const Table<PlanetAir>& air_table() {
    using P = PlanetAir;
    static const Table<P> table =
        Table<P>(
            "atmosphere",
            "The air of a planet: molecules and haze that scatter, ozone that absorbs. A sphere "
            "of the same centre and radius under [[solid]] is its ground")
            .add("name", &P::name, {.help = "For messages and --set"})
            .add("center", &P::center,
                 {.unit = "m",
                  .help = "The planet's centre; by default below the origin by the radius, so that "
                          "the origin lies on the ground"})
            .add("radius", &P::radius,
                 {.unit = "m", .help = "Of the planet", .min = 0, .min_open = true})
            .add("top", &P::top,
                 {.unit = "m",
                  .help = "Where the air ends above the ground",
                  .min = 0,
                  .min_open = true})
            .add("turbidity", &P::turbidity,
                 {.help = "Haze: 1 for pure air, 2 clear, 3 slightly hazy, 6 hazy",
                  .min = 1,
                  .max = 20})
            .add("density_scale", &P::density_scale, {.help = "Factor of all densities", .min = 0})
            .add("ozone", &P::ozone, {.help = "Factor of the ozone layer, 0 for none", .min = 0})
            .add("rayleigh_scattering", &P::rayleigh_scattering,
                 {.unit = "1/m",
                  .help = "Of the molecules at the ground, per channel; the Earth's when not given",
                  .min = 0,
                  .broadcast = true})
            .add("rayleigh_scale_height", &P::rayleigh_scale_height,
                 {.unit = "m", .help = "Over which they fall to 1/e", .min = 0, .min_open = true})
            .add("mie_scattering", &P::mie_scattering,
                 {.unit = "1/m",
                  .help = "Of the haze at the ground; by turbidity when not given",
                  .min = 0,
                  .broadcast = true})
            .add("mie_absorption", &P::mie_absorption,
                 {.unit = "1/m",
                  .help = "Of the haze at the ground; by turbidity when not given",
                  .min = 0,
                  .broadcast = true})
            .add("mie_scale_height", &P::mie_scale_height,
                 {.unit = "m", .help = "Over which it falls to 1/e", .min = 0, .min_open = true})
            .add("mie_g", &P::mie_g,
                 {.help = "Mean cosine of scattering by the haze",
                  .min = -1,
                  .max = 1,
                  .min_open = true,
                  .max_open = true});
    return table;
}

using MediumPtr = std::shared_ptr<const Medium>;

struct Placer {
    double time;
    Vec3d scene_up;

    std::vector<MediumPtr> operator()(const BoxMedium& m) const {
        Region region{Region::Kind::Box, m.center.at(time), m.size, {}};
        const Vec3d angles = m.rotation_degrees.at(time);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d e;
            e[axis] = 1;
            region.rotation = Transform::rotation(e, radians(angles[axis])) * region.rotation;
        }
        return filled(region, m.medium, m.temperature.at(time));
    }
    std::vector<MediumPtr> operator()(const SphereMedium& m) const {
        return filled(Region::sphere(m.center.at(time), m.radius.at(time)), m.medium,
                      m.temperature.at(time));
    }
    std::vector<MediumPtr> operator()(const UnboundedMedium& m) const {
        return filled(Region::everywhere(), m.medium, 0);
    }
    std::vector<MediumPtr> operator()(const HeightFog& m) const {
        const Vec3d up = m.up.value_or(scene_up);
        if (!(length(up) > 0)) {
            throw Error(ErrorKind::Usage, "height_fog", "up has no length");
        }
        const HeightProfile profile{HeightProfile::Kind::Exponential, m.scale_height.at(time), 0};
        const double top = m.top.value_or(std::numeric_limits<double>::infinity());
        return {std::make_shared<Medium>(Layer::flat(normalize(up), m.base, profile, top), m.medium,
                                         time)};
    }
    std::vector<MediumPtr> operator()(const PlanetAir& air) const {
        const auto earth = Atmosphere::coefficients(air.turbidity);
        const Vec3d center = air.center ? air.center->at(time) : -air.radius * normalize(scene_up);
        const double scale = air.density_scale.at(time);
        std::vector<MediumPtr> media;
        const auto add = [&](const HeightProfile& profile, const Vec3d& absorption,
                             const Vec3d& scattering, PhaseKind phase) {
            if (!(max_component(scale * (absorption + scattering)) > 0)) return;
            MediumParams m;
            m.absorption = Keyed<Vec3d>(absorption);
            m.scattering = Keyed<Vec3d>(scattering);
            m.density_scale = Keyed<double>(scale);
            m.phase = phase;
            m.g = Keyed<double>(air.mie_g);
            media.push_back(std::make_shared<Medium>(
                Layer::round(center, air.radius, profile, air.top), m, time));
        };
        using Kind = HeightProfile::Kind;
        add({Kind::Exponential, air.rayleigh_scale_height, 0}, {},
            air.rayleigh_scattering.value_or(earth.air_scattering), PhaseKind::Rayleigh);
        add({Kind::Exponential, air.mie_scale_height, 0},
            air.mie_absorption.value_or(earth.haze_absorption),
            air.mie_scattering.value_or(earth.haze_scattering), PhaseKind::HenyeyGreenstein);
        const HeightProfile ozone{Kind::Tent, Atmosphere::ozone_reach, Atmosphere::ozone_center};
        if (air.top > ozone.center - ozone.scale) {
            add(ozone, air.ozone * earth.ozone_absorption, {}, PhaseKind::Isotropic);
        }
        return media;
    }

    std::vector<MediumPtr> filled(const Region& region, const MediumParams& params,
                                  double temperature) const {
        return {std::make_shared<Medium>(region, params, time, temperature)};
    }
};

// Clear to look at over hundreds of metres.
MediumParams thin_fog() {
    MediumParams m;
    m.extinction = Keyed<Vec3d>(Vec3d(0.01));
    m.albedo = Keyed<Vec3d>(Vec3d(0.99));
    m.g = Keyed<double>(0.7);
    return m;
}

}  // namespace

UnboundedMedium::UnboundedMedium() {
    medium = thin_fog();
}

HeightFog::HeightFog() {
    medium = thin_fog();
}

const Variants<PlacedMediumParams>& placed_media_variants() {
    static const Variants<PlacedMediumParams> variants =
        Variants<PlacedMediumParams>("placed_medium", "A medium that does not come from a fluid")
            .add("box", box_table())
            .add("sphere", sphere_table())
            .add("unbounded", unbounded_table())
            .add("height_fog", fog_table())
            .add("atmosphere", air_table());
    return variants;
}

std::vector<std::shared_ptr<const Medium>> place_media(const PlacedMediumParams& params,
                                                       double time, const Vec3d& scene_up) {
    return std::visit(Placer{time, scene_up}, params);
}

}  // namespace gischt
