// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "math/vec.h"

namespace gischt {

// Spectral radiance of a black body (Planck 1901) in W/(m^2 sr nm), wavelength in nm, temperature
// in K; zero at or below 0 K.
double planck_radiance(double wavelength, double temperature);

// Its XYZ in W/(m^2 sr), in the scale of spectrum.h: the sum over the observer's table.
Vec3d blackbody_xyz(double temperature);

// The radiance of a black body in the renderer's unit: linear Rec.709, W/(m^2 sr). Components that
// lie outside of the gamut (blue below about 1900 K) are cut to zero.
Vec3f blackbody_radiance(double temperature);

// The colour of a black body as a factor for lights: luminance 1.
Vec3f blackbody_color(double temperature);

// blackbody_radiance by interpolation, for inner loops: one exp per look-up. From 500 K to 15000 K
// within 1e-4 of each non-zero component; black below, and above as 15000 K. (At 500 K the visible
// radiance is 1e-9 of that at 1000 K.) Construction takes some milliseconds.
class BlackbodyTable {
  public:
    static constexpr float coldest = 500, hottest = 15000;  // K

    BlackbodyTable();
    Vec3f radiance(float temperature) const;

  private:
    // At equidistant values of 1/T, in which the logarithm of Planck's law is almost linear.
    struct Entry {
        float log_luminance;
        Vec3f color;  // of luminance 1, before it is cut to the gamut
    };
    std::vector<Entry> entries_;
};

}  // namespace gischt
