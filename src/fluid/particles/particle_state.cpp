// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/particle_state.h"

#include <bit>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/hash.h"

namespace gischt {
namespace {

static_assert(std::endian::native == std::endian::little, "state files are little-endian");

constexpr std::string_view magic = "gischt particles 1\n";
// Of the arrays: position, velocity, age, life, radius, id.
constexpr std::uint64_t bytes_per_particle = 24 + 12 + 3 * 4 + 8;

struct Header {
    std::uint64_t count;
    std::int64_t frame;
};

}  // namespace

void save_particle_state(const Particles& particles, int frame, const std::filesystem::path& path) {
    std::ofstream out(path, std::ios::binary);
    WordHash hash;
    const auto write = [&](const void* data, std::size_t bytes) {
        hash.add(data, bytes);
        out.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    };
    write(magic.data(), magic.size());
    const Header header{particles.size(), frame};
    write(&header, sizeof header);
    for_particle_arrays(particles, [&](const auto& array) {
        write(array.data(), array.size() * sizeof(array[0]));
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

Particles load_particle_state(const std::filesystem::path& path, int& frame) {
    const auto fail = [&](const char* what) {
        return Error(ErrorKind::Input, path.string(), what, "start again");
    };
    std::ifstream in(path, std::ios::binary);
    if (!in) throw fail("cannot be opened");
    WordHash hash;
    const auto read = [&](void* data, std::size_t bytes) {
        in.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
        if (!in) throw fail("the state file is cut off");
        hash.add(data, bytes);
    };
    std::string start(magic.size(), ' ');
    read(start.data(), start.size());
    if (start != magic) throw fail("is no state of a particle system");
    Header header;
    read(&header, sizeof header);
    // A count that the file cannot hold would fill the memory.
    if (header.count > std::filesystem::file_size(path) / bytes_per_particle) {
        throw fail("the state file is cut off");
    }
    Particles particles;
    particles.resize(header.count);
    for_particle_arrays(particles,
                        [&](auto& array) { read(array.data(), array.size() * sizeof(array[0])); });
    const std::uint64_t computed = hash.value();
    std::uint64_t stored = 0;
    read(&stored, sizeof stored);
    if (stored != computed) throw fail("the state is damaged");
    frame = static_cast<int>(header.frame);
    return particles;
}

}  // namespace gischt
