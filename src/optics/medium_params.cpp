// SPDX-License-Identifier: Apache-2.0
#include "optics/medium_params.h"

namespace gischt {
namespace {

const Table<MultipleScattering>& multiple_scattering_table() {
    static const Table<MultipleScattering> table =
        Table<MultipleScattering>(
            "multiple_scattering",
            "Approximate multiple scattering by octaves (Wrenninge 2013), for methods that scatter "
            "light once; those that follow every path ignore it")
            .add("octaves", &MultipleScattering::octaves,
                 {.help = "Octaves beyond single scattering; 0 turns the approximation off",
                  .min = 0,
                  .max = 16})
            .add("attenuation", &MultipleScattering::attenuation,
                 {.help = "Factor of the extinction towards the light per octave",
                  .min = 0,
                  .max = 1})
            .add("contribution", &MultipleScattering::contribution,
                 {.help = "Factor of the scattering coefficient per octave", .min = 0, .max = 1})
            .add("eccentricity", &MultipleScattering::eccentricity,
                 {.help = "Factor of the mean cosine per octave", .min = 0, .max = 1});
    return table;
}

}  // namespace

const Table<MediumParams>& medium_table() {
    static const Table<MediumParams> table =
        Table<MediumParams>("medium", "What the fluid does to light")
            .add("density_field", &MediumParams::density_field,
                 {.help = "Field of the frame that the coefficients multiply"})
            .add("density_scale", &MediumParams::density_scale,
                 {.help = "Factor of the density", .min = 0})
            .add("extinction", &MediumParams::extinction,
                 {.unit = "1/m",
                  .help = "Absorption plus scattering at density 1, per channel",
                  .min = 0,
                  .broadcast = true})
            .add("albedo", &MediumParams::albedo,
                 {.help = "Share of the extinction that scatters, per channel",
                  .min = 0,
                  .max = 1,
                  .broadcast = true})
            .add("absorption", &MediumParams::absorption,
                 {.unit = "1/m",
                  .help = "Absorption at density 1, per channel; with 'scattering', in place of "
                          "'extinction' and 'albedo'",
                  .min = 0,
                  .broadcast = true})
            .add("scattering", &MediumParams::scattering,
                 {.unit = "1/m",
                  .help = "Scattering at density 1, per channel; with 'absorption', in place of "
                          "'extinction' and 'albedo'",
                  .min = 0,
                  .broadcast = true})
            .choice("phase", &MediumParams::phase,
                    {{"isotropic", PhaseKind::Isotropic, "equal in all directions"},
                     {"henyey_greenstein", PhaseKind::HenyeyGreenstein,
                      "forward or backward by the mean cosine g"},
                     {"schlick", PhaseKind::Schlick, "a rational approximation of the former"},
                     {"rayleigh", PhaseKind::Rayleigh, "molecules: as much back as ahead"},
                     {"two_lobe", PhaseKind::TwoLobe,
                      "lobe_weight of Henyey-Greenstein with g, the rest with g2"},
                     {"mie", PhaseKind::Mie,
                      "water droplets of droplet_diameter (Jendersie & d'Eon 2023)"}},
                    {.help = "Phase function: where scattered light goes"})
            .add("g", &MediumParams::g,
                 {.help = "Mean cosine of scattering: 0 even, towards 1 forward (cloud 0.85), "
                          "towards -1 backward",
                  .min = -1,
                  .max = 1,
                  .min_open = true,
                  .max_open = true})
            .add("g2", &MediumParams::g2,
                 {.help = "Mean cosine of the second lobe of phase 'two_lobe'",
                  .min = -1,
                  .max = 1,
                  .min_open = true,
                  .max_open = true})
            .add("lobe_weight", &MediumParams::lobe_weight,
                 {.help = "Share of the first lobe of phase 'two_lobe'", .min = 0, .max = 1})
            .add("droplet_diameter", &MediumParams::droplet_diameter,
                 {.unit = "micrometres",
                  .help = "Diameter of the droplets of phase 'mie': fog and clouds 5 to 20, below "
                          "0.1 almost Rayleigh",
                  .min = MiePhase::least_diameter,
                  .max = MiePhase::largest_diameter})
            .choice("emission", &MediumParams::emission,
                    {{"none", EmissionKind::None, "the fluid does not glow"},
                     {"blackbody", EmissionKind::Blackbody,
                      "what absorbs glows at its temperature (Kirchhoff)"},
                     {"flame", EmissionKind::Flame,
                      "the flame field glows by itself, as thin soot would"}},
                    {.help = "How the fluid glows"})
            .add("emission_scale", &MediumParams::emission_scale,
                 {.help = "Factor of the emitted radiance; with emission 'flame' the absorption of "
                          "its soot in 1/m at flame 1",
                  .min = 0})
            .add("emission_field", &MediumParams::emission_field,
                 {.help = "Field that holds the temperature or flame; by default the one of that "
                          "name"})
            .add("temperature_range", &MediumParams::temperature_range,
                 {.unit = "K",
                  .help = "Temperatures where the emission field is 0 and 1, linear between and "
                          "beyond; by default [0, 1] for a temperature in kelvin and [1000, 1900] "
                          "for a flame"})
            .sub("multiple_scattering", &MediumParams::multiple_scattering,
                 multiple_scattering_table(), {.help = "Approximation of multiple scattering"})
            .check([](const MediumParams& m, const Fail& fail) {
                if (m.absorption && !m.scattering) {
                    fail("absorption", "needs 'scattering' beside it");
                }
                if (m.scattering && !m.absorption) {
                    fail("scattering", "needs 'absorption' beside it");
                }
            });
    return table;
}

}  // namespace gischt
