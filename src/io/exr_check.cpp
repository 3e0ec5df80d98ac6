// SPDX-License-Identifier: Apache-2.0
#include "io/exr_check.h"

#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>

namespace gischt {
namespace {

// Types of a fixed size, which the library reads whatever size the file states.
struct FixedType {
    std::string_view name;
    std::size_t size;  // bytes
};
constexpr FixedType fixed_types[] = {{"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
                                     {"compression", 1}, {"double", 8},   {"envmap", 1},
                                     {"float", 4},       {"int", 4},      {"keycode", 28},
                                     {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
                                     {"m44f", 64},       {"m44d", 128},   {"rational", 8},
                                     {"tiledesc", 9},    {"timecode", 8}, {"v2i", 8},
                                     {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
                                     {"v3f", 12},        {"v3d", 24},     {"deepImageState", 1}};

struct ExrBytes {
    std::string_view rest;

    std::string_view take(std::size_t count) {
        if (count > rest.size()) throw std::runtime_error("ends too early");
        const std::string_view part = rest.substr(0, count);
        rest.remove_prefix(count);
        return part;
    }
    std::string_view text() {
        const std::size_t end = rest.find('\0');
        if (end == rest.npos) throw std::runtime_error("ends too early");
        return take(end + 1).substr(0, end);
    }
    std::uint32_t word() {
        const std::string_view bytes = take(4);
        std::uint32_t value = 0;
        for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
        return value;
    }
};

[[noreturn]] void fail_attribute(std::string_view name) {
    throw std::runtime_error(
        fmt::format("the attribute '{}' is not what it says", name.substr(0, 40)));
}

// Whether the value of an attribute ends where its size says.
bool has_right_size(std::string_view type, std::string_view value) {
    for (const FixedType& fixed : fixed_types) {
        if (type == fixed.name) return value.size() == fixed.size;
    }
    ExrBytes in{value};
    if (type == "chlist") {
        while (!in.text().empty()) in.take(16);  // type, linearity, sampling
        return in.rest.empty();
    }
    if (type == "preview") {
        const std::uint64_t width = in.word(), height = in.word();
        return width <= 65536 && height <= 65536 && in.rest.size() == 4 * width * height;
    }
    if (type == "stringvector") {
        while (!in.rest.empty()) in.take(in.word());
    }
    return true;  // of the rest the library takes as many bytes as the size says
}

void check_attribute(std::string_view name, std::string_view type, std::string_view value,
                     std::size_t file_size) {
    if (!has_right_size(type, value)) fail_attribute(name);
    ExrBytes in{value};
    if (name == "chunkCount" && value.size() == 4 && in.word() > file_size / 8)
        fail_attribute(name);
    if (name == "dataWindow" && value.size() == 16) {
        in.word();
        const std::int64_t top = static_cast<std::int32_t>(in.word());
        in.word();
        if (static_cast<std::int32_t>(in.word()) - top >= 65536) fail_attribute(name);
    }
}

}  // namespace

void check_exr_attributes(std::string_view file) {
    ExrBytes in{file};
    constexpr char several_parts = 0x10;  // in the second byte of the flags
    const bool is_multipart = (in.take(8)[5] & several_parts) != 0;
    // An empty header ends the list of several.
    for (bool has_any = true; has_any;) {
        has_any = false;
        for (std::string_view name = in.text(); !name.empty(); name = in.text()) {
            has_any = true;
            const std::string_view type = in.text();
            const std::string_view value = in.take(in.word());
            check_attribute(name, type, value, file.size());
        }
        if (!is_multipart) return;
    }
}

}  // namespace gischt
