// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "math/vec.h"

namespace gischt {

// The clear air of the Earth as a spherical shell: molecules that scatter (Rayleigh), haze that
// scatters forward and absorbs a little (Mie), ozone that absorbs. Light is followed in 11 bands
// from 380 to 780 nm and becomes RGB at the end, so that the sunset is red for the right reason.
// Single scattering is integrated along the ray (Nishita et al. 1993), all higher orders as if they
// were isotropic (Hillaire 2020, "A scalable and production ready sky and atmosphere rendering
// technique").
class Atmosphere {
  public:
    static constexpr int bands = 11;
    using Spectrum = std::array<double, bands>;

    static constexpr double ground_radius = 6.36e6, top_radius = 6.46e6;        // m
    static constexpr double sun_angular_diameter = 0.00930;                     // radians
    static constexpr double air_scale_height = 8000, haze_scale_height = 1200;  // m
    static constexpr double haze_mean_cosine = 0.76;
    // Ozone absorbs in a layer that fades linearly over `reach` to both sides.
    static constexpr double ozone_center = 25e3, ozone_reach = 15e3;  // m

    // Coefficients in 1/m, at sea level or in the middle of the ozone, as means over each Rec.709
    // channel of sunlight: what thin air does to it. For methods that follow three channels.
    struct Coefficients {
        Vec3d air_scattering, haze_scattering, haze_absorption, ozone_absorption;
    };
    static Coefficients coefficients(double turbidity);

    // Turbidity: 1 for pure air, 2 clear, 3 a little haze, 6 hazy (Angstrom's formula, Preetham et
    // al. 1999, A.1). Albedo of the ground, in [0,1]. Takes about 0.1 s.
    Atmosphere(double turbidity, double ground_albedo);

    // Irradiance of the sun at the top of the atmosphere, W/(m^2 nm): Planck's law at 5778 K.
    const Spectrum& solar_irradiance() const { return solar_; }

    // Share of light that comes through from space to a height (m above ground) along a direction
    // whose cosine with the local vertical is mu; 0 where the planet is in the way.
    Spectrum transmittance(double height, double mu) const;

    // Radiance that arrives at a point at `height` from `direction`, the sun's disc excluded, in
    // W/(m^2 sr nm). Local frame, z up; both unit vectors. A ray that meets the ground ends there.
    Spectrum radiance(double height, const Vec3d& direction, const Vec3d& sun) const;

    // Linear Rec.709 in the renderer's unit, not cut to the gamut. Balanced such that sunlight
    // above the atmosphere is neutral, which changes a channel by 5 % at most.
    Vec3d to_rgb(const Spectrum& spectrum) const;

  private:
    explicit Atmosphere(double turbidity);  // without the tables

    // Amounts of the three kinds of matter: their densities at a point relative to that at sea
    // level (ozone: to its maximum), or integrals of them over a path, in metres.
    struct Columns {
        double air = 0, haze = 0, ozone = 0;
    };
    struct Step;  // a piece of a ray
    static Columns density(double height);
    Spectrum attenuation(const Columns& columns) const;
    Columns columns_to_space(double radius, double mu) const;
    void build_columns();
    void build_multiple_scattering();
    void scatter_all_orders(double height, double mu_sun, Spectrum& psi) const;
    Spectrum multiple_scattering(double height, double mu_sun) const;
    // Calls f(step, transmittance up to the step) for the pieces of a ray through the air, from its
    // origin on; true if it ends on the ground. `reaches`: the transmittance of all, `end`: the
    // last point, from the planet's centre.
    template <class F>
    bool walk(double height, const Vec3d& direction, int steps, Spectrum& reaches, Vec3d& end,
              F&& f) const;

    double ground_albedo_ = 0;
    Spectrum solar_{}, air_{}, haze_scatter_{}, haze_{}, ozone_{};  // 1/m at density 1
    std::array<Vec3d, bands> band_rgb_{};
    std::vector<Columns> columns_;
    std::vector<Spectrum> multiple_;
};

}  // namespace gischt
