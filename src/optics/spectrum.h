// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace gischt {

// From spectra to the renderer's one unit.
//
// A spectrum L(lambda) in W/(m^2 sr nm) becomes XYZ by the CIE 1931 2-degree observer, scaled such
// that 1 W/(m^2 sr) spread evenly over the visible 400 nm from 380 to 780 nm has Y = 1:
//     XYZ = 400 nm * integral of L (x, y, z) / integral of y.
// XYZ becomes linear Rec.709 after a Bradford adaptation from the white of the flat spectrum
// (x = y = 1/3) to D65, as a camera's white balance would do it: the flat spectrum of radiance
// 1 W/(m^2 sr) is (1, 1, 1), as grey surfaces are grey. Chromaticities are those of XYZ, before it.

inline constexpr double visible_min = 380, visible_max = 780;  // nm

// Colour matching functions x, y, z at a wavelength in nm (CIE 15:2004, 5 nm, linear between); zero
// outside of the visible range.
Vec3d observer(double wavelength);

// The radiance of a spectrum, f(wavelength in nm) in W/(m^2 sr nm), as XYZ in W/(m^2 sr). Exact for
// the table, trapezoidal for f: f must be smooth over 5 nm.
template <class F>
Vec3d spectrum_to_xyz(F&& f);

// x and y of XYZ.
Vec2d chromaticity(const Vec3d& xyz);

// Radiance: XYZ of spectrum_to_xyz to linear Rec.709 and back, white-balanced as said above. May be
// negative for saturated colours.
Vec3d adapted_xyz_to_rgb(const Vec3d& xyz);
Vec3d rgb_to_adapted_xyz(const Vec3d& rgb);

// Number of entries of the observer's table and their distance in nm.
inline constexpr int observer_entries = 81;
inline constexpr double observer_step = 5;
// Entry i times the factor that makes sum f(380 nm + 5 nm i) weight(i) the XYZ in W/(m^2 sr).
const Vec3d& observer_weight(int i);

template <class F>
Vec3d spectrum_to_xyz(F&& f) {
    Vec3d sum;
    for (int i = 0; i < observer_entries; ++i) {
        sum += static_cast<double>(f(visible_min + observer_step * i)) * observer_weight(i);
    }
    return sum;
}

}  // namespace gischt
