// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/exchange_matrix.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"

namespace gischt {
namespace {

constexpr std::uint32_t no_row = 0xffffffff;

Vec3f transmittance_of(const Vec3f& extinction, const Vec3f& l) {
    return Vec3f(1) - extinction * l;
}

}  // namespace

ExchangeMatrix::ExchangeMatrix(const Enclosure& enclosure, const std::vector<bool>& scatters,
                               std::int64_t limit, Job& job)
    : is_grey_(enclosure.grid.is_grey) {
    std::vector<std::uint32_t> row_of(enclosure.elements(), no_row);
    for (std::size_t e = 0; e < scatters.size(); ++e) {
        if (!scatters[e]) continue;
        row_of[e] = static_cast<std::uint32_t>(element_.size());
        element_.push_back(e);
    }
    const std::int64_t needed = bytes(size(), is_grey_);
    if (needed > limit) {
        throw Error(ErrorKind::Resource, "zonal",
                    fmt::format("{} zones and patches have {} million exchange factors, {} MB",
                                size(), needed / 4'000'000, needed >> 20),
                    "raise render.zonal.memory_limit, or take solver = \"sweeps\"");
    }
    values_.resize(static_cast<std::size_t>(needed) / sizeof(float));

    // Each task owns some rows and follows all lines: no two write the same, and each factor is
    // summed in the order of the lines.
    constexpr int tasks = 8;
    const ZoneGrid& grid = enclosure.grid;
    const std::size_t patches = enclosure.first_patch();
    parallel_for(tasks, 1, [&](int task) {
        const std::size_t first = size() * static_cast<std::size_t>(task) / tasks,
                          last = size() * static_cast<std::size_t>(task + 1) / tasks;
        LineTracer tracer(enclosure);
        std::vector<Term> terms;
        const auto add_end = [&](int patch) {
            if (patch < 0) return;
            const std::uint32_t row = row_of[patches + static_cast<std::size_t>(patch)];
            terms.push_back({row, Vec3f(1), Vec3f{}, Vec3f(1)});
        };
        for_lines(enclosure, {0, enclosure.side_cells()}, tracer,
                  [&](const LineTracer& line, const StartingLine& start) {
                      job.check();
                      for (const LinePiece& p : line.pieces) {
                          terms.clear();
                          add_end(p.from_patch);
                          for (std::size_t i = p.first; i < p.last; ++i) {
                              const ZoneCrossing& c = line.crossings[i];
                              Term t;
                              t.row = row_of[c.zone];
                              for (int k = 0; k < 3; ++k) {
                                  const ChordLength chord =
                                      chord_length(grid.extinction[c.zone][k], c.length);
                                  t.l[k] = chord.l;
                                  t.m[k] = chord.m;
                                  if (!grid.is_grey) continue;
                                  t.l = Vec3f(chord.l);
                                  t.m = Vec3f(chord.m);
                                  break;
                              }
                              t.transmittance = transmittance_of(grid.extinction[c.zone], t.l);
                              terms.push_back(t);
                          }
                          add_end(p.to_patch);
                          add_piece(terms, start.weight, first, last);
                      }
                  });
    });
}

// All pairs of a piece, both ways, into the rows [first, last).
void ExchangeMatrix::add_piece(std::span<const Term> terms, float weight, std::size_t first,
                               std::size_t last) {
    const int channels = is_grey_ ? 1 : 3;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const std::uint32_t row = terms[i].row;
        if (row == no_row || row < first || row >= last) continue;
        for (int c = 0; c < channels; ++c) {
            float* out = values_.data() + (static_cast<std::size_t>(c) * size() + row) * size();
            const float here = weight * terms[i].l[c];
            out[row] += 2 * weight * terms[i].m[c];
            float way = here;
            for (std::size_t j = i + 1; j < terms.size() && way > 1e-9f * here; ++j) {
                if (terms[j].row != no_row) out[terms[j].row] += way * terms[j].l[c];
                way *= terms[j].transmittance[c];
            }
            way = here;
            for (std::size_t j = i; j-- > 0 && way > 1e-9f * here;) {
                if (terms[j].row != no_row) out[terms[j].row] += way * terms[j].l[c];
                way *= terms[j].transmittance[c];
            }
        }
    }
}

}  // namespace gischt
