// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>

#include "base/hash.h"
#include "input.h"
#include "io/exr.h"
#include "io/film_file.h"
#include "io/hdr.h"
#include "io/png.h"
#include "readers.h"

namespace gischt {
namespace {

// Planes of another size than the picture would be read beyond their end.
void check_whole(const Image& image) {
    for (const Channel& c : image.planes) {
        if (c.values.size() != image.pixel_count()) std::abort();
    }
}

template <class F>
void read_picture(std::string_view bytes, const char* extension, F&& read) {
    const InputFile file(bytes, extension);
    expect_read_or_refused([&] { check_whole(read(file.path())); });
}

// CRC-32 of PNG (ISO 3309).
std::uint32_t crc_of(std::string_view bytes) {
    std::uint32_t crc = 0xffffffff;
    for (const char c : bytes) {
        crc ^= static_cast<std::uint8_t>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

// The chunks of a PNG with their right checksums, as far as their lengths make sense.
std::string with_checksums(std::string bytes) {
    std::size_t at = 8;
    while (at + 12 <= bytes.size()) {
        const std::size_t length = big_endian(bytes, at);
        if (length > bytes.size() - at - 12) break;
        const std::uint32_t crc = crc_of(std::string_view(bytes).substr(at + 4, length + 4));
        for (std::size_t i = 0; i < 4; ++i)
            bytes[at + 8 + length + i] = static_cast<char>(crc >> (24 - 8 * i));
        at += length + 12;
    }
    return bytes;
}

std::string with_hash(std::string bytes) {
    if (bytes.size() < 8) return bytes;
    bytes.resize(bytes.size() - 8);
    const std::uint64_t hash = hash_bytes(bytes);
    for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(hash >> (8 * i)));
    return bytes;
}

}  // namespace

void fuzz_exr(std::string_view bytes) {
    read_picture(bytes, ".exr", read_exr);
}

void fuzz_hdr(std::string_view bytes) {
    read_picture(bytes, ".hdr", read_hdr);
}

void fuzz_png(std::string_view bytes) {
    read_picture(bytes, ".png", read_png);
    read_picture(with_checksums(std::string(bytes)), ".png", read_png);
}

void fuzz_film(std::string_view bytes) {
    for (const std::string& whole : {std::string(bytes), with_hash(std::string(bytes))}) {
        const InputFile file(whole, ".film");
        expect_read_or_refused([&] { read_film(file.path()); });
    }
}

}  // namespace gischt
