// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace gischt {

Error::Error(ErrorKind kind, std::string where, std::string what, std::string hint)
    : kind_(kind), where_(std::move(where)), what_(std::move(what)), hint_(std::move(hint)) {
    if (!where_.empty()) text_ = where_ + ": ";
    text_ += what_;
    if (!hint_.empty()) text_ += "; " + hint_;
}

static std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t n = b.size() + 1;
    std::vector<std::size_t> before(n), last(n), row(n);
    for (std::size_t j = 0; j < n; ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j < n; ++j) {
            const std::size_t cost = a[i - 1] == b[j - 1] ? 0 : 1;
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + cost});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

std::string nearest_word(std::string_view word, std::span<const std::string> valid) {
    std::size_t best = word.size() / 3 + 2;
    std::string nearest;
    for (const std::string& candidate : valid) {
        const std::size_t d = edit_distance(word, candidate);
        if (d < best) {
            best = d;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string hint_for(std::string_view word, std::span<const std::string> valid) {
    const std::string near = nearest_word(word, valid);
    if (!near.empty()) return fmt::format("did you mean '{}'?", near);
    return fmt::format("valid: {}", fmt::join(valid, ", "));
}

}  // namespace gischt
