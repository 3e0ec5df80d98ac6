// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_stamp.h"

#include <fstream>
#include <stdexcept>
#include <vector>

#include "base/hash.h"
#include "base/random.h"

namespace gischt {

// Behind the magic number, the format, the library's version and a flag.
constexpr std::streamoff uuid_at = 8 + 4 + 4 + 4 + 1;
constexpr std::streamsize uuid_length = 36;

static std::string stamp_of(std::istream& stream) {
    stream.seekg(uuid_at + uuid_length);
    std::uint64_t hash = hash_bytes("gischt");
    std::vector<char> block(1 << 20);
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        hash = hash_bytes({block.data(), static_cast<std::size_t>(stream.gcount())}, hash);
    }
    stream.clear();
    const std::string h = hex(hash) + hex(mix64(hash));
    return h.substr(0, 8) + '-' + h.substr(8, 4) + '-' + h.substr(12, 4) + '-' + h.substr(16, 4) +
           '-' + h.substr(20);
}

void stamp_vdb(const std::string& path) {
    std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
    const std::string stamp = stamp_of(stream);
    stream.seekp(uuid_at);
    stream << stamp;
    stream.close();
    if (!stream) throw std::runtime_error("it cannot be written");
}

bool has_vdb_stamp(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string stamp = stamp_of(stream);
    std::string found(static_cast<std::size_t>(uuid_length), ' ');
    stream.seekg(uuid_at);
    stream.read(found.data(), uuid_length);
    return stream && found == stamp;
}

}  // namespace gischt
