// SPDX-License-Identifier: Apache-2.0
#include "optics/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "image/color.h"
#include "optics/blackbody.h"
#include "optics/phase.h"
#include "optics/spectrum.h"

namespace gischt {
namespace {

constexpr double band_step = (visible_max - visible_min) / (Atmosphere::bands - 1);
constexpr double haze_single_albedo = 0.9;

// 300 Dobson units of 2.687e20 molecules per m^2 in all. Cross-sections in m^2 at 380, 420, ... 780
// nm (Chappuis band; Gorshelev et al. 2014, at 233 K).
constexpr double ozone_molecules = 300 * 2.687e20 / Atmosphere::ozone_reach;  // 1/m^3, middle
constexpr Atmosphere::Spectrum ozone_cross_section{2.818e-28, 5.520e-27, 3.669e-26, 1.480e-25,
                                                   3.091e-25, 4.398e-25, 3.740e-25, 1.852e-25,
                                                   7.455e-26, 4.228e-26, 2.534e-26};

// Sizes of the tables: heights by directions.
constexpr int column_heights = 64, column_directions = 128;
constexpr int multiple_heights = 16, multiple_directions = 24;

double rayleigh_phase(double cosine) {
    return 3 / (16 * pi) * (1 + cosine * cosine);
}

// Distance from radius r along a direction with cosine mu to the sphere of radius `to`, the farther
// hit.
double distance_to_shell(double r, double mu, double to) {
    return -r * mu + std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + to * to));
}

bool meets_ground(double r, double mu) {
    return mu < 0 &&
           r * r * (mu * mu - 1) + Atmosphere::ground_radius * Atmosphere::ground_radius >= 0;
}

double distance_to_ground(double r, double mu) {
    constexpr double ground = Atmosphere::ground_radius;
    return -r * mu - std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + ground * ground));
}

// Bilinear look-up at (x, y) in [0,1]^2 of a table of nx * ny values that add() accumulates.
template <class F>
void bilinear(double x, double y, int nx, int ny, F&& add) {
    const double px = std::clamp(x, 0.0, 1.0) * (nx - 1), py = std::clamp(y, 0.0, 1.0) * (ny - 1);
    const int x0 = std::min(static_cast<int>(px), nx - 2),
              y0 = std::min(static_cast<int>(py), ny - 2);
    const double s = px - x0, t = py - y0;
    add(static_cast<std::size_t>(y0 * nx + x0), (1 - s) * (1 - t));
    add(static_cast<std::size_t>(y0 * nx + x0 + 1), s * (1 - t));
    add(static_cast<std::size_t>((y0 + 1) * nx + x0), (1 - s) * t);
    add(static_cast<std::size_t>((y0 + 1) * nx + x0 + 1), s * t);
}

}  // namespace

struct Atmosphere::Step {
    Vec3d point;       // from the planet's centre
    double height;     // m above ground
    double length;     // m
    Columns density;   // at the point
    Spectrum through;  // transmittance of the piece
};

Atmosphere::Atmosphere(double turbidity, double ground_albedo) : Atmosphere(turbidity) {
    ground_albedo_ = ground_albedo;
    build_columns();
    build_multiple_scattering();
}

Atmosphere::Atmosphere(double turbidity) {
    // Optical depth of the haze: Angstrom's beta lambda^-1.3, lambda in micrometres.
    const double beta = std::max(0.0, 0.04608 * turbidity - 0.04586);
    // Solid angle of the sun's disc, weighted by the cosine.
    const double sun = pi * std::pow(std::sin(0.5 * sun_angular_diameter), 2);
    for (std::size_t b = 0; b < bands; ++b) {
        const double nm = visible_min + band_step * static_cast<double>(b), um = nm * 1e-3;
        solar_[b] = planck_radiance(nm, 5778) * sun;
        air_[b] = 1.24062e-6 / std::pow(um, 4);  // Bucholtz 1995, at sea level
        haze_[b] = beta * std::pow(um, -1.3) / haze_scale_height;
        haze_scatter_[b] = haze_single_albedo * haze_[b];
        ozone_[b] = ozone_cross_section[b] * ozone_molecules;
        // Linear between the bands: each stands for a hat of 80 nm.
        const Vec3d xyz = spectrum_to_xyz(
            [&](double l) { return std::max(0.0, 1 - std::abs(l - nm) / band_step); });
        band_rgb_[b] = adapted_xyz_to_rgb(xyz);
    }
    // White balance of a camera set to daylight.
    const Vec3d white = to_rgb(solar_);
    for (Vec3d& rgb : band_rgb_) rgb = rgb * (Vec3d(luminance(white)) / white);
}

Atmosphere::Coefficients Atmosphere::coefficients(double turbidity) {
    const Atmosphere air(turbidity);
    const auto mean = [&](auto&& coefficient) {
        Spectrum lost;
        for (std::size_t b = 0; b < bands; ++b) lost[b] = air.solar_[b] * coefficient(b);
        return air.to_rgb(lost) / air.to_rgb(air.solar_);
    };
    return {mean([&](std::size_t b) { return air.air_[b]; }),
            mean([&](std::size_t b) { return air.haze_scatter_[b]; }),
            mean([&](std::size_t b) { return air.haze_[b] - air.haze_scatter_[b]; }),
            mean([&](std::size_t b) { return air.ozone_[b]; })};
}

Vec3d Atmosphere::to_rgb(const Spectrum& spectrum) const {
    Vec3d rgb;
    for (std::size_t b = 0; b < bands; ++b) rgb += spectrum[b] * band_rgb_[b];
    return rgb;
}

Atmosphere::Columns Atmosphere::density(double height) {
    return {std::exp(-height / air_scale_height), std::exp(-height / haze_scale_height),
            std::max(0.0, 1 - std::abs(height - ozone_center) / ozone_reach)};
}

Atmosphere::Spectrum Atmosphere::attenuation(const Columns& c) const {
    Spectrum t;
    for (std::size_t b = 0; b < bands; ++b) {
        t[b] = std::exp(-(air_[b] * c.air + haze_[b] * c.haze + ozone_[b] * c.ozone));
    }
    return t;
}

// The table of columns to space, over radius and direction, both in the coordinates of Bruneton &
// Neyret 2008, which resolve the horizon.
void Atmosphere::build_columns() {
    columns_.resize(column_heights * column_directions);
    const double horizon = std::sqrt(top_radius * top_radius - ground_radius * ground_radius);
    parallel_for(column_heights, 1, [&](int j) {
        const double rho = horizon * j / (column_heights - 1);
        const double r = std::sqrt(rho * rho + ground_radius * ground_radius);
        const double d_min = top_radius - r, d_max = rho + horizon;
        for (int i = 0; i < column_directions; ++i) {
            const double d = d_min + (d_max - d_min) * i / (column_directions - 1);
            const double mu =
                d > 0 ? std::clamp((horizon * horizon - rho * rho - d * d) / (2 * r * d), -1.0, 1.0)
                      : 1;
            Columns sum;
            constexpr int steps = 200;
            for (int s = 0; s < steps; ++s) {
                const double t = d * (s + 0.5) / steps;
                const double height = std::sqrt(r * r + t * t + 2 * r * t * mu) - ground_radius;
                const Columns at = density(std::max(0.0, height));
                sum.air += at.air * d / steps;
                sum.haze += at.haze * d / steps;
                sum.ozone += at.ozone * d / steps;
            }
            columns_[static_cast<std::size_t>(j * column_directions + i)] = sum;
        }
    });
}

Atmosphere::Columns Atmosphere::columns_to_space(double r, double mu) const {
    const double horizon = std::sqrt(top_radius * top_radius - ground_radius * ground_radius);
    const double rho = std::sqrt(std::max(0.0, r * r - ground_radius * ground_radius));
    const double d = distance_to_shell(r, mu, top_radius);
    const double d_min = top_radius - r, d_max = rho + horizon;
    Columns c;
    bilinear((d - d_min) / (d_max - d_min), rho / horizon, column_directions, column_heights,
             [&](std::size_t i, double weight) {
                 c.air += weight * columns_[i].air;
                 c.haze += weight * columns_[i].haze;
                 c.ozone += weight * columns_[i].ozone;
             });
    return c;
}

Atmosphere::Spectrum Atmosphere::transmittance(double height, double mu) const {
    const double r = ground_radius + std::max(0.0, height);
    // The disc of the sun sinks below the horizon gradually.
    const double horizon = -std::sqrt(std::max(0.0, 1 - std::pow(ground_radius / r, 2)));
    const double visible = std::clamp((mu - horizon) / sun_angular_diameter + 0.5, 0.0, 1.0);
    Spectrum t{};
    if (visible <= 0) return t;
    t = attenuation(columns_to_space(r, std::max(mu, horizon)));
    for (double& x : t) x *= visible;
    return t;
}

template <class F>
bool Atmosphere::walk(double height, const Vec3d& direction, int steps, Spectrum& reaches,
                      Vec3d& end, F&& f) const {
    const Vec3d origin{0, 0, ground_radius + height};
    const bool grounded = meets_ground(origin.z, direction.z);
    const double reach = grounded ? distance_to_ground(origin.z, direction.z)
                                  : distance_to_shell(origin.z, direction.z, top_radius);
    reaches.fill(1);
    Step step;
    for (int s = 0; s < steps; ++s) {
        // Pieces grow with the distance, as the air is densest near the ground.
        const double t0 = reach * s * s / (steps * steps);
        const double t1 = reach * (s + 1) * (s + 1) / (steps * steps);
        step.length = t1 - t0;
        step.point = origin + 0.5 * (t0 + t1) * direction;
        step.height = std::max(0.0, length(step.point) - ground_radius);
        step.density = density(step.height);
        step.through = attenuation({step.density.air * step.length, step.density.haze * step.length,
                                    step.density.ozone * step.length});
        f(step, reaches);
        for (std::size_t b = 0; b < bands; ++b) reaches[b] *= step.through[b];
    }
    end = origin + reach * direction;
    return grounded;
}

Atmosphere::Spectrum Atmosphere::radiance(double height, const Vec3d& direction,
                                          const Vec3d& sun) const {
    const double cosine = dot(direction, sun);
    const double phase_air = rayleigh_phase(cosine);
    const auto phase_haze =
        static_cast<double>(HenyeyGreensteinPhase{static_cast<float>(haze_mean_cosine)}.value(
            static_cast<float>(cosine)));
    Spectrum sum{};
    Spectrum arrives;
    Vec3d end;
    const bool grounded =
        walk(height, direction, 32, arrives, end, [&](const Step& step, const Spectrum& reaches) {
            const double mu_sun = dot(step.point, sun) / length(step.point);
            const Spectrum lit = transmittance(step.height, mu_sun);
            const Spectrum psi = multiple_scattering(step.height, mu_sun);
            for (std::size_t b = 0; b < bands; ++b) {
                const double air = air_[b] * step.density.air;
                const double haze = haze_scatter_[b] * step.density.haze;
                const double extinction =
                    air + haze_[b] * step.density.haze + ozone_[b] * step.density.ozone;
                if (!(extinction > 0)) continue;
                const double source =
                    lit[b] * (air * phase_air + haze * phase_haze) + psi[b] * (air + haze);
                sum[b] += solar_[b] * reaches[b] * source * (1 - step.through[b]) / extinction;
            }
        });
    if (grounded) {
        // The ground is lit by the sun and, about evenly, by the scattered light above it.
        const double mu_sun = dot(end, sun) / length(end);
        const Spectrum lit = transmittance(0, mu_sun), psi = multiple_scattering(0, mu_sun);
        for (std::size_t b = 0; b < bands; ++b) {
            const double irradiance = lit[b] * std::max(0.0, mu_sun) + pi * psi[b];
            sum[b] += solar_[b] * arrives[b] * ground_albedo_ / pi * irradiance;
        }
    }
    return sum;
}

void Atmosphere::build_multiple_scattering() {
    multiple_.resize(multiple_heights * multiple_directions);
    parallel_for(multiple_heights * multiple_directions, 1, [&](int n) {
        const double x = static_cast<double>(n % multiple_directions) / (multiple_directions - 1);
        const double y = static_cast<double>(n / multiple_directions) / (multiple_heights - 1);
        const double height = y * y * (top_radius - ground_radius) * 0.999;
        scatter_all_orders(height, 2 * x - 1, multiple_[static_cast<std::size_t>(n)]);
    });
}

// Light of second order that arrives at a point, and the share f of isotropic light around the
// point that comes back after one more scattering; all orders are a geometric series in f.
void Atmosphere::scatter_all_orders(double height, double mu_sun, Spectrum& psi) const {
    const Vec3d sun{std::sqrt(std::max(0.0, 1 - mu_sun * mu_sun)), 0, mu_sun};
    constexpr int rings = 8, spokes = 8, steps = 20;
    constexpr double isotropic = 0.25 / pi;
    Spectrum second{}, again{};
    for (int n = 0; n < rings * spokes; ++n) {
        const double z = 1 - 2 * (n / spokes + 0.5) / rings,
                     turn = pi * (n % spokes + 0.5) / spokes;
        const double sine = std::sqrt(1 - z * z);
        Spectrum arrives;
        Vec3d end;
        const bool grounded = walk(
            height, {sine * std::cos(turn), sine * std::sin(turn), z}, steps, arrives, end,
            [&](const Step& step, const Spectrum& reaches) {
                const Spectrum lit =
                    transmittance(step.height, dot(step.point, sun) / length(step.point));
                for (std::size_t b = 0; b < bands; ++b) {
                    const double scatter =
                        air_[b] * step.density.air + haze_scatter_[b] * step.density.haze;
                    const double extinction = air_[b] * step.density.air +
                                              haze_[b] * step.density.haze +
                                              ozone_[b] * step.density.ozone;
                    if (!(extinction > 0)) continue;
                    const double share = reaches[b] * scatter * (1 - step.through[b]) / extinction;
                    second[b] += share * lit[b] * isotropic;
                    again[b] += share;
                }
            });
        if (!grounded) continue;
        const double mu_ground = dot(end, sun) / length(end);
        const Spectrum lit = transmittance(0, mu_ground);
        for (std::size_t b = 0; b < bands; ++b) {
            second[b] += arrives[b] * lit[b] * std::max(0.0, mu_ground) * ground_albedo_ / pi;
        }
    }
    // Means over the directions: the phase function 1 / 4 pi integrated over the sphere.
    for (std::size_t b = 0; b < bands; ++b) {
        const double mean = second[b] / (rings * spokes), f = again[b] / (rings * spokes);
        psi[b] = mean / (1 - f);
    }
}

Atmosphere::Spectrum Atmosphere::multiple_scattering(double height, double mu_sun) const {
    Spectrum psi{};
    const double y = std::sqrt(height / (0.999 * (top_radius - ground_radius)));
    bilinear(0.5 * (mu_sun + 1), y, multiple_directions, multiple_heights,
             [&](std::size_t i, double weight) {
                 for (std::size_t b = 0; b < bands; ++b) psi[b] += weight * multiple_[i][b];
             });
    return psi;
}

}  // namespace gischt
