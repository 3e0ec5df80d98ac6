// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/job.h"
#include "grid/frame.h"
#include "math/box.h"

namespace gischt {

class BrickVolume;

// Points entry + t[i] step of one brick, for the look-up of many at once; a value is offset + scale
// times the stored number.
struct BrickLine {
    Vec3f entry, step;
    float offset, scale;
    const float* t;
    int count;
};

// How a field is packed.
struct BrickOptions {
    enum class Storage {
        Auto,     // 16 bits unless a brick holds an outlier that would make them too coarse
        Compact,  // 16 bits: a brick's range in 65535 steps
        Full,     // float
    };
    Storage storage = Storage::Auto;
    int axis = 0;               // component of a vector field
    bool non_negative = false;  // values below 0 count as 0
    // Blocks in which this volume (on the same lattice) has values are kept, even if the field has
    // only its background there. Null is allowed.
    const BrickVolume* also = nullptr;
};

// A packed, read-only copy of a field for rendering.
//
// The lattice: sample i lies at q = i, the centre of cell i of the field, and a value at any q is
// the trilinear interpolant of the eight samples around it (Field::sample). Brick b is the
// interpolant over q in [8b, 8b + 8): it stores the 9^3 samples 8b .. 8b + 8, so that a look-up
// never leaves it. Bricks in which the interpolant is the background throughout are not stored.
// In a compact volume a sample is offset + scale * code with offset and scale per brick: wrong by
// at most 1/131070 of the brick's range; the brick's smallest value is exact, so empty space
// stays empty.
//
// A brick has eight blocks of 4^3 interpolation cells; each knows the minimum, mean and maximum of
// the interpolant in it. Samples that are not finite count as the background.
class BrickVolume {
  public:
    static constexpr int brick_edge = 8;  // interpolation cells along a brick's edge
    static constexpr int row = 9;         // samples along it
    static constexpr int samples = 736;   // 9^3, padded to a multiple of 32 bytes
    static constexpr int brick_blocks = 8;

    // Bounds of the interpolant over a block, and its mean.
    struct Block {
        float min = 0, mean = 0, max = 0;
    };

    BrickVolume() = default;  // the constant 0
    // Work and memory are proportional to the field's tiles. Throws Error{Resource} when the tiles
    // are too far apart for the look-up table.
    BrickVolume(const Field& field, const BrickOptions& options, Job& job);

    int size() const { return static_cast<int>(coord_.size()); }
    bool is_compact() const { return full_.empty(); }
    float background() const { return background_; }
    // Samples that were not finite.
    std::int64_t non_finite() const { return non_finite_; }
    // Bytes of the samples, statistics and tables.
    std::size_t bytes() const;
    // From q to metres.
    const Transform& to_world() const { return to_world_; }
    const Transform& to_lattice() const { return to_lattice_; }
    // Edge of a cell in metres, the smallest of the three.
    double cell_size() const;
    // The stored bricks' coordinates, half-open; empty when there are none.
    const Box3i& brick_bounds() const { return brick_bounds_; }
    // Box around the blocks that have values, in q, half-open.
    const Box3i& support() const { return support_; }
    Box3d world_bounds() const;

    const Vec3i& coord(int brick) const { return coord_[static_cast<std::size_t>(brick)]; }
    // Index of the brick at these brick coordinates, or -1: there the value is the background.
    int find(const Vec3i& brick_coord) const;
    // Block b of a brick covers x 4 (b & 1), y 4 (b >> 1 & 1), z 4 (b >> 2) and the next 4 cells.
    const Block& block(int brick, int b) const {
        return blocks_[static_cast<std::size_t>(brick * brick_blocks + b)];
    }
    // Over the whole brick.
    const Block& whole(int brick) const { return whole_[static_cast<std::size_t>(brick)]; }
    // Bit b: block b differs from the background (or is kept for `also`).
    unsigned occupied(int brick) const { return occupied_[static_cast<std::size_t>(brick)]; }
    // Over all blocks.
    float max() const { return max_; }
    float min() const { return min_; }

    // The interpolant at q; in a brick at `local` = q - 8b, which rounding may take slightly out of
    // [0,8]; at a point in metres.
    float at(const Vec3d& q) const;
    float at_local(int brick, const Vec3f& local) const;
    float sample(const Vec3d& world) const { return at(to_lattice_.point(world)); }
    // out[i] = at_local(brick, entry + t[i] * step) for i < n, several at a time.
    void along(int brick, const Vec3f& entry, const Vec3f& step, const float* t, int n,
               float* out) const;

  private:
    friend struct BrickBuilder;

    // Bricks of page p, 8^3 of them, at table_[512 p ...]; pages_ covers page_box_.
    static constexpr int page_log = 3, page_size = 512;

    Transform to_world_, to_lattice_;
    float background_ = 0, min_ = 0, max_ = 0;
    std::int64_t non_finite_ = 0;
    Box3i brick_bounds_{}, support_{}, page_box_{};
    std::vector<std::int32_t> pages_, table_;
    std::vector<Vec3i> coord_;
    std::vector<Block> blocks_, whole_;
    std::vector<std::uint8_t> occupied_;
    std::vector<Vec2f> decode_;             // per brick: offset, scale
    AlignedVector<std::uint16_t> compact_;  // `samples` per brick, x fastest, then y, then z
    AlignedVector<float> full_;
};

inline float BrickVolume::at_local(int brick, const Vec3f& local) const {
    // The cell and the place in it.
    const auto inside = [](float q) { return std::min(std::max(q, 0.0f), float{brick_edge}); };
    const Vec3f q(inside(local.x), inside(local.y), inside(local.z));
    const auto cell = [](float v) { return std::min(static_cast<int>(v), brick_edge - 1); };
    const int i = cell(q.x), j = cell(q.y), k = cell(q.z);
    const float x = q.x - static_cast<float>(i), y = q.y - static_cast<float>(j),
                z = q.z - static_cast<float>(k);
    const std::size_t first = static_cast<std::size_t>(brick) * samples +
                              static_cast<std::size_t>(i + row * (j + row * k));
    // The two samples of each of the four rows around it, a row per lane (the vector types that g++
    // and clang share).
    using Floats = float __attribute__((vector_size(16)));
    using Ints = std::int32_t __attribute__((vector_size(16)));
    constexpr std::size_t above = row, behind = row * row;
    Floats left, right;
    if (is_compact()) {
        const std::uint16_t* s = compact_.data() + first;
        const auto both = [s](std::size_t at) {
            std::int32_t codes;
            std::memcpy(&codes, s + at, sizeof codes);
            return codes;
        };
        const Ints codes{both(0), both(above), both(behind), both(behind + above)};
        left = __builtin_convertvector(codes & 0xffff, Floats);
        right = __builtin_convertvector((codes >> 16) & 0xffff, Floats);
    } else {
        const float* s = full_.data() + first;
        left = Floats{s[0], s[above], s[behind], s[behind + above]};
        right = Floats{s[1], s[above + 1], s[behind + 1], s[behind + above + 1]};
    }
    const Floats v = left + (right - left) * x;
    const float near = v[0] + (v[1] - v[0]) * y, far = v[2] + (v[3] - v[2]) * y;
    const float value = near + (far - near) * z;
    if (!is_compact()) return value;
    const Vec2f d = decode_[static_cast<std::size_t>(brick)];
    return d.x + d.y * value;
}

}  // namespace gischt
