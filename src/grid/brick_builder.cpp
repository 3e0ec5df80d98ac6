// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "grid/brick_volume.h"

namespace gischt {

namespace {

constexpr int edge = BrickVolume::brick_edge, row = BrickVolume::row;
constexpr int brick_samples = row * row * row;
using Samples = std::array<float, brick_samples>;

// What a first look at a brick finds.
struct Survey {
    float min = 0, max = 0;
    unsigned occupied = 0;
    int non_finite = 0;
    double magnitude = 0;  // sum of |value| over the brick's own samples
    int count = 0;         // of those that are not 0
};

Vec3i page_of(const Vec3i& brick) {
    return {brick.x >> 3, brick.y >> 3, brick.z >> 3};
}

// Reads samples of one field; shared by all threads.
struct SampleReader {
    const TileField<float>& values;
    float background;
    bool non_negative;

    // The 9^3 samples of a brick. Returns how many of its own 8^3 were not finite.
    int read(const Vec3i& brick, Samples& out) const {
        out.fill(background);
        const TileMap& map = values.map();
        const Vec3i first = brick * edge;
        const Box3i region{first, first + Vec3i(row)};
        const Vec3i lo = map.shape().tile_of(region.lo),
                    hi = map.shape().tile_of(region.hi - Vec3i(1));
        int bad = 0;
        for (int tz = lo.z; tz <= hi.z; ++tz) {
            for (int ty = lo.y; ty <= hi.y; ++ty) {
                for (int tx = lo.x; tx <= hi.x; ++tx) {
                    const int tile = map.find({tx, ty, tz});
                    if (tile >= 0) bad += copy(tile, region, out);
                }
            }
        }
        return bad;
    }

  private:
    float clean(float v) const { return non_negative && v < 0 ? 0.0f : v; }

    int copy(int tile, const Box3i& region, Samples& out) const {
        const TileMap& map = values.map();
        const Box3i part = intersection(region, map.cells_of(tile));
        if (part.is_empty()) return 0;
        const Vec3i first = map.first_cell(tile);
        const float* in = values.tile(tile);
        int bad = 0;
        for (int z = part.lo.z; z < part.hi.z; ++z) {
            for (int y = part.lo.y; y < part.hi.y; ++y) {
                const float* from = in + map.shape().index(0, y - first.y, z - first.z) - first.x;
                float* to =
                    out.data() + row * ((y - region.lo.y) + row * (z - region.lo.z)) - region.lo.x;
                // A sample of the apron is counted by the brick that it is the first of.
                const bool own_row = y - region.lo.y < edge && z - region.lo.z < edge;
                for (int x = part.lo.x; x < part.hi.x; ++x) {
                    if (std::isfinite(from[x])) {
                        to[x] = clean(from[x]);
                    } else {
                        bad += own_row && x - region.lo.x < edge;
                    }
                }
            }
        }
        return bad;
    }
};

// Bounds and mean of the interpolant over block b. The mean is that of the trapezoid rule, which
// is exact: end samples weigh half.
BrickVolume::Block block_of(const Samples& s, int b) {
    const int x0 = 4 * (b & 1), y0 = 4 * (b >> 1 & 1), z0 = 4 * (b >> 2);
    constexpr double weight[5] = {0.125, 0.25, 0.25, 0.25, 0.125};
    float lo = std::numeric_limits<float>::max(), hi = std::numeric_limits<float>::lowest();
    double mean = 0;
    for (int k = 0; k < 5; ++k) {
        for (int j = 0; j < 5; ++j) {
            const float* r = s.data() + x0 + row * (y0 + j + row * (z0 + k));
            double sum = 0;
            for (int i = 0; i < 5; ++i) {
                lo = std::min(lo, r[i]);
                hi = std::max(hi, r[i]);
                sum += weight[i] * static_cast<double>(r[i]);
            }
            mean += weight[j] * weight[k] * sum;
        }
    }
    return {lo, static_cast<float>(mean), hi};
}

}  // namespace

// Fills a BrickVolume in two passes: a survey tells which bricks to keep and how, a second reading
// packs them.
struct BrickBuilder {
    const Field& field;
    const BrickOptions& options;
    Job& job;
    BrickVolume& volume;
    SampleReader reader;
    std::vector<Vec3i> candidates{};
    std::vector<Survey> surveys{};
    // Whose blocks are kept whatever is in them.
    const BrickVolume* partner = options.like ? options.like : options.also;

    void build() {
        volume.background_ = reader.background;
        volume.min_ = volume.max_ = reader.background;
        volume.to_world_ = field.to_world * Transform::scale_translate(1, Vec3d(0.5));
        volume.to_lattice_ = volume.to_world_.inverse();
        list_candidates();
        survey();
        keep();
        pack();
        find_support();
    }

    // Bricks in reach of a tile: sample i matters for q in ]i - 1, i + 1[.
    void list_candidates() {
        const TileMap& map = field.map();
        const auto bricks_of = [](const Box3i& cells) {
            const Vec3i a = cells.lo - Vec3i(1), b = cells.hi - Vec3i(1);
            return Box3i{{a.x >> 3, a.y >> 3, a.z >> 3},
                         Vec3i(b.x >> 3, b.y >> 3, b.z >> 3) + Vec3i(1)};
        };
        Box3i all = Box3i::empty();
        for (int t = 0; t < map.size(); ++t) {
            const Box3i cells = map.cells_of(t);
            if (!cells.is_empty() && !options.like) all.extend(bricks_of(cells));
        }
        if (partner && partner->size() > 0) all.extend(partner->brick_bounds());
        if (all.is_empty()) return;
        make_pages(all);
        for (int t = 0; t < map.size(); ++t) {
            const Box3i cells = map.cells_of(t);
            if (!cells.is_empty() && !options.like) mark(bricks_of(cells));
        }
        for (int b = 0; partner && b < partner->size(); ++b) {
            const Vec3i c = partner->coord(b);
            mark({c, c + Vec3i(1)});
        }
        collect();
    }

    void make_pages(const Box3i& bricks) {
        volume.brick_bounds_ = bricks;
        volume.page_box_ = {page_of(bricks.lo), page_of(bricks.hi - Vec3i(1)) + Vec3i(1)};
        const Vec3d n = Vec3d(volume.page_box_.hi) - Vec3d(volume.page_box_.lo);
        if (n.x * n.y * n.z > 2.5e8) {  // 1 GB
            throw Error(ErrorKind::Resource, "brick volume",
                        fmt::format("the values span {:.0f} x {:.0f} x {:.0f} cells", n.x * 64,
                                    n.y * 64, n.z * 64),
                        "cut the far parts off");
        }
        // Page 0 is the empty one, which all of space shares.
        volume.pages_.assign(gischt::volume(volume.page_box_.size()), 0);
        volume.table_.assign(BrickVolume::page_size, -1);
    }

    std::size_t page_slot(const Vec3i& page) const {
        const Vec3i p = page - volume.page_box_.lo, n = volume.page_box_.size();
        return static_cast<std::size_t>(p.x) +
               static_cast<std::size_t>(n.x) *
                   (static_cast<std::size_t>(p.y) +
                    static_cast<std::size_t>(n.y) * static_cast<std::size_t>(p.z));
    }

    std::int32_t& entry(const Vec3i& b) {
        const auto page = static_cast<std::size_t>(volume.pages_[page_slot(page_of(b))]);
        return volume.table_[page * BrickVolume::page_size +
                             static_cast<std::size_t>((b.x & 7) + 8 * (b.y & 7) + 64 * (b.z & 7))];
    }

    // A marked entry is 0 until bricks are numbered.
    void mark(const Box3i& bricks) {
        for (int z = bricks.lo.z; z < bricks.hi.z; ++z) {
            for (int y = bricks.lo.y; y < bricks.hi.y; ++y) {
                for (int x = bricks.lo.x; x < bricks.hi.x; ++x) {
                    std::int32_t& page = volume.pages_[page_slot(page_of({x, y, z}))];
                    if (page == 0) {
                        page = static_cast<std::int32_t>(volume.table_.size() /
                                                         BrickVolume::page_size);
                        volume.table_.resize(volume.table_.size() + BrickVolume::page_size, -1);
                    }
                    entry({x, y, z}) = 0;
                }
            }
        }
    }

    // Candidates page by page, so that neighbours lie near each other in memory.
    void collect() {
        const Box3i& box = volume.page_box_;
        for (int pz = box.lo.z; pz < box.hi.z; ++pz) {
            for (int py = box.lo.y; py < box.hi.y; ++py) {
                for (int px = box.lo.x; px < box.hi.x; ++px) {
                    if (volume.pages_[page_slot({px, py, pz})] != 0) collect_page({px, py, pz});
                }
            }
        }
    }
    void collect_page(const Vec3i& page) {
        for (int i = 0; i < BrickVolume::page_size; ++i) {
            const Vec3i b = page * 8 + Vec3i(i & 7, i >> 3 & 7, i >> 6);
            if (entry(b) == 0) candidates.push_back(b);
        }
    }

    void survey() {
        surveys.resize(candidates.size());
        parallel_for(static_cast<int>(candidates.size()), 16, [&](int c) {
            if (c % 256 == 0) job.check();
            const Vec3i& brick = candidates[static_cast<std::size_t>(c)];
            Survey& s = surveys[static_cast<std::size_t>(c)];
            Samples samples;
            s.non_finite = reader.read(brick, samples);
            const auto [lo, hi] = std::minmax_element(samples.begin(), samples.end());
            s.min = *lo;
            s.max = *hi;
            for (int i = 0; i < edge * edge * edge; ++i) {
                const float v = samples[static_cast<std::size_t>(
                    (i & 7) + row * ((i >> 3 & 7) + row * (i >> 6)))];
                s.magnitude += std::abs(static_cast<double>(v));
                s.count += v != 0;
            }
            for (int b = 0; b < BrickVolume::brick_blocks; ++b) {
                const BrickVolume::Block block = block_of(samples, b);
                if (block.min != reader.background || block.max != reader.background) {
                    s.occupied |= 1u << b;
                }
            }
            const int other = partner ? partner->find(brick) : -1;
            if (other >= 0) s.occupied |= partner->occupied(other);
        });
    }

    // Sixteen bits are too coarse where a brick's step is more than 1/1000 of the field's typical
    // value, which takes an outlier.
    bool needs_float() const {
        if (options.storage != BrickOptions::Storage::Auto) {
            return options.storage == BrickOptions::Storage::Full;
        }
        double magnitude = 0, range = 0;
        std::int64_t count = 0;
        for (const Survey& s : surveys) {
            magnitude += s.magnitude;
            count += s.count;
            range = std::max(range, static_cast<double>(s.max) - static_cast<double>(s.min));
        }
        return count > 0 && range / 131070 > 1e-3 * magnitude / static_cast<double>(count);
    }

    // Numbers the bricks that have anything in them.
    void keep() {
        const bool full = needs_float();
        std::size_t kept = 0;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            const Survey& s = surveys[c];
            volume.non_finite_ += s.non_finite;
            entry(candidates[c]) = s.occupied ? static_cast<std::int32_t>(kept) : -1;
            if (!s.occupied) continue;
            surveys[kept] = s;
            candidates[kept++] = candidates[c];
        }
        candidates.resize(kept);
        volume.coord_ = candidates;
        volume.blocks_.resize(kept * BrickVolume::brick_blocks);
        volume.whole_.resize(kept);
        volume.occupied_.resize(kept);
        volume.decode_.resize(kept);
        (full ? volume.full_.resize(kept * BrickVolume::samples)
              : volume.compact_.resize(kept * BrickVolume::samples));
    }

    void pack() {
        parallel_for(volume.size(), 16, [&](int b) {
            if (b % 256 == 0) job.check();
            Samples samples;
            reader.read(volume.coord(b), samples);
            pack_samples(b, samples);
            pack_blocks(b, samples);
        });
    }

    // Stores the samples and leaves in them what a look-up will read.
    void pack_samples(int b, Samples& samples) {
        const auto brick = static_cast<std::size_t>(b);
        if (!volume.is_compact()) {
            std::copy(samples.begin(), samples.end(),
                      volume.full_.data() + brick * BrickVolume::samples);
            return;
        }
        const Survey& s = surveys[brick];
        const double range = static_cast<double>(s.max) - static_cast<double>(s.min);
        const auto scale = static_cast<float>(range / 65535);
        volume.decode_[brick] = {s.min, scale};
        std::uint16_t* out = volume.compact_.data() + brick * BrickVolume::samples;
        const double to_code = scale > 0 ? 1 / static_cast<double>(scale) : 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double code =
                (static_cast<double>(samples[i]) - static_cast<double>(s.min)) * to_code + 0.5;
            out[i] = static_cast<std::uint16_t>(std::min(code, 65535.0));
            samples[i] = s.min + scale * static_cast<float>(out[i]);
        }
    }

    // Bounds are widened by the rounding of seven linear interpolations, below 1e-6 of the largest
    // value; 0 stays 0, as an interpolant of numbers from 0 on never gets below.
    void pack_blocks(int b, const Samples& samples) {
        const int other = partner ? partner->find(volume.coord(b)) : -1;
        unsigned occupied = other >= 0 ? partner->occupied(other) : 0u;
        const Survey& s = surveys[static_cast<std::size_t>(b)];
        const float rounding = 1e-6f * std::max(std::abs(s.min), std::abs(s.max));
        BrickVolume::Block whole{std::numeric_limits<float>::max(), 0,
                                 std::numeric_limits<float>::lowest()};
        for (int i = 0; i < BrickVolume::brick_blocks; ++i) {
            BrickVolume::Block block = block_of(samples, i);
            if (block.min != reader.background || block.max != reader.background) {
                occupied |= 1u << i;
            }
            if (block.min != block.max) {
                block.min =
                    block.min >= 0 ? std::max(0.0f, block.min - rounding) : block.min - rounding;
                block.max += rounding;
            }
            volume.blocks_[static_cast<std::size_t>(b * BrickVolume::brick_blocks + i)] = block;
            whole.min = std::min(whole.min, block.min);
            whole.mean += block.mean / BrickVolume::brick_blocks;
            whole.max = std::max(whole.max, block.max);
        }
        volume.whole_[static_cast<std::size_t>(b)] = whole;
        volume.occupied_[static_cast<std::size_t>(b)] = static_cast<std::uint8_t>(occupied);
    }

    void find_support() {
        Box3i support = Box3i::empty();
        for (int b = 0; b < volume.size(); ++b) {
            for (int i = 0; i < BrickVolume::brick_blocks; ++i) {
                if (!(volume.occupied(b) >> i & 1)) continue;
                const Vec3i lo = volume.coord(b) * edge + 4 * Vec3i(i & 1, i >> 1 & 1, i >> 2);
                support.extend(Box3i{lo, lo + Vec3i(4)});
                volume.min_ = std::min(volume.min_, volume.block(b, i).min);
                volume.max_ = std::max(volume.max_, volume.block(b, i).max);
            }
        }
        volume.support_ = volume.size() > 0 ? support : Box3i{};
    }
};

BrickVolume::BrickVolume(const Field& field, const BrickOptions& options, Job& job) {
    const auto axis = static_cast<std::size_t>(options.axis);
    GISCHT_ASSERT(axis < field.component.size());
    float background = std::isfinite(field.background[axis]) ? field.background[axis] : 0.0f;
    if (options.non_negative) background = std::max(background, 0.0f);
    BrickBuilder builder{
        field, options, job, *this, {field.component[axis], background, options.non_negative}};
    builder.build();
}

}  // namespace gischt
