// SPDX-License-Identifier: Apache-2.0
#include "optics/phase.h"

#include <fmt/format.h>

#include "base/error.h"

namespace gischt {

double SchlickPhase::mean_cosine() const {
    // (1 - k^2)/2 times the integral of x / (1 - k x)^2 over [-1, 1]; below |k| = 0.02 its two
    // terms cancel and the series takes over (next term: 4 k^5 / 35, 4e-10).
    const double q = static_cast<double>(k);
    if (std::abs(q) < 0.02) return q * (2.0 / 3 - 2.0 / 15 * q * q);
    return 1 / q + (1 - q * q) / (2 * q * q) * std::log((1 - q) / (1 + q));
}

PhaseFunction make_phase(PhaseKind kind, double g) {
    if (!(g > -1 && g < 1)) {
        throw Error(ErrorKind::Usage, "phase function", fmt::format("g is {}", g),
                    "it must be greater than -1 and less than 1");
    }
    const float mean = static_cast<float>(g);
    switch (kind) {
        case PhaseKind::Isotropic:
            return IsotropicPhase{};
        case PhaseKind::HenyeyGreenstein:
            return HenyeyGreensteinPhase{mean};
        case PhaseKind::Schlick:
            return SchlickPhase::of_g(mean);
    }
    return IsotropicPhase{};
}

PhaseSample sample(const PhaseFunction& phase, const Vec3f& forward, Vec2f u) {
    const auto [cosine, pdf] = std::visit(
        [&](const auto& p) {
            const float c = p.sample_cosine(u.x);
            return std::pair(c, p.value(c));
        },
        phase);
    const float sine = std::sqrt(std::fmax(0.0f, 1 - cosine * cosine));
    const float turn = static_cast<float>(2 * pi) * u.y;
    Vec3f s, t;
    orthonormal_frame(forward, s, t);
    return {cosine * forward + sine * (std::cos(turn) * s + std::sin(turn) * t), pdf};
}

double mean_cosine(const PhaseFunction& phase) {
    return std::visit([](const auto& p) { return p.mean_cosine(); }, phase);
}

}  // namespace gischt
