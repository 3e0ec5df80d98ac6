// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "io/ply.h"

namespace gischt {

static_assert(std::endian::native == std::endian::little);

void write_ply_particles(const std::string& path, const Particles& p) {
    std::string header = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment gischt particles, metres and seconds\n"
        "element vertex {}\n",
        p.size());
    for (const char* name : {"x", "y", "z", "id"}) {
        header += fmt::format("property double {}\n", name);
    }
    std::vector<const char*> floats{"vx", "vy", "vz", "age", "life", "radius"};
    if (!p.color.empty()) floats.insert(floats.end(), {"red", "green", "blue"});
    if (!p.opacity.empty()) floats.push_back("opacity");
    if (!p.temperature.empty()) floats.push_back("temperature");
    for (const char* name : floats) header += fmt::format("property float {}\n", name);
    header += "end_header\n";

    AtomicFile file(path);
    file.write(std::span<const char>(header));
    std::vector<char> block;
    const auto append = [&block](const auto& value) {
        const auto* bytes = reinterpret_cast<const char*>(&value);
        block.insert(block.end(), bytes, bytes + sizeof value);
    };
    constexpr std::size_t flush_at = 1 << 20;  // bytes
    for (std::size_t i = 0; i < p.size(); ++i) {
        append(p.position[i]);
        append(static_cast<double>(p.id[i]));
        append(p.velocity[i]);
        append(p.age[i]);
        append(p.life[i]);
        append(p.radius[i]);
        if (!p.color.empty()) append(p.color[i]);
        if (!p.opacity.empty()) append(p.opacity[i]);
        if (!p.temperature.empty()) append(p.temperature[i]);
        if (block.size() < flush_at) continue;
        file.write(std::span<const char>(block));
        block.clear();
    }
    file.write(std::span<const char>(block));
    file.commit();
}

}  // namespace gischt
