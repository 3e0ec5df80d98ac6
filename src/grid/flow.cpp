// SPDX-License-Identifier: Apache-2.0
#include "grid/flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace gischt {
namespace {

constexpr int most_layers = 64;  // cells

double smallest_edge(const Transform& t) {
    return std::min({length(t.column[0]), length(t.column[1]), length(t.column[2])});
}

// The tiles of a map and those within so many cells of them.
TileMap::Ptr with_margin(const TileMap& map, int cells) {
    const Vec3i extent = map.shape().extent();
    const auto rings = [cells](int edge) { return (cells + edge - 1) / edge; };
    const Vec3i reach(rings(extent.x), rings(extent.y), map.is_2d() ? 0 : rings(extent.z));
    // One axis after the other, so that the list stays short.
    std::vector<Vec3i> tiles;
    for (int t = 0; t < map.size(); ++t) tiles.push_back(map.coord(t));
    TileMap::Ptr out = TileMap::sparse(tiles, map.bounds(), map.shape());
    for (int axis = 0; axis < 3; ++axis) {
        tiles.clear();
        for (int t = 0; t < out->size(); ++t) {
            for (int i = -reach[axis]; i <= reach[axis]; ++i) {
                Vec3i c = out->coord(t);
                c[axis] += i;
                tiles.push_back(c);
            }
        }
        Box3i bounds = map.bounds();
        for (const Vec3i& c : tiles) {
            const Vec3i lo = c * extent;
            bounds.extend(Box3i{lo, lo + extent});
        }
        out = TileMap::sparse(std::move(tiles), bounds, map.shape());
    }
    return out;
}

// A velocity field in the making, with the layer in which each cell was found: 0 unknown, 1 given.
struct Spreading {
    std::array<TileField<float>, 3> velocity;
    TileField<std::uint8_t> layer;

    struct Found {
        int tile, cell;
        Vec3f velocity;
    };

    bool has_known(int tile) const {
        const std::uint8_t* l = layer.tile(tile);
        return std::any_of(l, l + tile_values, [](std::uint8_t v) { return v != 0; });
    }

    // The unknown cells of a tile that have known neighbours.
    void look(int tile, std::vector<Found>& out) const {
        const TileMap& map = layer.map();
        const std::uint8_t* own = layer.tile(tile);
        for (int i = 0; i < tile_values; ++i) {
            if (own[i] != 0) continue;
            const Vec3i cell = map.first_cell(tile) + map.shape().cell(i);
            Vec3f sum;
            int count = 0;
            for (int side = 0; side < 6; ++side) {
                Vec3i next = cell;
                next[side / 2] += side % 2 == 0 ? -1 : 1;
                if (layer.get(next) == 0) continue;
                sum += Vec3f(velocity[0].get(next), velocity[1].get(next), velocity[2].get(next));
                ++count;
            }
            if (count > 0) out.push_back({tile, i, sum / Vec3f(static_cast<float>(count))});
        }
    }

    // One layer of cells more; false when none was left to find.
    bool grow(std::vector<char>& is_near, Job& job) {
        const TileMap& map = layer.map();
        std::vector<std::vector<Found>> found(static_cast<std::size_t>(map.size()));
        parallel_for(map.size(), 4, [&](int t) {
            const auto& around = map.neighbours(t);
            const bool is_worth = std::any_of(around.begin(), around.end(), [&](int n) {
                return n >= 0 && is_near[static_cast<std::size_t>(n)] != 0;
            });
            if (is_worth) look(t, found[static_cast<std::size_t>(t)]);
        });
        job.check();
        bool any = false;
        for (const auto& list : found) {
            for (const Found& f : list) {
                for (std::size_t a = 0; a < 3; ++a) {
                    velocity[a].tile(f.tile)[f.cell] = f.velocity[static_cast<int>(a)];
                }
                layer.tile(f.tile)[f.cell] = 1;
                is_near[static_cast<std::size_t>(f.tile)] = 1;
                any = true;
            }
        }
        return any;
    }
};

// What one tile is carried from: all components of a box of cells, the background where no tile is.
struct SourceBox {
    Box3i cells;
    std::vector<float> values;

    void gather(const TileField<float>& field, float background) {
        const TileMap& map = field.map();
        const Vec3i n = cells.size();
        values.assign(volume(n), background);
        const Vec3i lo = map.shape().tile_of(cells.lo),
                    hi = map.shape().tile_of(cells.hi - Vec3i(1));
        for (int z = lo.z; z <= hi.z; ++z) {
            for (int y = lo.y; y <= hi.y; ++y) {
                for (int x = lo.x; x <= hi.x; ++x) {
                    const int tile = map.find({x, y, z});
                    if (tile >= 0) copy(field, tile);
                }
            }
        }
    }

    void copy(const TileField<float>& field, int tile) {
        const TileMap& map = field.map();
        const Box3i part = intersection(cells, map.cells_of(tile));
        if (part.is_empty()) return;
        const Vec3i first = map.first_cell(tile);
        for (int z = part.lo.z; z < part.hi.z; ++z) {
            for (int y = part.lo.y; y < part.hi.y; ++y) {
                for (int x = part.lo.x; x < part.hi.x; ++x) {
                    const float v =
                        field.tile(tile)[map.shape().index(x - first.x, y - first.y, z - first.z)];
                    if (std::isfinite(v)) values[index({x, y, z})] = v;
                }
            }
        }
    }

    std::size_t index(const Vec3i& c) const {
        const Vec3i n = cells.size(), p = c - cells.lo;
        return static_cast<std::size_t>(p.x) +
               static_cast<std::size_t>(n.x) *
                   (static_cast<std::size_t>(p.y) +
                    static_cast<std::size_t>(n.y) * static_cast<std::size_t>(p.z));
    }

    // Catmull-Rom in three directions around a point, kept near the 64 values.
    float cubic(const Vec3i& base, const Vec3d& place) const {
        const auto weights = [](double s) {
            return std::array<float, 4>{
                static_cast<float>(s * (s * (1 - 0.5 * s) - 0.5)),
                static_cast<float>(1 + s * s * (1.5 * s - 2.5)),
                static_cast<float>(s * (0.5 + s * (2 - 1.5 * s))),
                static_cast<float>(0.5 * s * s * (s - 1)),
            };
        };
        const auto wx = weights(place.x), wy = weights(place.y), wz = weights(place.z);
        const Vec3i n = cells.size();
        const auto row = static_cast<std::size_t>(n.x), slab = row * static_cast<std::size_t>(n.y);
        const float* first = values.data() + index(base - Vec3i(1));
        float sum = 0, low = first[0], high = first[0];
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t j = 0; j < 4; ++j) {
                const float* v = first + j * row + k * slab;
                low = std::min(low, std::min(std::min(v[0], v[1]), std::min(v[2], v[3])));
                high = std::max(high, std::max(std::max(v[0], v[1]), std::max(v[2], v[3])));
                sum += wz[k] * wy[j] * (wx[0] * v[0] + wx[1] * v[1] + wx[2] * v[2] + wx[3] * v[3]);
            }
        }
        // A peak between samples rises above them.
        return std::clamp(sum, low, high + 0.125f * (high - low));
    }
};

// Where the cells of one tile come from, in cells of the source.
struct Origins {
    std::array<Vec3i, tile_values> base;
    std::array<Vec3d, tile_values> place;
    Box3i box = Box3i::empty();

    Origins(const TileMap& map, int tile, const Transform& to_world, const Transform& to_cells,
            const Flow& flow, double seconds) {
        for (int i = 0; i < tile_values; ++i) {
            const Vec3i cell = map.first_cell(tile) + map.shape().cell(i);
            const Vec3d from = flow.origin(to_world.point(Vec3d(cell) + Vec3d(0.5)), seconds);
            // Far out there is nothing, and no int.
            const Vec3d q = min(max(to_cells.point(from) - Vec3d(0.5), Vec3d(-1e8)), Vec3d(1e8));
            const auto at = static_cast<std::size_t>(i);
            base[at] = floor(q);
            place[at] = q - Vec3d(base[at]);
            box.extend(Box3i{base[at] - Vec3i(1), base[at] + Vec3i(3)});
        }
    }
};

}  // namespace

Flow::Flow(const Field& velocity, const Field& content, double seconds, Job& job) {
    GISCHT_ASSERT(velocity.is_vector());
    const TileMap& map = velocity.map();
    const Transform to_content = content.to_world.inverse() * velocity.to_world;
    const bool is_sparse = velocity.background == std::array<float, 3>{};
    const auto is_filled = [&](const Vec3i& cell) {
        const Vec3i there = floor(to_content.point(Vec3d(cell) + Vec3d(0.5)));
        const float v = content.component[0].get(there, content.background[0]);
        return v != content.background[0];
    };
    // What is known, and how fast it is.
    std::vector<char> has_known(static_cast<std::size_t>(map.size()));
    TileField<std::uint8_t> known(velocity.component[0].map_ptr());
    struct Speeds {
        double all = 0, content = 0;
    };
    std::vector<Speeds> speeds(static_cast<std::size_t>(map.size()));
    parallel_for(map.size(), 8, [&](int t) {
        job.check();
        Speeds& fastest = speeds[static_cast<std::size_t>(t)];
        for (int i = 0; i < tile_values; ++i) {
            const Vec3f v(velocity.component[0].tile(t)[i], velocity.component[1].tile(t)[i],
                          velocity.component[2].tile(t)[i]);
            const bool is_finite = std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
            const bool is_full = is_filled(map.first_cell(t) + map.shape().cell(i));
            const double speed = is_finite ? static_cast<double>(length(v)) : 0;
            known.tile(t)[i] = is_finite && (speed > 0 || is_full || !is_sparse);
            fastest.all = std::max(fastest.all, speed);
            if (is_full) fastest.content = std::max(fastest.content, speed);
        }
    });
    for (const Speeds& s : speeds) {
        fastest_ = std::max(fastest_, s.all);
        fastest_content_ = std::max(fastest_content_, s.content);
    }

    const double cells = fastest_ * seconds / smallest_edge(velocity.to_world);
    Field spread = velocity;
    if (is_sparse && cells > 0 && map.size() > 0) {
        if (cells > most_layers) {
            job.warn(
                fmt::format("the flow moves by {:.0f} cells while the film is exposed: edges "
                            "are carried {} cells into the void",
                            cells, most_layers));
        }
        const int layers = static_cast<int>(std::min(std::ceil(cells) + 1, double{most_layers}));
        const TileMap::Ptr wide = with_margin(map, layers);
        Spreading s;
        s.layer = TileField<std::uint8_t>(wide);
        for (auto& v : s.velocity) v = TileField<float>(wide);
        std::vector<char> is_near(static_cast<std::size_t>(wide->size()));
        for (int t = 0; t < map.size(); ++t) {
            const int to = wide->find(map.coord(t));
            for (int i = 0; i < tile_values; ++i) {
                if (known.tile(t)[i] == 0) continue;
                s.layer.tile(to)[i] = 1;
                for (std::size_t a = 0; a < 3; ++a) {
                    s.velocity[a].tile(to)[i] = velocity.component[a].tile(t)[i];
                }
            }
            is_near[static_cast<std::size_t>(to)] = s.has_known(to) ? 1 : 0;
        }
        for (int l = 0; l < layers && s.grow(is_near, job); ++l) {
        }
        spread.component.assign(s.velocity.begin(), s.velocity.end());
    }
    for (std::size_t a = 0; a < 3; ++a) {
        axis_[a] = BrickVolume(spread, {.axis = static_cast<int>(a)}, job);
    }
}

Field carried(const Field& source, const Flow& flow, double seconds, Job& job) {
    Field out;
    out.background = source.background;
    out.to_world = source.to_world;
    out.kind = source.kind;
    const double cells = flow.fastest() * std::abs(seconds) / smallest_edge(source.to_world);
    const TileMap::Ptr tiles = with_margin(
        source.map(), static_cast<int>(std::min(std::ceil(cells), double{most_layers})) + 2);
    for (std::size_t c = 0; c < source.component.size(); ++c) {
        out.component.emplace_back(tiles, source.background[c]);
    }

    const Transform to_cells = source.to_world.inverse();
    // Flows that tear a tile apart are looked up value by value.
    constexpr double most_values = 1 << 18;
    parallel_ranges(tiles->size(), 2, [&](int begin, int end) {
        SourceBox box;
        for (int t = begin; t < end; ++t) {
            job.check();
            const Origins from(*tiles, t, source.to_world, to_cells, flow, seconds);
            const Vec3d n(from.box.size());
            const bool is_compact = n.x * n.y * n.z <= most_values;
            for (std::size_t c = 0; c < source.component.size(); ++c) {
                float* values = out.component[c].tile(t);
                box.cells = from.box;
                if (is_compact) box.gather(source.component[c], source.background[c]);
                for (std::size_t i = 0; i < tile_values; ++i) {
                    if (!is_compact) {
                        box.cells = {from.base[i] - Vec3i(1), from.base[i] + Vec3i(3)};
                        box.gather(source.component[c], source.background[c]);
                    }
                    values[i] = box.cubic(from.base[i], from.place[i]);
                }
            }
        }
    });
    return out;
}

}  // namespace gischt
