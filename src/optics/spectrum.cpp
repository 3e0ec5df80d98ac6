// SPDX-License-Identifier: Apache-2.0
#include "optics/spectrum.h"

#include <array>

#include "image/primaries.h"

namespace gischt {
namespace {

// CIE 1931 2-degree standard observer, 380 to 780 nm every 5 nm (CIE 15:2004, table T.4).
constexpr std::array<Vec3d, observer_entries> table{{
    {0.001368, 0.000039, 0.006450}, {0.002236, 0.000064, 0.010550}, {0.004243, 0.000120, 0.020050},
    {0.007650, 0.000217, 0.036210}, {0.014310, 0.000396, 0.067850}, {0.023190, 0.000640, 0.110200},
    {0.043510, 0.001210, 0.207400}, {0.077630, 0.002180, 0.371300}, {0.134380, 0.004000, 0.645600},
    {0.214770, 0.007300, 1.039050}, {0.283900, 0.011600, 1.385600}, {0.328500, 0.016840, 1.622960},
    {0.348280, 0.023000, 1.747060}, {0.348060, 0.029800, 1.782600}, {0.336200, 0.038000, 1.772110},
    {0.318700, 0.048000, 1.744100}, {0.290800, 0.060000, 1.669200}, {0.251100, 0.073900, 1.528100},
    {0.195360, 0.090980, 1.287640}, {0.142100, 0.112600, 1.041900}, {0.095640, 0.139020, 0.812950},
    {0.057950, 0.169300, 0.616200}, {0.032010, 0.208020, 0.465180}, {0.014700, 0.258600, 0.353300},
    {0.004900, 0.323000, 0.272000}, {0.002400, 0.407300, 0.212300}, {0.009300, 0.503000, 0.158200},
    {0.029100, 0.608200, 0.111700}, {0.063270, 0.710000, 0.078250}, {0.109600, 0.793200, 0.057250},
    {0.165500, 0.862000, 0.042160}, {0.225750, 0.914850, 0.029840}, {0.290400, 0.954000, 0.020300},
    {0.359700, 0.980300, 0.013400}, {0.433450, 0.994950, 0.008750}, {0.512050, 1.000000, 0.005750},
    {0.594500, 0.995000, 0.003900}, {0.678400, 0.978600, 0.002750}, {0.762100, 0.952000, 0.002100},
    {0.842500, 0.915400, 0.001800}, {0.916300, 0.870000, 0.001650}, {0.978600, 0.816300, 0.001400},
    {1.026300, 0.757000, 0.001100}, {1.056700, 0.694900, 0.001000}, {1.062200, 0.631000, 0.000800},
    {1.045600, 0.566800, 0.000600}, {1.002600, 0.503000, 0.000340}, {0.938400, 0.441200, 0.000240},
    {0.854450, 0.381000, 0.000190}, {0.751400, 0.321000, 0.000100}, {0.642400, 0.265000, 0.000050},
    {0.541900, 0.217000, 0.000030}, {0.447900, 0.175000, 0.000020}, {0.360800, 0.138200, 0.000010},
    {0.283500, 0.107000, 0},        {0.218700, 0.081600, 0},        {0.164900, 0.061000, 0},
    {0.121200, 0.044580, 0},        {0.087400, 0.032000, 0},        {0.063600, 0.023200, 0},
    {0.046770, 0.017000, 0},        {0.032900, 0.011920, 0},        {0.022700, 0.008210, 0},
    {0.015840, 0.005723, 0},        {0.011359, 0.004102, 0},        {0.008111, 0.002929, 0},
    {0.005790, 0.002091, 0},        {0.004109, 0.001484, 0},        {0.002899, 0.001047, 0},
    {0.002049, 0.000740, 0},        {0.001440, 0.000520, 0},        {0.001000, 0.000361, 0},
    {0.000690, 0.000249, 0},        {0.000476, 0.000172, 0},        {0.000332, 0.000120, 0},
    {0.000235, 0.000085, 0},        {0.000166, 0.000060, 0},        {0.000117, 0.000042, 0},
    {0.000083, 0.000030, 0},        {0.000059, 0.000021, 0},        {0.000042, 0.000015, 0},
}};

constexpr std::array<Vec3d, observer_entries> make_weights() {
    double luminous = 0;
    for (const Vec3d& entry : table) luminous += entry.y;
    std::array<Vec3d, observer_entries> weights{};
    for (std::size_t i = 0; i < weights.size(); ++i) {
        weights[i] = ((visible_max - visible_min) / luminous) * table[i];
    }
    return weights;
}
constexpr std::array<Vec3d, observer_entries> weights = make_weights();

// White point of the flat spectrum: (1/3, 1/3) up to the rounding of the table.
Vec2d flat_white() {
    Vec3d sum;
    for (const Vec3d& w : weights) sum += w;
    return chromaticity(sum);
}

struct Matrices {
    Transform to_rgb, to_xyz;

    Matrices() {
        Primaries flat = rec709_primaries;
        flat.white = flat_white();
        to_rgb = convert_primaries(flat, rec709_primaries) * rgb_to_xyz(flat).inverse();
        to_xyz = to_rgb.inverse();
    }
};

const Matrices& matrices() {
    static const Matrices m;
    return m;
}

}  // namespace

Vec3d observer(double wavelength) {
    const double x = (wavelength - visible_min) / observer_step;
    if (!(x >= 0 && x <= observer_entries - 1)) return {};
    const auto i = std::min(static_cast<std::size_t>(x), table.size() - 2);
    const double t = x - static_cast<double>(i);
    return (1 - t) * table[i] + t * table[i + 1];
}

const Vec3d& observer_weight(int i) {
    return weights[static_cast<std::size_t>(i)];
}

Vec2d chromaticity(const Vec3d& xyz) {
    const double sum = xyz.x + xyz.y + xyz.z;
    return {xyz.x / sum, xyz.y / sum};
}

Vec3d adapted_xyz_to_rgb(const Vec3d& xyz) {
    return matrices().to_rgb.vector(xyz);
}

Vec3d rgb_to_adapted_xyz(const Vec3d& rgb) {
    return matrices().to_xyz.vector(rgb);
}

}  // namespace gischt
