// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/parallel.h"
#include "solve/dense_inverse.h"
#include "solve/kernels.h"

namespace gischt {

// Calls f(TileRange) for all active tiles of a level, in parallel where there are enough of them.
template <class F>
void for_active(const StencilLevel& level, F&& f) {
    // A tile takes about a microsecond, to wake a thread several.
    constexpr int grain = 16;
    const int count = static_cast<int>(level.active.size());
    if (count < 2 * grain) {
        f(TileRange{level, 0, count});
    } else {
        parallel_ranges(count, grain, [&](int begin, int end) { f(TileRange{level, begin, end}); });
    }
}

// The hierarchy of levels of a stencil operator, and one V-cycle over it as preconditioner: one
// red-black Gauss-Seidel sweep before and one, in reverse order, after each correction, so that it
// is symmetric and positive definite. Since the sweep before starts from zero and the one after
// overwrites the black cells, the V-cycle never stores a full vector twice: see kernels.h.
class Multigrid {
  public:
    explicit Multigrid(const StencilSpec& spec);

    const StencilLevel& finest() const { return levels_.front(); }
    const std::vector<StencilLevel>& levels() const { return levels_; }

    // z = M r on the finest level, with red z = d r given (advance and smooth_red_first do so);
    // returns r . z.
    double precondition(const SplitField& r, SplitField& z);

  private:
    void cycle(std::size_t depth, const SplitField& r, SplitField& z);
    // The sweep after the correction, on level `depth`; fills sums_ on the finest.
    void smooth_after(std::size_t depth, const SplitField& r, SplitField& z);

    std::vector<StencilLevel> levels_;
    std::vector<SplitField> r_, z_;     // of levels 1 and up; entry 0 stays empty
    std::vector<SplitField> residual_;  // of levels with periodic copies
    DenseInverse bottom_;
    bool has_bottom_ = false;
    std::vector<double> sums_;
};

}  // namespace gischt
