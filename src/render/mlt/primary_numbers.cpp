// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/primary_numbers.h"

#include <cmath>

#include "base/units.h"

namespace gischt {

PrimaryNumbers::PrimaryNumbers(std::uint64_t start) : start_(start), key_(start) {}

void PrimaryNumbers::propose(bool is_large) {
    ++now_;
    is_large_ = is_large;
    kept_large_ = last_large_;
    if (is_large) last_large_ = now_;
}

void PrimaryNumbers::accept() {}

// Numbers that the proposal has touched go back. Those that it has not are still to be moved by it:
// as nothing came of it they are told to be as they were.
void PrimaryNumbers::reject() {
    for (auto& track : tracks_) {
        for (Number& n : track) {
            if (n.changed != now_) continue;
            n.value = n.kept;
            n.changed = n.kept_changed;
        }
    }
    last_large_ = kept_large_;
    --now_;
}

float PrimaryNumbers::at(std::size_t track, std::size_t place) {
    if (track >= tracks_.size()) tracks_.resize(track + 1);
    auto& numbers = tracks_[track];
    if (place >= numbers.size()) numbers.resize(place + 1);
    Number& n = numbers[place];
    if (n.changed == now_) return n.value;
    Number before = n;
    // As of the last large step, or of the start.
    if (before.changed < last_large_) {
        if (last_large_ == 0) {
            before.value =
                random_uniform(random_key(start_, track), static_cast<std::uint32_t>(place));
        } else {
            before.value = draw();
        }
        before.changed = last_large_;
    }
    // Small steps since then, which sum to one of sqrt(n) sigma (Box & Muller 1958).
    if (const auto steps = static_cast<double>(now_ - before.changed); steps > 0) {
        const bool is_owed = steps > 1;
        const auto moved = [&](float value, double by) {
            const double u = 1 - static_cast<double>(draw()), turn = static_cast<double>(draw());
            double x = static_cast<double>(value) +
                       by * sigma_ * std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * turn);
            x -= std::floor(x);
            const auto wrapped = static_cast<float>(x);
            return wrapped < 1 ? wrapped : 0.0f;
        };
        // What it owes to accepted mutations stays should this one be rejected.
        if (is_owed) {
            before.value = moved(before.value, std::sqrt(steps - 1));
            before.changed = now_ - 1;
        }
        n.kept = before.value;
        n.kept_changed = before.changed;
        n.value = moved(before.value, 1);
    } else {
        // A large step: what was here is kept as it was.
        n.kept = n.value;
        n.kept_changed = n.changed;
        n.value = before.value;
    }
    n.changed = now_;
    return n.value;
}

}  // namespace gischt
