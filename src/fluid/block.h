// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "grid/gather.h"

namespace gischt {

// The unit of work of all sweeps: 2 x 2 x 2 tiles, which is 16^3 cells in 3-D and 64 x 32 in 2-D. A
// sweep gathers a block with a halo into dense scratch memory that stays in the cache, computes
// there with constant strides, and scatters the result into the tiles. A halo of 2 doubles the
// values of a block; of a tile it would quadruple them.
class BlockMap {
  public:
    // `map` must be a box map.
    explicit BlockMap(TileMap::Ptr map);

    int size() const { return static_cast<int>(blocks_.size()); }
    const TileMap& tiles() const { return *map_; }
    Vec3i extent() const { return extent_; }
    const Vec3i& coord(int b) const { return blocks_[static_cast<std::size_t>(b)].coord; }
    // The block's cells inside the domain.
    Box3i cells(int b) const {
        const Vec3i lo = coord(b) * extent_;
        return intersection(Box3i{lo, lo + extent_}, map_->bounds());
    }
    // Block coordinates per axis.
    const Vec3i& counts() const { return counts_; }
    // Index of the block at these block coordinates, which must exist.
    int find(const Vec3i& coord) const {
        return table_[static_cast<std::size_t>(coord.x +
                                               counts_.x * (coord.y + counts_.y * coord.z))];
    }
    // The tiles of a block are neighbours in Morton order: [first_tile, end_tile).
    int first_tile(int b) const { return blocks_[static_cast<std::size_t>(b)].first_tile; }
    int end_tile(int b) const { return blocks_[static_cast<std::size_t>(b)].end_tile; }

  private:
    struct Block {
        Vec3i coord;
        int first_tile, end_tile;
    };
    TileMap::Ptr map_;
    Vec3i extent_, counts_;
    std::vector<Block> blocks_;
    std::vector<std::int32_t> table_;
};

// A dense array over a box of cells or faces, x fastest.
struct Lattice {
    Box3i region;

    Vec3i size() const { return region.size(); }
    std::size_t count() const { return volume(size()); }
    std::ptrdiff_t stride_y() const { return size().x; }
    std::ptrdiff_t stride_z() const { return static_cast<std::ptrdiff_t>(size().x) * size().y; }
    std::ptrdiff_t index(const Vec3i& c) const {
        const Vec3i d = c - region.lo;
        return d.x + stride_y() * d.y + stride_z() * d.z;
    }
    // The box of cells grown by `halo`, and by one more at the upper end when it shall hold the
    // faces around those cells; never along z in 2-D.
    static Lattice around(const Box3i& cells, const Vec3i& halo, bool faces, bool is_2d);
};

// Calls f(cell) for all cells of a box, x fastest.
template <class F>
void for_cells(const Box3i& box, F&& f) {
    for (int k = box.lo.z; k < box.hi.z; ++k) {
        for (int j = box.lo.y; j < box.hi.y; ++j) {
            for (int i = box.lo.x; i < box.hi.x; ++i) f(Vec3i(i, j, k));
        }
    }
}

// Calls f(first cell, length) for all rows along x of a box.
template <class F>
void for_rows(const Box3i& box, F&& f) {
    for (int k = box.lo.z; k < box.hi.z; ++k) {
        for (int j = box.lo.y; j < box.hi.y; ++j) f(Vec3i(box.lo.x, j, k), box.hi.x - box.lo.x);
    }
}

// Scratch arrays of one thread, kept from block to block. Each has room for 64 floats beyond its
// end, which are zero, so that vector loads may overrun.
class Scratch {
  public:
    // Array `slot` with at least `count` floats, its content undefined.
    float* array(int slot, std::size_t count);

  private:
    std::vector<AlignedVector<float>> arrays_;
};

// Calls f(block, scratch) for all blocks on all threads.
template <class F>
void for_blocks(const BlockMap& blocks, F&& f) {
    tbb::enumerable_thread_specific<Scratch> scratch;
    parallel_ranges(blocks.size(), 1, [&](int begin, int end) {
        Scratch& mine = scratch.local();
        for (int b = begin; b < end; ++b) f(b, mine);
    });
}

// Like gather() and gather_faces() of grid/gather.h, with the same values: the existing part is
// copied in whole rows of tiles, the borders are then mirrored inside `out`.
void gather_block(const TileField<float>& field, const Lattice& lattice, const Borders& borders,
                  float* out);
void gather_block_faces(const FaceField& field, int axis, const Lattice& lattice,
                        const Borders& borders, float* out);

// Writes the block's cells of a dense array to the tiles. For faces the domain's last faces are
// written by the block that has them.
void scatter_block(const BlockMap& blocks, int block, const Lattice& lattice, const float* in,
                   TileField<float>& field);
void scatter_block_faces(const BlockMap& blocks, int block, int axis, const Lattice& lattice,
                         const float* in, FaceField& field);

// Fills the tiles of a block with zeros.
void clear_block(const BlockMap& blocks, int block, TileField<float>& field);

}  // namespace gischt
