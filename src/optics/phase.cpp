// SPDX-License-Identifier: Apache-2.0
#include "optics/phase.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace gischt {

double SchlickPhase::mean_cosine() const {
    // (1 - k^2)/2 times the integral of x / (1 - k x)^2 over [-1, 1]; below |k| = 0.02 its two
    // terms cancel and the series takes over (next term: 4 k^5 / 35, 4e-10).
    const double q = static_cast<double>(k);
    if (std::abs(q) < 0.02) return q * (2.0 / 3 - 2.0 / 15 * q * q);
    return 1 / q + (1 - q * q) / (2 * q * q) * std::log((1 - q) / (1 + q));
}

DrainePhase DrainePhase::of(double g, double alpha) {
    constexpr double least = 1e-3;
    if (std::abs(g) < least) g = std::copysign(least, g);
    return {static_cast<float>(g), static_cast<float>(alpha)};
}

// With A = 1 + g^2 and B = alpha / (4 g^2) the cumulative of the cosine (A - s^2) / (2 g) is
// k (G(1 + g) - G(s)), G(s) = -(1 + B A^2) / s - 2 A B s + B s^3 / 3. In double: the terms are
// 1/g^3 times their sum.
float DrainePhase::sample_cosine(float u) const {
    const double e = static_cast<double>(g), a = static_cast<double>(alpha);
    const double A = 1 + e * e, B = a / (4 * e * e), C = 1 + B * A * A;
    const double k = (1 - e * e) / (2 * e * (1 + a * (1 + 2 * e * e) / 3));
    const double s0 = 1 + e;  // cosine -1
    const double target =
        -C / s0 - 2 * A * B * s0 + B / 3 * s0 * s0 * s0 - static_cast<double>(u) / k;
    // f(s) = G(s) - target grows with s everywhere; Newton inside a shrinking bracket.
    double low = std::min(1 - e, s0), high = std::max(1 - e, s0);
    double s = std::sqrt(A);
    for (int i = 0; i < 60 && high - low > 1e-9; ++i) {
        const double f = -C / s - 2 * A * B * s + B / 3 * s * s * s - target;
        (f < 0 ? low : high) = s;
        const double cosine = (A - s * s) / (2 * e);
        const double step = f * s * s / (1 + a * cosine * cosine);
        const double next = s - step;
        if (std::abs(step) < 1e-9 * std::abs(e)) break;
        s = next > low && next < high ? next : 0.5 * (low + high);
    }
    return static_cast<float>(std::clamp((A - s * s) / (2 * e), -1.0, 1.0));
}

double DrainePhase::mean_cosine() const {
    const double e = static_cast<double>(g), a = static_cast<double>(alpha);
    return e * (1 + a * (3 + 2 * e * e) / 5) / (1 + a * (1 + 2 * e * e) / 3);
}

double TwoLobePhase::mean_cosine() const {
    const double w = static_cast<double>(weight);
    return w * first.mean_cosine() + (1 - w) * second.mean_cosine();
}

double MiePhase::mean_cosine() const {
    const double w = static_cast<double>(weight);
    return (1 - w) * peak.mean_cosine() + w * rest.mean_cosine();
}

// Equations 4 to 18 of Jendersie & d'Eon 2023 and its supplement, by range of diameters.
MiePhase MiePhase::of_diameter(double d) {
    if (!(d >= least_diameter && d <= largest_diameter)) {
        throw Error(ErrorKind::Usage, "phase function",
                    fmt::format("droplet_diameter is {} micrometres", d),
                    fmt::format("the fit holds from {} to {}; take 'rayleigh' for smaller ones, "
                                "'two_lobe' for larger",
                                least_diameter, largest_diameter));
    }
    double peak, g, alpha, weight;
    const double l = std::log(d);
    if (d >= 5) {
        peak = std::exp(-0.0990567 / (d - 1.67154));
        g = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
        alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825));
        weight = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
    } else if (d >= 1.5) {
        peak = 0.0604931 * std::log(l) + 0.940256;
        g = 0.500411 - 0.081287 / (-2 * l + std::tan(l) + 1.27551);
        alpha = 7.30354 * l + 6.31675;
        weight = 0.026914 * (l - std::cos(5.68947 * (std::log(l) - 0.0292149))) + 0.376475;
    } else if (d > 0.1) {
        const double turn = std::cos((l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l));
        peak = 0.862 - 0.143 * l * l;
        g = 0.379685 * std::cos(1.19692 * turn + 1.37932 * l + 0.0625835) + 0.344213;
        alpha = 250;
        weight = 0.146209 * std::cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l;
    } else {
        peak = 13.8 * d * d;
        g = 1.1456 * d * std::sin(9.29044 * d);
        alpha = 250;
        weight = 0.252977 - 312.983 * std::pow(d, 4.3);
    }
    return {{static_cast<float>(peak)}, DrainePhase::of(g, alpha), static_cast<float>(weight)};
}

// A mean cosine in ]-1,1[.
static HenyeyGreensteinPhase lobe(const char* key, double g) {
    if (!(g > -1 && g < 1)) {
        throw Error(ErrorKind::Usage, "phase function", fmt::format("{} is {}", key, g),
                    "it must be greater than -1 and less than 1");
    }
    return {static_cast<float>(g)};
}

PhaseFunction make_phase(const PhaseParams& p) {
    switch (p.kind) {
        case PhaseKind::Isotropic:
            return IsotropicPhase{};
        case PhaseKind::HenyeyGreenstein:
            return lobe("g", p.g);
        case PhaseKind::Schlick:
            return SchlickPhase::of_g(lobe("g", p.g).g);
        case PhaseKind::Rayleigh:
            return RayleighPhase{};
        case PhaseKind::TwoLobe:
            if (!(p.lobe_weight >= 0 && p.lobe_weight <= 1)) {
                throw Error(ErrorKind::Usage, "phase function",
                            fmt::format("lobe_weight is {}", p.lobe_weight),
                            "it must be from 0 to 1");
            }
            return TwoLobePhase{lobe("g", p.g), lobe("g2", p.g2),
                                static_cast<float>(p.lobe_weight)};
        case PhaseKind::Mie:
            return MiePhase::of_diameter(p.droplet_diameter);
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
