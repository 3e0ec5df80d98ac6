// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/zonal/zone_sweep.h"

namespace gischt {

// The exchange factors between all zones that scatter and all patches that reflect (Hottel &
// Sarofim 1967; Rushmeier & Torrance 1987), with the attenuation along the way: what arrives at i
// per unit of source of j, G_ij = integral over both of T / r^2, times the cosine of each that is a
// patch. They are summed along the lines of the enclosure, exactly on each; G is symmetric. Zones
// without scattering take part in the attenuation only.
class ExchangeMatrix {
  public:
    // `scatters` by element. Throws Error{Resource} when it does not fit into `limit` bytes.
    ExchangeMatrix(const Enclosure& enclosure, const std::vector<bool>& scatters,
                   std::int64_t limit, Job& job);

    // Bytes for so many elements.
    static std::int64_t bytes(std::size_t elements, bool is_grey) {
        const auto n = static_cast<std::int64_t>(elements);
        return n * n * 4 * (is_grey ? 1 : 3);
    }

    std::size_t size() const { return element_.size(); }
    // The element of a row.
    std::size_t element(std::size_t row) const { return element_[row]; }
    std::span<const float> row(std::size_t i, int channel) const {
        const std::size_t plane = is_grey_ ? 0 : static_cast<std::size_t>(channel);
        return {values_.data() + (plane * size() + i) * size(), size()};
    }

  private:
    struct Term {
        std::uint32_t row = 0;
        Vec3f l, m, transmittance;
    };
    void add_piece(std::span<const Term> terms, float weight, std::size_t first, std::size_t last);

    bool is_grey_ = true;
    std::vector<std::size_t> element_;
    std::vector<float> values_;  // channel by channel, row by row
};

}  // namespace gischt
