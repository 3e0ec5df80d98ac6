// SPDX-License-Identifier: Apache-2.0
#include "io/image_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "io/hdr.h"
#include "io/png.h"

namespace gischt {
namespace {

std::string extension_of(const std::string& path) {
    std::string e = std::filesystem::path(path).extension().string();
    for (char& c : e) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return e;
}

[[noreturn]] void throw_extension(const std::string& path) {
    const std::string extension = extension_of(path);
    throw Error(ErrorKind::Usage, path,
                extension.empty() ? "has no extension that names an image format"
                                  : fmt::format("'{}' is no image format", extension),
                fmt::format("valid: {}", fmt::join(image_extensions(), ", ")));
}

void write_developed_png(const std::string& path, const Image& image, const WriteOptions& options) {
    Metadata metadata = image.metadata;
    metadata.set("tone", tone_name(options.display.tone));
    metadata.set("exposure", fmt::format("{}", options.display.exposure));
    write_png(path, to_display(image, options.display, options.bits), metadata);
}

}  // namespace

const std::vector<std::string>& image_extensions() {
    static const std::vector<std::string> extensions{".exr", ".png", ".hdr"};
    return extensions;
}

bool is_image_file(const std::string& path) {
    const auto& valid = image_extensions();
    return std::find(valid.begin(), valid.end(), extension_of(path)) != valid.end();
}

Image read_image(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == ".exr") return read_exr(path);
    if (extension == ".png") return read_png(path);
    if (extension == ".hdr") return read_hdr(path);
    throw_extension(path);
}

void write_image(const std::string& path, const Image& image, const WriteOptions& options) {
    if (options.bits != 8 && options.bits != 16) {
        throw Error(ErrorKind::Usage, path, fmt::format("{} bits per channel", options.bits),
                    "PNG takes 8 or 16");
    }
    const std::string extension = extension_of(path);
    if (extension == ".exr") return write_exr(path, image, options.exr);
    if (extension == ".png") return write_developed_png(path, image, options);
    if (extension == ".hdr") return write_hdr(path, image);
    throw_extension(path);
}

}  // namespace gischt
