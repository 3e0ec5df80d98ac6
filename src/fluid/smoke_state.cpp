// SPDX-License-Identifier: Apache-2.0
#include "fluid/smoke_state.h"

#include <fmt/format.h>

#include <bit>
#include <fstream>

#include "base/hash.h"

namespace gischt {
namespace {

static_assert(std::endian::native == std::endian::little, "state files are little-endian");

constexpr std::string_view magic = "gischt smoke 2\n";

struct Header {
    std::int32_t cells[3];
    std::int32_t frame;
    std::int64_t steps;
    double time, potential_dt, history_dt;
    std::int32_t has_density_kick, has_temperature_kick;
};

template <class Field, class F>
void for_faces(Field& field, F&& f) {
    for (int a = 0; a < field.axes(); ++a) {
        f(field[a].values());
        f(field.last[static_cast<std::size_t>(a)]);
    }
}

// The arrays of a state in the order of the file.
template <class State, class F>
void for_arrays(State& s, F&& f) {
    for_faces(s.velocity, f);
    f(s.potential.values());
    f(s.density.values.values());
    f(s.temperature.values.values());
    auto& h = s.history;
    if (h.dt == 0) return;
    for_faces(h.previous, f);
    for_faces(h.kick, f);
    for (auto* kick : {&h.density_kick, &h.temperature_kick}) {
        if (!kick->is_empty()) f(kick->values());
    }
}

}  // namespace

void save_smoke_state(const SmokeState& state, int frame, const std::filesystem::path& path) {
    {
        std::ofstream out(path, std::ios::binary);
        WordHash hash;
        const auto write = [&](const void* data, std::size_t bytes) {
            hash.add(data, bytes);
            out.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
        };
        write(magic.data(), magic.size());
        const Vec3i n = state.velocity.map().bounds().size();
        const Header header{{n.x, n.y, n.z},
                            frame,
                            state.steps,
                            state.time,
                            state.potential_dt,
                            state.history.dt,
                            !state.history.density_kick.is_empty(),
                            !state.history.temperature_kick.is_empty()};
        write(&header, sizeof header);
        for_arrays(state, [&](const AlignedVector<float>& v) {
            write(v.data(), v.size() * sizeof(float));
        });
        const std::uint64_t value = hash.value();
        out.write(reinterpret_cast<const char*>(&value), sizeof value);
        out.flush();
        if (!out) {
            std::error_code ignored;
            std::filesystem::remove(path, ignored);
            throw Error(ErrorKind::Resource, path.string(), "the state cannot be written",
                        "is the folder there and the disk not full?");
        }
    }
}

SmokeState load_smoke_state(const Domain& domain, const BlockMap& blocks,
                            const std::filesystem::path& path, int& frame) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw Error(ErrorKind::Input, path.string(), "cannot be opened");
    WordHash hash;
    const auto read = [&](void* data, std::size_t bytes) {
        in.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
        if (!in) throw Error(ErrorKind::Input, path.string(), "the state file is cut off");
        hash.add(data, bytes);
    };
    std::string start(magic.size(), ' ');
    read(start.data(), start.size());
    if (start != magic) {
        throw Error(ErrorKind::Input, path.string(), "is no state of a smoke simulation");
    }
    Header header;
    read(&header, sizeof header);
    const Vec3i n{header.cells[0], header.cells[1], header.cells[2]};
    if (n != domain.cells) {
        throw Error(ErrorKind::Input, path.string(),
                    fmt::format("is a state of {} x {} x {} cells, not of {} x {} x {}", n.x, n.y,
                                n.z, domain.cells.x, domain.cells.y, domain.cells.z),
                    "the scene has changed: start again");
    }
    SmokeState state;
    state.time = header.time;
    state.steps = header.steps;
    state.potential_dt = header.potential_dt;
    state.velocity = FaceField(domain.map);
    state.potential = TileField<float>(domain.map);
    state.density = SparseField(blocks, domain.map);
    state.temperature = SparseField(blocks, domain.map);
    SmokeHistory& history = state.history;
    history.dt = header.history_dt;
    if (history.dt != 0) {
        history.previous = FaceField(domain.map);
        history.kick = FaceField(domain.map);
        if (header.has_density_kick) history.density_kick = TileField<float>(domain.map);
        if (header.has_temperature_kick) history.temperature_kick = TileField<float>(domain.map);
    }
    for_arrays(state, [&](AlignedVector<float>& v) { read(v.data(), v.size() * sizeof(float)); });
    const std::uint64_t computed = hash.value();
    std::uint64_t stored = 0;
    read(&stored, sizeof stored);
    if (stored != computed) throw Error(ErrorKind::Input, path.string(), "the state is damaged");
    frame = header.frame;
    return state;
}

}  // namespace gischt
