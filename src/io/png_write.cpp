// SPDX-License-Identifier: Apache-2.0
#include "io/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <vector>

#include "base/error.h"
#include "io/atomic_file.h"

namespace gischt {
namespace {

using Bytes = std::vector<unsigned char>;

// What libpng's callbacks see. libpng leaves by longjmp, which skips destructors: everything that
// owns memory lives in the callers of run().
struct Encoder {
    const DisplayImage& image;
    std::vector<png_text> texts;
    Bytes row;  // of one line, big endian at 16 bits
    int level;
    Bytes out;
    std::array<char, 200> message{};
};

void on_error(png_structp png, png_const_charp text) {
    auto* encoder = static_cast<Encoder*>(png_get_error_ptr(png));
    std::snprintf(encoder->message.data(), encoder->message.size(), "%s", text);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_write(png_structp png, png_bytep data, std::size_t size) {
    auto* encoder = static_cast<Encoder*>(png_get_io_ptr(png));
    try {
        encoder->out.insert(encoder->out.end(), data, data + size);
        return;
    } catch (const std::bad_alloc&) {
    }
    png_error(png, "out of memory");
}

void on_flush(png_structp) {}

void fill_row(Encoder& e, int y) {
    const auto values = static_cast<std::size_t>(e.image.width * e.image.channels);
    const std::uint16_t* code = e.image.codes.data() + values * static_cast<std::size_t>(y);
    for (std::size_t i = 0; i < values; ++i) {
        if (e.image.bits == 8) {
            e.row[i] = static_cast<unsigned char>(code[i]);
        } else {
            e.row[2 * i] = static_cast<unsigned char>(code[i] >> 8);
            e.row[2 * i + 1] = static_cast<unsigned char>(code[i] & 0xff);
        }
    }
}

// False when libpng gave up; the reason is in e.message. No local may own anything here.
bool run(Encoder& e, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &e, on_write, on_flush);
    png_set_compression_level(png, e.level);
    const int color = e.image.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
    png_set_IHDR(png, info, static_cast<png_uint_32>(e.image.width),
                 static_cast<png_uint_32>(e.image.height), e.image.bits, color, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (e.image.is_srgb) png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!e.texts.empty()) {
        png_set_text(png, info, e.texts.data(), static_cast<int>(e.texts.size()));
    }
    png_write_info(png, info);
    for (int y = 0; y < e.image.height; ++y) {
        fill_row(e, y);
        png_write_row(png, e.row.data());
    }
    png_write_end(png, info);
    return true;
}

bool is_ascii(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
}

// Text chunks that point into `metadata`.
std::vector<png_text> make_texts(const std::string& path, Metadata& metadata) {
    std::vector<png_text> texts;
    for (auto& [key, value] : metadata.entries) {
        if (key.empty() || key.size() > 79 || !is_ascii(key)) {
            throw Error(ErrorKind::Usage, path, fmt::format("metadata key '{}'", key),
                        "PNG takes 1 to 79 ASCII characters");
        }
        png_text text{};
        text.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        text.key = key.data();
        text.text = value.data();
        text.text_length = is_ascii(value) ? value.size() : 0;
        text.itxt_length = is_ascii(value) ? 0 : value.size();
        texts.push_back(text);
    }
    return texts;
}

}  // namespace

void write_png(const std::string& path, const DisplayImage& image, const Metadata& metadata,
               int level) {
    AtomicFile file(path);
    Metadata copy = metadata;
    const auto row_bytes = static_cast<std::size_t>(image.width * image.channels * image.bits / 8);
    Encoder encoder{image, make_texts(path, copy), Bytes(row_bytes), level, {}, {}};
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && run(encoder, png, info);
    png_destroy_write_struct(&png, &info);
    if (!done) {
        throw Error(ErrorKind::Resource, path,
                    fmt::format("cannot write PNG: {}", encoder.message.data()));
    }
    file.write(std::span<const unsigned char>(encoder.out));
    file.commit();
}

}  // namespace gischt
