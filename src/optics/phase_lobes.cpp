// SPDX-License-Identifier: Apache-2.0
#include "optics/phase_lobes.h"

namespace gischt {
namespace {

// The Moebius transformation of the unit ball that takes c to the origin (Ahlfors 1981, "Moebius
// transformations in several dimensions"); move(-c, .) is its inverse.
Vec3d move(const Vec3d& c, const Vec3d& p) {
    const Vec3d d = p - c;
    const double cc = dot(c, c);
    return ((1 - cc) * d - dot(d, d) * c) / (1 + cc * dot(p, p) - 2 * dot(c, p));
}

template <class... F>
struct Cases : F... {
    using F::operator()...;
};
template <class... F>
Cases(F...) -> Cases<F...>;

}  // namespace

// With the points at +q e and -q e the density in the cosine c to e is
// (1 + |m|^2 + 2 m.w) / ((1 + q^2)^2 - 4 q^2 c^2)^(3/2), m the midpoint, as dw takes a factor
// |w + m|^2 from the transformation. The even part has a cumulative that can be inverted; of the
// pair w, -w one is then chosen by the linear factor.
Vec3d sample_between(const Vec3d& a, float of_a, const Vec3d& b, float of_b, const Vec3f& u) {
    const auto g = static_cast<double>(of_a), h = static_cast<double>(of_b);
    const auto v = Vec3d(u);
    const Vec3d x = g * a, y = h * b;
    const Vec3d way = move(x, y);
    // 1 - |way|^2 without cancellation.
    const double rest = (1 - g * g) * (1 - h * h) / (1 + g * g * h * h - 2 * dot(x, y));
    const double half = 1 / (1 + std::sqrt(rest));
    const double q = std::sqrt(std::fmax(0, 1 - rest)) * half;
    const Vec3d m = move(-x, way * half);
    const Vec3d e = q > 1e-6 ? move(m, y) / q : a;

    const double A = 1 + q * q, B = 2 * q;
    const double c = v.x * A / std::sqrt((1 - q * q) * (1 - q * q) + v.x * v.x * B * B);
    const double s = std::sqrt(std::fmax(0, 1 - c * c));
    const float turn = static_cast<float>(2 * pi) * u.y;
    const auto along = static_cast<double>(std::cos(turn)),
               across = static_cast<double>(std::sin(turn));
    Vec3d e1, e2;
    orthonormal_frame(e, e1, e2);
    Vec3d w = c * e + s * (along * e1 + across * e2);
    const double mm = dot(m, m), slope = 2 * dot(m, w);
    if (2 * (1 + mm) * v.z >= 1 + mm + slope) w = -w;
    return move(-m, w);
}

PhaseLobes PhaseLobes::of(const PhaseFunction& phase) {
    PhaseLobes p;
    std::visit(
        Cases{[](const IsotropicPhase&) {}, [&](const RayleighPhase&) { p.lobes[0].alpha = 1; },
              [&](const HenyeyGreensteinPhase& f) { p.lobes[0].g = f.g; },
              [&](const SchlickPhase& f) {
                  p.lobes[0].g = static_cast<float>(f.mean_cosine());
                  p.lobes[0].k = f.k;
              },
              [&](const TwoLobePhase& f) {
                  p.lobes = {{{f.first.g, f.weight}, {f.second.g, 1 - f.weight}}};
                  p.count = 2;
              },
              [&](const MiePhase& f) {
                  p.lobes = {{{f.peak.g, 1 - f.weight}, {f.rest.g, f.weight, f.rest.alpha}}};
                  p.count = 2;
              }},
        phase);
    constexpr float forgotten = 0.35f;
    for (int i = 0; i < p.count; ++i) {
        const Lobe& lobe = p.lobes[static_cast<std::size_t>(i)];
        p.mean_turn += lobe.weight * std::abs(lobe.g);
    }
    for (float left = p.mean_turn; left > forgotten && p.memory < longest - 2;
         left *= p.mean_turn) {
        ++p.memory;
    }
    return p;
}

float kernel_factor(const PhaseLobes::Lobe& lobe, float cosine) {
    if (lobe.alpha == 0 && lobe.k == 0) return 1;
    if (lobe.k != 0) {
        return SchlickPhase{lobe.k}.value(cosine) / HenyeyGreensteinPhase{lobe.g}.value(cosine);
    }
    return (1 + lobe.alpha * cosine * cosine) / (1 + lobe.alpha * (1 + 2 * lobe.g * lobe.g) / 3);
}

}  // namespace gischt
