// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke_frame.h"

namespace gischt {
namespace {

std::vector<Vec3i> tiles_with_content(const TileField<float>& field) {
    std::vector<Vec3i> tiles;
    for (int t = 0; t < field.map().size(); ++t) {
        const float* v = field.tile(t);
        if (std::any_of(v, v + tile_values, [](float x) { return x != 0; })) {
            tiles.push_back(field.map().coord(t));
        }
    }
    return tiles;
}

// The given tiles of fields on a box map, each value v as v + offset.
Field extract(const std::vector<TileField<float>>& from, const std::vector<Vec3i>& tiles,
              float offset, const Domain& domain) {
    const auto map = TileMap::sparse(tiles, domain.map->bounds(), domain.map->shape());
    Field field;
    field.to_world = domain.to_world();
    field.background = {offset, offset, offset};
    for (const TileField<float>& f : from) {
        TileField<float>& to = field.component.emplace_back(map);
        parallel_for(map->size(), 64, [&](int t) {
            const float* v = f.tile(domain.map->find(map->coord(t)));
            for (int i = 0; i < tile_values; ++i) to.tile(t)[i] = v[i] + offset;
        });
    }
    return field;
}

std::vector<Vec3i> all_tiles(const TileMap& map) {
    std::vector<Vec3i> tiles;
    for (int t = 0; t < map.size(); ++t) tiles.push_back(map.coord(t));
    return tiles;
}

// The tiles and all their neighbours: moving smoke is blurred beyond its tiles.
std::vector<Vec3i> dilated(const TileMap& map, const std::vector<Vec3i>& tiles) {
    std::vector<Vec3i> more;
    for (const Vec3i& c : tiles) {
        for (const std::int32_t n : map.neighbours(map.find(c))) {
            if (n >= 0) more.push_back(map.coord(n));
        }
    }
    return more;
}

// Calls f(block, lattice with a halo of two cells, velocity there, scratch) for all blocks.
template <class F>
void for_blocks_with_velocity(const SmokeSolver& solver, F&& f) {
    const Domain& domain = solver.domain();
    for_blocks(solver.blocks(), [&](int block, Scratch& scratch) {
        const Lattice lattice =
            Lattice::around(solver.blocks().cells(block), Vec3i(2), true, domain.is_2d());
        std::array<const float*, 3> u{};
        for (int a = 0; a < domain.axes(); ++a) {
            float* faces = scratch.array(a, lattice.count());
            gather_block_faces(solver.state().velocity, a, lattice, domain.velocity_borders(a),
                               faces);
            add_side_velocity(domain, a, lattice, faces);
            u[static_cast<std::size_t>(a)] = faces;
        }
        f(block, lattice, u, scratch);
    });
}

std::vector<TileField<float>> centered_velocity(const SmokeSolver& solver) {
    std::vector<TileField<float>> out(3, TileField<float>(solver.domain().map));
    for_blocks_with_velocity(
        solver, [&](int block, const Lattice& lattice, const auto& u, Scratch& scratch) {
            const Box3i cells = solver.blocks().cells(block);
            const std::array<std::ptrdiff_t, 3> stride{1, lattice.stride_y(), lattice.stride_z()};
            float* mean = scratch.array(3, lattice.count());
            for (std::size_t a = 0; a < static_cast<std::size_t>(solver.domain().axes()); ++a) {
                for_rows(cells, [&](const Vec3i& first, int n) {
                    const std::ptrdiff_t at = lattice.index(first);
                    for (std::ptrdiff_t i = at; i < at + n; ++i) {
                        mean[i] = 0.5f * (u[a][i] + u[a][i + stride[a]]);
                    }
                });
                scatter_block(solver.blocks(), block, lattice, mean, out[a]);
            }
        });
    return out;
}

std::vector<TileField<float>> vorticity(const SmokeSolver& solver) {
    std::vector<TileField<float>> out(3, TileField<float>(solver.domain().map));
    const bool is_2d = solver.domain().is_2d();
    for_blocks_with_velocity(solver, [&](int block, const Lattice& lattice, const auto& u,
                                         Scratch& scratch) {
        const std::array<float*, 3> w{scratch.array(3, lattice.count()),
                                      scratch.array(4, lattice.count()),
                                      scratch.array(5, lattice.count())};
        compute_vorticity(lattice, solver.blocks().cells(block), is_2d, solver.domain().h, u, w);
        for (std::size_t a = is_2d ? 2 : 0; a < 3; ++a) {
            scatter_block(solver.blocks(), block, lattice, w[a], out[a]);
        }
    });
    return out;
}

// Pascal from the potential dt p / (rho h).
TileField<float> pressure(const SmokeSolver& solver) {
    const SmokeState& state = solver.state();
    TileField<float> out = state.potential;
    const double dt = state.potential_dt;
    const auto scale = static_cast<float>(
        dt > 0 ? solver.params().reference_density * solver.domain().h / dt : 0.0);
    for (float& p : out.values()) p *= scale;
    return out;
}

}  // namespace

int count_active_tiles(const SmokeSolver& solver) {
    const SmokeState& s = solver.state();
    return static_cast<int>(parallel_sum(solver.domain().map->size(), 64, [&](int t) {
        const float *a = s.density.values.tile(t), *b = s.temperature.values.tile(t);
        for (int i = 0; i < tile_values; ++i) {
            if (a[i] != 0 || b[i] != 0) return 1.0;
        }
        return 0.0;
    }));
}

Frame make_frame(const SmokeSolver& solver, int number) {
    const SmokeOutput& output = solver.params().output;
    const Domain& domain = solver.domain();
    TileField<float> density = solver.state().density.values,
                     heat = solver.state().temperature.values;
    solver.solids().clear_inside(density);
    solver.solids().clear_inside(heat);
    Frame frame;
    frame.number = number;
    frame.time = solver.state().time;
    frame.dt = 1 / solver.world().fps;
    std::vector<Vec3i> content = tiles_with_content(density);
    frame.fields["density"] = extract({density}, content, 0, domain);
    const std::vector<Vec3i> hot = tiles_with_content(heat);
    frame.fields["temperature"] =
        extract({heat}, hot, static_cast<float>(solver.params().ambient_temperature), domain);
    content.insert(content.end(), hot.begin(), hot.end());
    if (output.velocity != VelocityOutput::None) {
        frame.fields["velocity"] =
            extract(centered_velocity(solver),
                    output.velocity == VelocityOutput::All ? all_tiles(*domain.map)
                                                           : dilated(*domain.map, content),
                    0, domain);
    }
    if (output.pressure) {
        frame.fields["pressure"] = extract({pressure(solver)}, all_tiles(*domain.map), 0, domain);
    }
    if (output.vorticity) {
        frame.fields["vorticity"] = extract(vorticity(solver), all_tiles(*domain.map), 0, domain);
    }
    return frame;
}

}  // namespace gischt
