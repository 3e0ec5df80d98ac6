// SPDX-License-Identifier: Apache-2.0
#include "optics/harmonics.h"

#include "base/units.h"

namespace gischt {

std::array<double, 9> harmonic_basis(const Vec3d& d) {
    return {0.28209479177387814,
            0.4886025119029199 * d.y,
            0.4886025119029199 * d.z,
            0.4886025119029199 * d.x,
            1.0925484305920792 * d.x * d.y,
            1.0925484305920792 * d.y * d.z,
            0.31539156525252005 * (3 * d.z * d.z - 1),
            1.0925484305920792 * d.x * d.z,
            0.5462742152960396 * (d.x * d.x - d.y * d.y)};
}

Vec3f Harmonics::weighted(const Vec3d& direction, float degree_0, float degree_1,
                          float degree_2) const {
    const std::array<double, 9> basis = harmonic_basis(direction);
    Vec3f sum;
    for (std::size_t i = 0; i < 9; ++i) {
        const float factor = i == 0 ? degree_0 : i < 4 ? degree_1 : degree_2;
        sum += factor * static_cast<float>(basis[i]) * coefficient[i];
    }
    return sum;
}

Vec3f Harmonics::radiance(const Vec3d& direction) const {
    return weighted(direction, 1, 1, 1);
}

Vec3f Harmonics::lobe(const Vec3d& direction, float g) const {
    return max(weighted(direction, 1, g, g * g), Vec3f(0));
}

Vec3f Harmonics::irradiance(const Vec3d& normal) const {
    constexpr auto p = static_cast<float>(pi);
    return max(weighted(normal, p, p * 2 / 3, p / 4), Vec3f(0));
}

Vec3f Harmonics::mean() const {
    return coefficient[0] * 0.28209479f;
}

}  // namespace gischt
