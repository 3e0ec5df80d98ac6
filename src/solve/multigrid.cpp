// SPDX-License-Identifier: Apache-2.0
#include "solve/multigrid.h"

#include "solve/transfer.h"

namespace gischt {

Multigrid::Multigrid(const StencilSpec& spec) {
    levels_.push_back(make_finest(spec));
    const auto is_small = [&] { return volume(levels_.back().cells) <= DenseInverse::max_cells; };
    while (!is_small() && static_cast<int>(levels_.size()) < spec.max_levels) {
        levels_.push_back(make_coarser(levels_.back()));
    }
    has_bottom_ = is_small();
    if (has_bottom_) bottom_ = DenseInverse(levels_.back());
    r_.resize(levels_.size());
    z_.resize(levels_.size());
    for (std::size_t l = 1; l < levels_.size(); ++l) {
        r_[l] = SplitField(levels_[l].tiles_with_ghosts);
        z_[l] = SplitField(levels_[l].tiles_with_ghosts);
    }
    residual_.resize(levels_.size());
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        if (!levels_[l].copies.empty()) residual_[l] = SplitField(levels_[l].tiles_with_ghosts);
    }
    sums_.resize(levels_[0].active.size());
}

double Multigrid::precondition(const SplitField& r, SplitField& z) {
    cycle(0, r, z);
    if (levels_.size() == 1 && has_bottom_) {
        for_active(levels_[0], [&](const TileRange& range) { dot(range, r, z, sums_); });
    }
    return tree_sum(sums_);
}

void Multigrid::cycle(std::size_t depth, const SplitField& r, SplitField& z) {
    const StencilLevel& level = levels_[depth];
    if (depth + 1 == levels_.size()) {
        if (has_bottom_) return bottom_.apply(r, z);
        return smooth_after(depth, r, z);
    }
    const StencilLevel& coarse = levels_[depth + 1];
    SplitField &coarse_r = r_[depth + 1], &coarse_z = z_[depth + 1];
    const bool wraps = !level.copies.empty();

    // Black after red, from zero; the residual that this leaves, on the red cells only unless an
    // odd period makes cells of one colour neighbours.
    fill_ghosts(level, z, true);
    for_active(level, [&](const TileRange& range) { smooth(range, {1, false}, r, z, {}); });
    fill_ghosts(level, z);
    if (wraps) {
        for_active(level, [&](const TileRange& range) { residual(range, r, z, residual_[depth]); });
        restrict_wrapped(level, coarse, residual_[depth], coarse_r);
    } else {
        for_active(level, [&](const TileRange& range) { red_residual(range, z); });
        for_active(level,
                   [&](const TileRange& range) { restrict_red(range, coarse, z, coarse_r); });
    }

    // The coarser level's share.
    for_active(coarse,
               [&](const TileRange& range) { smooth_red_first(range, coarse_r, coarse_z); });
    cycle(depth + 1, coarse_r, coarse_z);
    if (wraps) {
        prolong_wrapped(level, coarse, coarse_z, z);
    } else {
        fill_ghosts(coarse, coarse_z);
        for_active(level,
                   [&](const TileRange& range) { prolong_red(range, coarse, coarse_z, r, z); });
    }
    smooth_after(depth, r, z);
}

void Multigrid::smooth_after(std::size_t depth, const SplitField& r, SplitField& z) {
    const StencilLevel& level = levels_[depth];
    const std::span<double> sums = depth == 0 ? std::span<double>(sums_) : std::span<double>();
    fill_ghosts(level, z, depth + 1 == levels_.size());
    for_active(level, [&](const TileRange& range) { smooth(range, {1, false}, r, z, sums); });
    fill_ghosts(level, z);
    for_active(level, [&](const TileRange& range) { smooth(range, {0, true}, r, z, sums); });
}

}  // namespace gischt
