// SPDX-License-Identifier: Apache-2.0
#include "optics/ggx_energy.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/quadrature.h"
#include "math/sobol.h"
#include "optics/fresnel.h"
#include "optics/ggx.h"

namespace gischt {
namespace {

constexpr int cosines = 48, indices = 33;  // indices: odd, so that eta = 1 is a node
constexpr int samples = 512;
const double log_eta_max = std::log(4.0);

// The scattering angles at grazing incidence need the finer steps.
double node_cosine(int i) {
    const double x = static_cast<double>(i) / cosines;
    return std::max(1e-4, x * x);
}

Vec3d towards(double cosine) {
    return {std::sqrt(1 - cosine * cosine), 0, cosine};
}

double node_position(double cosine) {
    return std::sqrt(std::clamp(cosine, 0.0, 1.0)) * cosines;
}

// Linear between values[i] and values[i + 1], at `position` in units of i.
double between(const double* values, double position) {
    const int i = std::min(static_cast<int>(position), cosines - 1);
    const double s = position - i;
    return (1 - s) * values[i] + s * values[i + 1];
}

double reflected_energy(double alpha, double eta, double cosine) {
    const auto fresnel = [eta](double c) { return eta > 0 ? fresnel_dielectric(c, eta) : 1.0; };
    if (alpha == 0) return fresnel(cosine);
    const Ggx ggx{alpha};
    const Vec3d out = towards(cosine);
    double sum = 0;
    for (int s = 0; s < samples; ++s) {
        const Vec3d h = ggx.sample(out, sobol_2d(static_cast<std::uint32_t>(s), 11));
        const double c = std::max(0.0, dot(out, h));
        const Vec3d in = 2 * c * h - out;
        if (in.z > 0) sum += fresnel(c) * ggx.masking(out, in) / ggx.masking(out);
    }
    return sum / samples;
}

double passed_energy(double alpha, double eta, double cosine) {
    const Ggx ggx{alpha};
    const Vec3d out = towards(cosine);
    double sum = 0;
    for (int s = 0; s < samples; ++s) {
        const Vec3d h = ggx.sample(out, sobol_2d(static_cast<std::uint32_t>(s), 11));
        const double c = dot(out, h);
        if (c <= 0) continue;
        const double f = fresnel_dielectric(c, eta);
        const Vec3d mirrored = 2 * c * h - out;
        if (mirrored.z > 0) sum += f * ggx.masking(out, mirrored) / ggx.masking(out);
        const auto bent = refracted(out, h, eta);
        if (bent && bent->z < 0) sum += (1 - f) * ggx.masking(*bent);
    }
    return sum / samples;
}

}  // namespace

EnergyTable::EnergyTable(double alpha, double eta) : values_(cosines + 1) {
    for (int i = 0; i <= cosines; ++i) {
        values_[static_cast<std::size_t>(i)] = reflected_energy(alpha, eta, node_cosine(i));
    }
    // The mean of what at() gives, so that plastic loses nothing to interpolation.
    const GaussLegendre rule(4);
    for (int i = 0; i < cosines; ++i) {
        mean_ += rule.integrate(i, i + 1, [&](double position) {
            const double x = position / cosines;
            const double e = alpha == 0 && eta > 0 ? fresnel_dielectric(x * x, eta)
                                                   : between(values_.data(), position);
            return e * 4 * x * x * x / cosines;  // 2 cos dcos
        });
    }
}

double EnergyTable::at(double cosine) const {
    return between(values_.data(), node_position(cosine));
}

DielectricEnergyTable::DielectricEnergyTable(double alpha)
    : values_(static_cast<std::size_t>(indices) * (cosines + 1)) {
    parallel_for(indices, 1, [&](int k) {
        const double eta = std::exp(log_eta_max * (2.0 * k / (indices - 1) - 1));
        double* row = values_.data() + static_cast<std::size_t>(k) * (cosines + 1);
        for (int i = 0; i <= cosines; ++i) {
            row[i] = 2 * k == indices - 1 ? 1 : passed_energy(alpha, eta, node_cosine(i));
        }
    });
}

double DielectricEnergyTable::at(double cosine, double eta) const {
    const double position =
        (std::log(std::clamp(eta, 0.25, 4.0)) / log_eta_max + 1) * 0.5 * (indices - 1);
    const int k = std::clamp(static_cast<int>(position), 0, indices - 2);
    const double s = position - k, x = node_position(cosine);
    const double* row = values_.data() + static_cast<std::size_t>(k) * (cosines + 1);
    return (1 - s) * between(row, x) + s * between(row + cosines + 1, x);
}

}  // namespace gischt
