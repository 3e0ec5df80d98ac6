// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "optics/phase.h"

namespace gischt {

// Henyey-Greenstein is the kernel of a semigroup on the sphere: n turns with mean cosines g1..gn
// turn together like one of g1 g2 .. gn (its Legendre moments are the powers of g). So the law of
// the first direction of a chain whose last one is known is a product of two of them.

// A direction w of length 1 (to 1e-6) with the density HG_g(a.w) HG_h(w.b) / HG_gh(a.b) for unit a
// and b, g and h in
// ]-1,1[; u in [0,1)^3. Exact and without rejection: g a and h b are points of the unit ball, each
// factor is 1 / |w - point|^3, and the Moebius transformation of the ball that puts the two points
// on either side of the origin leaves a density that is even in w but for a factor linear in w.
Vec3d sample_between(const Vec3d& a, float g, const Vec3d& b, float h, const Vec3f& u);

// A phase function as a mixture of lobes, each Henyey-Greenstein times a factor near 1.
struct PhaseLobes {
    struct Lobe {
        float g = 0;       // mean cosine of the kernel
        float weight = 1;  // of the lobe; they sum to 1
        float alpha = 0;   // Draine's, or
        float k = 0;       // Schlick's
    };
    std::array<Lobe, 2> lobes;
    int count = 1;
    float mean_turn = 0;  // mean of |g| over the lobes
    // Turns after which the direction is all but forgotten: the kernel of one more has a mean
    // cosine of 0.35 or less. 0: one turn is enough for that.
    int memory = 0;
    static constexpr int longest = 26;  // chain: two more than the longest memory

    static PhaseLobes of(const PhaseFunction& phase);

    // `random()` gives a number in [0,1), and is asked only where there is a choice.
    template <class Random>
    const Lobe& pick(Random&& random) const {
        return lobes[count == 2 && random() >= lobes[0].weight ? 1 : 0];
    }
};

// The lobe's value over that of its kernel.
float kernel_factor(const PhaseLobes::Lobe& lobe, float cosine);

}  // namespace gischt
