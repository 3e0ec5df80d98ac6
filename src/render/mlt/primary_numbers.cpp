// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/primary_numbers.h"

#include <cmath>

#include "base/units.h"

namespace gischt {

PrimaryNumbers::PrimaryNumbers(std::uint64_t start) : start_(start), key_(start) {}

void PrimaryNumbers::propose(bool is_large) {
    ++now_;
    only_ = every;
    kept_large_ = last_large_;
    if (is_large) last_large_ = now_;
}

void PrimaryNumbers::propose_track(std::size_t track) {
    propose(false);
    only_ = track;
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

// Around [0, 1), by a normal number (Box & Muller 1958).
float PrimaryNumbers::moved(float value, double sigma) {
    const double u = 1 - static_cast<double>(draw()), turn = static_cast<double>(draw());
    const double x =
        static_cast<double>(value) + sigma * std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * turn);
    const auto wrapped = static_cast<float>(x - std::floor(x));
    return wrapped < 1 ? wrapped : 0.0f;
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
        before.value = last_large_ > 0 ? draw()
                                       : random_uniform(random_key(start_, track),
                                                        static_cast<std::uint32_t>(place));
        before.changed = last_large_;
    }
    if (before.changed == now_) {
        // New: should the proposal be rejected, what was here is still to be made up for.
        n.kept = n.value;
        n.kept_changed = n.changed;
        n.value = before.value;
    } else {
        // Small steps that were accepted since, which sum to one of sqrt(n) sigma; they stay.
        if (const auto owed = static_cast<double>(now_ - 1 - before.changed); owed > 0) {
            before.value = moved(before.value, std::sqrt(owed) * sigma_);
        }
        n.kept = before.value;
        n.kept_changed = now_ - 1;
        n.value = only_ == every   ? moved(before.value, sigma_)
                  : only_ == track ? draw()
                                   : before.value;
    }
    n.changed = now_;
    return n.value;
}

}  // namespace gischt
