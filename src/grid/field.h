// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <new>
#include <vector>

#include "base/error.h"
#include "grid/tile_map.h"

namespace gischt {

// 64-byte aligned storage, so that every tile starts on a cache line.
template <class T>
struct AlignedAllocator {
    using value_type = T;
    AlignedAllocator() = default;
    template <class U>
    AlignedAllocator(const AlignedAllocator<U>&) {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64)));
    }
    void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
    bool operator==(const AlignedAllocator&) const = default;
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

// One value per cell of a TileMap, tile after tile. Values live at cell centres.
template <class T>
class TileField {
  public:
    TileField() = default;
    explicit TileField(TileMap::Ptr map, T value = T{})
        : map_(std::move(map)),
          values_(static_cast<std::size_t>(map_->size()) * tile_values, value) {}

    const TileMap& map() const { return *map_; }
    const TileMap::Ptr& map_ptr() const { return map_; }
    bool is_empty() const { return values_.empty(); }

    // The 512 values of a tile, 64-byte aligned.
    T* tile(int t) { return values_.data() + static_cast<std::size_t>(t) * tile_values; }
    const T* tile(int t) const {
        return values_.data() + static_cast<std::size_t>(t) * tile_values;
    }
    AlignedVector<T>& values() { return values_; }
    const AlignedVector<T>& values() const { return values_; }

    // Slow access by cell, for tests, sources and probes. get() gives `outside` where no tile is.
    T get(const Vec3i& cell, T outside = T{}) const {
        const int t = map_->find(map_->shape().tile_of(cell));
        return t < 0 ? outside : tile(t)[local_index(cell)];
    }
    // The cell's tile must exist.
    T& ref(const Vec3i& cell) {
        const int t = map_->find(map_->shape().tile_of(cell));
        GISCHT_ASSERT(t >= 0);
        return tile(t)[local_index(cell)];
    }

  private:
    int local_index(const Vec3i& c) const {
        const Vec3i n = map_->shape().extent();
        return map_->shape().index(c.x & (n.x - 1), c.y & (n.y - 1), c.z & (n.z - 1));
    }

    TileMap::Ptr map_;
    AlignedVector<T> values_;
};

// Staggered (MAC) vector field on a box map of n cells (Harlow & Welch 1965). Face value a(i,j,k)
// lives on the lower face of cell (i,j,k) along axis a, so tiles hold faces 0..n_a - 1; the last
// faces, at n_a, live in `last[a]`, whose index is j + ny k, i + nx k, i + nx j for a = x, y, z. In
// 2-D (n.z = 1) the z component does not exist (is_empty()).
struct FaceField {
    std::array<TileField<float>, 3> component;
    std::array<AlignedVector<float>, 3> last;

    FaceField() = default;
    explicit FaceField(const TileMap::Ptr& map, float value = 0) {
        const Vec3i n = map->bounds().size();
        for (int a = 0; a < (map->is_2d() ? 2 : 3); ++a) {
            (*this)[a] = TileField<float>(map, value);
            last[static_cast<std::size_t>(a)].assign(volume(n) / static_cast<std::size_t>(n[a]),
                                                     value);
        }
    }

    TileField<float>& operator[](int axis) { return component[static_cast<std::size_t>(axis)]; }
    const TileField<float>& operator[](int axis) const {
        return component[static_cast<std::size_t>(axis)];
    }
    const TileMap& map() const { return component[0].map(); }
    int axes() const { return map().is_2d() ? 2 : 3; }

    // Index into last[axis] of the face with the other two coordinates of `cell`.
    std::size_t last_index(int axis, const Vec3i& cell) const {
        const Vec3i n = map().bounds().size();
        const int i = axis == 0   ? cell.y + n.y * cell.z
                      : axis == 1 ? cell.x + n.x * cell.z
                                  : cell.x + n.x * cell.y;
        return static_cast<std::size_t>(i);
    }
    // Slow access to any face, cell[axis] in [0, n_a].
    float get(int axis, const Vec3i& face) const {
        if (face[axis] == map().bounds().hi[axis]) {
            return last[static_cast<std::size_t>(axis)][last_index(axis, face)];
        }
        return (*this)[axis].get(face);
    }
    float& ref(int axis, const Vec3i& face) {
        if (face[axis] == map().bounds().hi[axis]) {
            return last[static_cast<std::size_t>(axis)][last_index(axis, face)];
        }
        return (*this)[axis].ref(face);
    }
};

}  // namespace gischt
