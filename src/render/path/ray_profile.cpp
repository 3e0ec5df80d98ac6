// SPDX-License-Identifier: Apache-2.0
#include "render/path/ray_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/color.h"
#include "math/fast_math.h"

namespace gischt {
namespace {

constexpr float enough = 24;           // optical depth, behind which nothing is seen
constexpr int most_halvings = 16;      // float resolves no finer parts of a cell
constexpr float gauss = 0.211324865f;  // (1 - 1/sqrt(3)) / 2

Vec3f negative_exp(const Vec3f& depth, bool is_grey) {
    if (is_grey) return Vec3f(fast_exp(-depth.x));
    return {fast_exp(-depth.x), fast_exp(-depth.y), fast_exp(-depth.z)};
}

// 1 - exp(-x) without cancellation.
float opacity(float x) {
    return x < 1e-3f ? x * (1 - 0.5f * x) : 1 - fast_exp(-x);
}

// Integral of a density over s metres within a piece, from `begin` along its segment.
float partial_integral(const ActiveMedium& a, float begin, float s) {
    return 0.5f * s *
           (a.medium->density_at(a.segment, begin + gauss * s) +
            a.medium->density_at(a.segment, begin + (1 - gauss) * s));
}

}  // namespace

void RayProfile::trace(std::span<const Medium* const> media, const Ray& ray, bool is_grey,
                       std::int64_t& lookups) {
    is_grey_ = is_grey;
    channels_ = 0;
    depth_ = {};
    runs_.clear();
    active_.clear();
    pieces_.clear();
    MediaWalk walk(media, ray, BrickGrain::Bricks);
    MediaRun run;
    while (walk.next(run)) {
        add_run(run, lookups);
        if (min_component(depth_) > enough) break;
    }
    for (int c = 0; c < (is_grey ? 1 : 3); ++c) {
        if (depth_[c] > 0) channel_[static_cast<std::size_t>(channels_++)] = c;
    }
}

// The pieces of a run lie between the cell walls of all its media.
void RayProfile::add_run(const MediaRun& run, std::int64_t& lookups) {
    // In place of infinity, which must not meet a 0.
    const float length = std::min(static_cast<float>(run.t1 - run.t0), 1e30f);
    bool is_plain = true;
    edges_.clear();
    for (const ActiveMedium& a : run.active) {
        if (a.segment.min == a.segment.max) continue;
        is_plain = false;
        const std::size_t had = edges_.size();
        const auto begin = static_cast<float>(run.t0 - a.segment.anchor);
        edges_.resize(had + most_cell_crossings);
        const int n = a.medium->cell_crossings_of(a.segment, begin, begin + length,
                                                  {edges_.data() + had, most_cell_crossings});
        edges_.resize(had + static_cast<std::size_t>(n));
        for (std::size_t i = had; i < edges_.size(); ++i) edges_[i] -= begin;
        if (had > 0) {
            std::inplace_merge(edges_.begin(), edges_.begin() + static_cast<std::ptrdiff_t>(had),
                               edges_.end());
        }
    }
    if (is_plain && run.max == 0 && run.emission_max == 0) return;
    edges_.push_back(length);

    const auto run_index = static_cast<std::uint32_t>(runs_.size());
    runs_.push_back({run.t0, run.t1, active_.size(), run.active.size()});
    active_.insert(active_.end(), run.active.begin(), run.active.end());
    const std::size_t first = pieces_.size();
    float begin = 0;
    for (const float end : edges_) {
        if (!(end > begin)) continue;
        pieces_.push_back({run.t0 + static_cast<double>(begin), end - begin, run_index, {}, {}, 0});
        begin = end;
    }
    const std::size_t count = pieces_.size() - first;
    t_.resize(2 * count);
    densities_.resize(2 * count);
    for (const ActiveMedium& a : run.active) {
        const auto offset = static_cast<float>(run.t0 - a.segment.anchor);
        for (std::size_t i = 0; i < count; ++i) {
            const Piece& p = pieces_[first + i];
            const float at = offset + static_cast<float>(p.t0 - run.t0);
            t_[2 * i] = at + gauss * p.length;
            t_[2 * i + 1] = at + (1 - gauss) * p.length;
        }
        a.medium->densities(a.segment, t_, densities_.data());
        lookups += static_cast<std::int64_t>(t_.size());
        const Vec3f half = 0.5f * a.medium->cross_sections().extinction();
        for (std::size_t i = 0; i < count; ++i) {
            pieces_[first + i].extinction += (densities_[2 * i] + densities_[2 * i + 1]) * half;
        }
    }
    const bool has_thick = std::any_of(pieces_.begin() + static_cast<std::ptrdiff_t>(first),
                                       pieces_.end(), [](const Piece& p) { return is_thick(p); });
    if (has_thick) return add_thick(first, lookups);
    for (std::size_t i = first; i < pieces_.size(); ++i) {
        Piece& p = pieces_[i];
        p.depth = depth_;
        depth_ += p.length * p.extinction;
    }
}

// The same where a cell is so thick that its mean extinction tells little about where light
// comes from: it is halved until the halves are alike, as far as anything of it is seen.
void RayProfile::add_thick(std::size_t first, std::int64_t& lookups) {
    const auto begin = pieces_.begin() + static_cast<std::ptrdiff_t>(first);
    thick_.assign(std::make_reverse_iterator(pieces_.end()), std::make_reverse_iterator(begin));
    pieces_.resize(first);
    while (!thick_.empty()) {
        Piece p = thick_.back();
        thick_.pop_back();
        if (p.halvings < most_halvings && is_thick(p) && min_component(depth_) < enough) {
            Piece near = p, far = p;
            near.halvings = ++far.halvings;
            near.length = far.length = 0.5f * p.length;
            far.t0 += static_cast<double>(near.length);
            near.extinction = mean_extinction(near, lookups);
            far.extinction = mean_extinction(far, lookups);
            if (max_component(abs(near.extinction - far.extinction)) * near.length > 0.25f) {
                thick_.push_back(far);
                thick_.push_back(near);
                continue;
            }
        }
        p.depth = depth_;
        depth_ += p.length * p.extinction;
        pieces_.push_back(p);
    }
}

Vec3f RayProfile::mean_extinction(const Piece& p, std::int64_t& lookups) const {
    Vec3f sum;
    for (const ActiveMedium& a : active(p)) {
        const auto begin = static_cast<float>(p.t0 - a.segment.anchor);
        sum += (partial_integral(a, begin, p.length) / p.length) *
               a.medium->cross_sections().extinction();
        lookups += 2;
    }
    return sum;
}

// The density with which points() draws places, at s from the beginning of a piece: the mean over
// the channels that have an extinction.
float RayProfile::density_in(const Piece& p, float s) const {
    float sum = 0;
    for (int i = 0; i < channels_; ++i) {
        const int c = channel_[static_cast<std::size_t>(i)];
        sum += p.extinction[c] * fast_exp(-p.depth[c] - s * p.extinction[c]) / opacity(depth_[c]);
    }
    return channels_ > 1 ? sum / static_cast<float>(channels_) : sum;
}

const RayProfile::Piece* RayProfile::find(double t) const {
    auto after = std::upper_bound(pieces_.begin(), pieces_.end(), t,
                                  [](double x, const Piece& p) { return x < p.t0; });
    if (after == pieces_.begin()) return nullptr;
    --after;
    return t <= after->t0 + static_cast<double>(after->length) ? &*after : nullptr;
}

Vec3f RayProfile::depth_to(double t) const {
    if (pieces_.empty() || t <= pieces_.front().t0) return {};
    auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), t,
                                  [](double x, const Piece& p) { return x < p.t0; });
    --piece;
    return piece->depth +
           std::min(static_cast<float>(t - piece->t0), piece->length) * piece->extinction;
}

double RayProfile::end_at(float depth) const {
    const auto piece = std::find_if(pieces_.begin(), pieces_.end(), [depth](const Piece& p) {
        return min_component(p.depth + p.length * p.extinction) > depth;
    });
    if (piece == pieces_.end()) return std::numeric_limits<double>::infinity();
    const Vec3f left = (Vec3f(depth) - piece->depth) / max(piece->extinction, Vec3f(1e-30f));
    return piece->t0 + static_cast<double>(max_component(left));
}

float RayProfile::density(double t) const {
    const Piece* piece = find(t);
    return piece ? density_in(*piece, static_cast<float>(t - piece->t0)) : 0;
}

ProfilePoint RayProfile::at(double t, float pdf, float choose, std::int64_t& lookups) const {
    const Piece* piece = find(t);
    return piece ? make_point(*piece, t, pdf, choose, lookups) : ProfilePoint{t, 0, {}};
}

ProfilePoint RayProfile::make_point(const Piece& piece, double t, float pdf, float choose,
                                    std::int64_t& lookups) const {
    // The exact depth from the piece's beginning, and what scatters there.
    const auto s = static_cast<float>(t - piece.t0);
    const std::span<const ActiveMedium> media = active(piece);
    Vec3f depth = piece.depth;
    std::array<Vec3f, most_media> scattering;
    float total = 0;
    for (std::size_t i = 0; i < media.size(); ++i) {
        const ActiveMedium& a = media[i];
        const auto begin = static_cast<float>(piece.t0 - a.segment.anchor);
        const CrossSections& cross = a.medium->cross_sections();
        depth += partial_integral(a, begin, s) * cross.extinction();
        const float density = a.medium->density_at(a.segment, begin + s);
        scattering[i] = density * cross.scattering;
        if (a.medium->has_color()) {
            scattering[i] = scattering[i] * a.medium->color_at(a.segment, begin + s, density);
        }
        total += luminance(scattering[i]);
        lookups += 3;
    }
    ProfilePoint point{t, 0, {}};
    if (total == 0) return point;
    // Among several media one is drawn by its share.
    std::size_t drawn = 0;
    float share = luminance(scattering[0]);
    while (drawn + 1 < media.size() && choose * total >= share) {
        share += luminance(scattering[++drawn]);
    }
    const float probability = luminance(scattering[drawn]) / total;
    point.medium = media[drawn].index;
    if (probability > 0) {
        point.weight =
            negative_exp(depth, is_grey_) * scattering[drawn] * (1 / (pdf * probability));
    }
    return point;
}

void RayProfile::points(int n, float u, float choose, std::vector<ProfilePoint>& out,
                        std::int64_t& lookups) const {
    if (channels_ == 0) return;
    // Each channel takes its own inverse; the points cycle through the channels, from one that
    // `choose` picks on. What is left of it is uniform again.
    choose *= static_cast<float>(channels_);
    const int first = std::min(static_cast<int>(choose), channels_ - 1);
    choose -= static_cast<float>(first);
    for (int i = 0; i < n; ++i) {
        const int c = channel_[static_cast<std::size_t>((first + i) % channels_)];
        const float place = (static_cast<float>(i) + u) / static_cast<float>(n);
        const float depth = -fast_log(1 - place * opacity(depth_[c]));
        auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), depth,
                                      [c](float x, const Piece& p) { return x < p.depth[c]; });
        if (piece != pieces_.begin()) --piece;
        while (piece->extinction[c] == 0 && piece + 1 != pieces_.end()) ++piece;
        if (piece->extinction[c] == 0) continue;
        const float s =
            std::clamp((depth - piece->depth[c]) / piece->extinction[c], 0.0f, piece->length);
        const double t = piece->t0 + static_cast<double>(s);
        const float pdf = static_cast<float>(n) * density_in(*piece, s);
        const ProfilePoint point = make_point(*piece, t, pdf, choose, lookups);
        if (max_component(point.weight) > 0) out.push_back(point);
    }
}

Vec3f RayProfile::emission(float u, std::int64_t& lookups) const {
    Vec3f sum;
    for (const Piece& p : pieces_) {
        const float s = u * p.length;
        Vec3f depth = p.depth, glow;
        for (const ActiveMedium& a : active(p)) {
            const auto begin = static_cast<float>(p.t0 - a.segment.anchor);
            depth += partial_integral(a, begin, s) * a.medium->cross_sections().extinction();
            lookups += 2;
            if (a.segment.emission_max == 0) continue;
            glow += a.medium->emission_at(a.segment, begin + s,
                                          a.medium->density_at(a.segment, begin + s));
            lookups += 2;
        }
        sum += p.length * negative_exp(depth, is_grey_) * glow;
        u += 0.7548777f;  // a fresh place in each piece, evenly spread (Roberts 2018)
        u -= std::floor(u);
    }
    return sum;
}

}  // namespace gischt
