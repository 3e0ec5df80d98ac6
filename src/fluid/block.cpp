// SPDX-License-Identifier: Apache-2.0
#include "fluid/block.h"

#include <cstring>

namespace gischt {

BlockMap::BlockMap(TileMap::Ptr map) : map_(std::move(map)) {
    GISCHT_ASSERT(map_->is_box());
    const Vec3i tiles{2, 2, map_->is_2d() ? 1 : 2};
    extent_ = map_->shape().extent() * tiles;
    counts_ = (map_->bounds().size() + extent_ - Vec3i(1)) / extent_;
    table_.assign(volume(counts_), -1);
    for (int t = 0; t < map_->size(); ++t) {
        const Vec3i c = map_->coord(t) / tiles;
        if (blocks_.empty() || blocks_.back().coord != c) {
            table_[static_cast<std::size_t>(c.x + counts_.x * (c.y + counts_.y * c.z))] = size();
            blocks_.push_back({c, t, t});
        }
        blocks_.back().end_tile = t + 1;
    }
}

Lattice Lattice::around(const Box3i& cells, const Vec3i& halo, bool faces, bool is_2d) {
    Vec3i low = halo, high = halo + Vec3i(faces ? 1 : 0);
    if (is_2d) low.z = high.z = 0;
    return {{cells.lo - low, cells.hi + high}};
}

float* Scratch::array(int slot, std::size_t count) {
    constexpr std::size_t slack = 64;
    const auto s = static_cast<std::size_t>(slot);
    if (arrays_.size() <= s) arrays_.resize(s + 1);
    if (arrays_[s].size() < count + slack) arrays_[s].resize(count + slack);
    std::fill_n(arrays_[s].data() + count, slack, 0.0f);
    return arrays_[s].data();
}

namespace {

// Copies n < 32 floats without a call.
inline void copy_short(float* to, const float* from, int n) {
    for (int step = 16; step > 0; step /= 2) {
        if (n & step) {
            std::memcpy(to, from, sizeof(float) * static_cast<std::size_t>(step));
            to += step;
            from += step;
        }
    }
}

// The parts of the region that lie in tiles, tile by tile.
template <TileShape S>
void copy_inside(const TileField<float>& field, const Box3i& inside, const Lattice& lattice,
                 float* out) {
    const TileMap& map = field.map();
    const Vec3i first = S.tile_of(inside.lo), last = S.tile_of(inside.hi - Vec3i(1));
    const std::ptrdiff_t sy = lattice.stride_y(), sz = lattice.stride_z();
    for (int tz = first.z; tz <= last.z; ++tz) {
        for (int ty = first.y; ty <= last.y; ++ty) {
            for (int tx = first.x; tx <= last.x; ++tx) {
                const Vec3i corner{tx << S.log_x, ty << S.log_y, tz << S.log_z};
                const Box3i part = intersection(inside, Box3i{corner, corner + S.extent()});
                const Vec3i n = part.size(), from = part.lo - corner;
                const float* src =
                    field.tile(map.find({tx, ty, tz})) + S.index(from.x, from.y, from.z);
                float* dst = out + lattice.index(part.lo);
                for (int k = 0; k < n.z; ++k) {
                    for (int j = 0; j < n.y; ++j) {
                        float* to = dst + sy * j + sz * k;
                        const float* row = src + S.index(0, j, k);
                        if (n.x == S.extent().x) {
                            std::memcpy(to, row, sizeof(float) * S.extent().x);
                        } else {
                            copy_short(to, row, n.x);
                        }
                    }
                }
            }
        }
    }
}

void copy_inside(const TileField<float>& field, const Box3i& inside, const Lattice& lattice,
                 float* out) {
    if (field.map().is_2d()) {
        copy_inside<tile_shape_2d>(field, inside, lattice, out);
    } else {
        copy_inside<tile_shape_3d>(field, inside, lattice, out);
    }
}

// An index beyond the bounds of one axis and where its value comes from.
struct Image {
    int to, from;
    float sign;
};

// The images of all outer indices of a region along one axis with the indices [0, count). False
// where one lies outside the region or needs more than one reflection.
bool find_images(int lo, int hi, int count, bool faces, Border low, Border high,
                 std::vector<Image>& images) {
    images.clear();
    for (int i = lo; i < hi; ++i) {
        if (i >= 0 && i < count) continue;
        const bool upper = i >= count;
        Image image{i, upper ? count - 1 : 0, 1};
        switch (upper ? high : low) {
            case Border::Periodic:
                return false;
            case Border::Clamp:
                break;
            case Border::Zero:
                image.sign = 0;
                break;
            case Border::Odd:
                image.sign = -1;
                [[fallthrough]];
            case Border::Even:
                image.from = upper ? 2 * count - (faces ? 2 : 1) - i : (faces ? -i : -1 - i);
                break;
        }
        if (image.from < std::max(lo, 0) || image.from >= std::min(hi, count)) return false;
        images.push_back(image);
    }
    return true;
}

// Fills the outer values from the inner ones, axis by axis; after an axis is done its whole extent
// counts as inside.
void fill_borders(const std::array<std::vector<Image>, 3>& images, const Box3i& inside,
                  const Lattice& lattice, float* out) {
    Box3i done = inside;
    for (int a = 0; a < 3; ++a) {
        for (const Image& image : images[static_cast<std::size_t>(a)]) {
            Box3i to = done;
            to.lo[a] = image.to;
            to.hi[a] = image.to + 1;
            Vec3i shift;
            shift[a] = image.from - image.to;
            const std::ptrdiff_t offset = lattice.index(lattice.region.lo + shift);
            for_rows(to, [&](const Vec3i& first, int n) {
                float* row = out + lattice.index(first);
                for (int i = 0; i < n; ++i) row[i] = image.sign * row[i + offset];
            });
        }
        done.lo[a] = lattice.region.lo[a];
        done.hi[a] = lattice.region.hi[a];
    }
}

bool contains(const Box3i& outer, const Box3i& inner) {
    return intersection(outer, inner) == inner;
}

// Images on all axes, or false where the general gather has to do it.
bool find_images(const Lattice& lattice, const Vec3i& count, int face_axis, const Borders& borders,
                 std::array<std::vector<Image>, 3>& images) {
    for (int a = 0; a < 3; ++a) {
        if (!find_images(lattice.region.lo[a], lattice.region.hi[a], count[a], a == face_axis,
                         borders(a, 0), borders(a, 1), images[static_cast<std::size_t>(a)])) {
            return false;
        }
    }
    return true;
}

}  // namespace

void gather_block(const TileField<float>& field, const Lattice& lattice, const Borders& borders,
                  float* out) {
    const Box3i& bounds = field.map().bounds();
    if (contains(bounds, lattice.region)) return copy_inside(field, lattice.region, lattice, out);
    std::array<std::vector<Image>, 3> images;
    if (!find_images(lattice, bounds.hi, -1, borders, images)) {
        return gather(field, lattice.region, borders, out);
    }
    const Box3i inside = intersection(bounds, lattice.region);
    copy_inside(field, inside, lattice, out);
    fill_borders(images, inside, lattice, out);
}

void gather_block_faces(const FaceField& field, int axis, const Lattice& lattice,
                        const Borders& borders, float* out) {
    const Box3i& bounds = field.map().bounds();
    const TileField<float>& tiles = field[axis];
    if (contains(bounds, lattice.region)) return copy_inside(tiles, lattice.region, lattice, out);
    Vec3i count = bounds.hi;
    count[axis] += 1;
    std::array<std::vector<Image>, 3> images;
    if (!find_images(lattice, count, axis, borders, images)) {
        return gather_faces(field, axis, lattice.region, borders, out);
    }
    const Box3i inside = intersection(Box3i{{}, count}, lattice.region);
    copy_inside(tiles, intersection(bounds, inside), lattice, out);
    if (inside.hi[axis] == count[axis]) {
        Box3i end = inside;
        end.lo[axis] = count[axis] - 1;
        const auto& last = field.last[static_cast<std::size_t>(axis)];
        for_cells(end,
                  [&](const Vec3i& f) { out[lattice.index(f)] = last[field.last_index(axis, f)]; });
    }
    fill_borders(images, inside, lattice, out);
}

void scatter_block(const BlockMap& blocks, int block, const Lattice& lattice, const float* in,
                   TileField<float>& field) {
    const TileMap& map = blocks.tiles();
    for (int t = blocks.first_tile(block); t < blocks.end_tile(block); ++t) {
        const Box3i cells = map.cells_of(t);
        const Vec3i first = map.first_cell(t);
        const auto bytes = sizeof(float) * static_cast<std::size_t>(cells.hi.x - cells.lo.x);
        for (int k = cells.lo.z; k < cells.hi.z; ++k) {
            for (int j = cells.lo.y; j < cells.hi.y; ++j) {
                std::memcpy(field.tile(t) + map.shape().index(0, j - first.y, k - first.z),
                            in + lattice.index({cells.lo.x, j, k}), bytes);
            }
        }
    }
}

void scatter_block_faces(const BlockMap& blocks, int block, int axis, const Lattice& lattice,
                         const float* in, FaceField& field) {
    scatter_block(blocks, block, lattice, in, field[axis]);
    Box3i end = blocks.cells(block);
    const int n = blocks.tiles().bounds().hi[axis];
    if (end.hi[axis] != n) return;
    end.lo[axis] = n;
    end.hi[axis] = n + 1;
    auto& last = field.last[static_cast<std::size_t>(axis)];
    for_cells(end, [&](const Vec3i& f) { last[field.last_index(axis, f)] = in[lattice.index(f)]; });
}

void clear_block(const BlockMap& blocks, int block, TileField<float>& field) {
    float* first = field.tile(blocks.first_tile(block));
    std::fill(first, field.tile(blocks.end_tile(block) - 1) + tile_values, 0.0f);
}

}  // namespace gischt
