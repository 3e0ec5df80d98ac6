// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "math/vec.h"

namespace gischt {

// The nine real spherical harmonics of degree 0, 1, 2 in a unit direction, orthonormal over the
// sphere; order: 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2 (Ramamoorthi & Hanrahan 2001).
std::array<double, 9> harmonic_basis(const Vec3d& direction);

// A radiance over the sphere in these harmonics, nine numbers per channel: how it looks through a
// wide lobe.
struct Harmonics {
    std::array<Vec3f, 9> coefficient{};

    // The radiance as far as degree 2 knows it; may be negative beside a strong light.
    Vec3f radiance(const Vec3d& direction) const;
    // Mean of the radiance over a Henyey-Greenstein lobe of mean cosine g around `direction`: what
    // an unshadowed point of such a medium scatters towards -direction, divided by the scattering
    // coefficient. Degree l counts g^l. Not below 0.
    Vec3f lobe(const Vec3d& direction, float g) const;
    // Irradiance on a plane with this normal, W/m^2. Not below 0.
    Vec3f irradiance(const Vec3d& normal) const;
    // Mean over the sphere.
    Vec3f mean() const;

  private:
    Vec3f weighted(const Vec3d& direction, float degree_0, float degree_1, float degree_2) const;
};

}  // namespace gischt
