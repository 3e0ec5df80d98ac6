// SPDX-License-Identifier: Apache-2.0
#include "optics/blackbody.h"

#include <cmath>

#include "base/units.h"
#include "image/color.h"
#include "optics/spectrum.h"

namespace gischt {
namespace {

constexpr int table_size = 2048;

}  // namespace

double planck_radiance(double wavelength, double temperature) {
    if (!(temperature > 0)) return 0;
    const double lambda = wavelength * 1e-9;
    constexpr double c1 = 2 * planck * light_speed * light_speed;  // W m^2 / sr
    constexpr double c2 = planck * light_speed / boltzmann;        // m K
    const double per_metre = c1 / std::pow(lambda, 5) / std::expm1(c2 / (lambda * temperature));
    return per_metre * 1e-9;
}

Vec3d blackbody_xyz(double temperature) {
    return spectrum_to_xyz(
        [=](double wavelength) { return planck_radiance(wavelength, temperature); });
}

Vec3f blackbody_radiance(double temperature) {
    return Vec3f(max(adapted_xyz_to_rgb(blackbody_xyz(temperature)), Vec3d(0)));
}

Vec3f blackbody_color(double temperature) {
    const Vec3d rgb = max(adapted_xyz_to_rgb(blackbody_xyz(temperature)), Vec3d(0));
    const double y = luminance(rgb);
    return y > 0 ? Vec3f(rgb / y) : Vec3f(0);
}

BlackbodyTable::BlackbodyTable() : entries_(table_size + 1) {
    constexpr double u0 = 1.0 / hottest, u1 = 1.0 / coldest;
    for (int i = 0; i <= table_size; ++i) {
        const double u = u0 + (u1 - u0) * i / table_size;
        const Vec3d rgb = adapted_xyz_to_rgb(blackbody_xyz(1 / u));
        const double y = luminance(rgb);
        entries_[static_cast<std::size_t>(i)] = {static_cast<float>(std::log(y)), Vec3f(rgb / y)};
    }
}

Vec3f BlackbodyTable::radiance(float temperature) const {
    if (!(temperature >= coldest)) return Vec3f(0);
    constexpr float u0 = 1 / hottest, scale = table_size / (1 / coldest - 1 / hottest);
    const float x = std::fmax(0.0f, (1 / temperature - u0) * scale);
    const auto i = static_cast<std::size_t>(std::fmin(x, table_size - 1.0f));
    const float t = std::fmin(1.0f, x - static_cast<float>(i));
    const Entry &a = entries_[i], &b = entries_[i + 1];
    const float y = std::exp(a.log_luminance + t * (b.log_luminance - a.log_luminance));
    return y * max(a.color + t * (b.color - a.color), Vec3f(0));
}

}  // namespace gischt
