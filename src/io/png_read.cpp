// SPDX-License-Identifier: Apache-2.0
#include "io/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "image/color.h"
#include "io/file_bytes.h"

namespace gischt {
namespace {

// What libpng's callbacks see. libpng leaves by longjmp, which skips destructors: everything that
// owns memory lives in the callers of read_header() and read_rows().
struct Decoder {
    explicit Decoder(const std::string& file) : bytes(file) {}

    const std::string& bytes;
    std::size_t position = 0;
    int width = 0, height = 0, channels = 0, bits = 0;
    double packed_row = 0;  // bytes of a row before it is expanded
    double gamma = 0;       // exponent from encoded to linear; 0 for sRGB
    std::vector<unsigned char> pixels;
    std::vector<unsigned char*> rows;
    std::array<char, 200> message{};
};

void on_error(png_structp png, png_const_charp text) {
    auto* decoder = static_cast<Decoder*>(png_get_error_ptr(png));
    std::snprintf(decoder->message.data(), decoder->message.size(), "%s", text);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep data, std::size_t size) {
    auto* decoder = static_cast<Decoder*>(png_get_io_ptr(png));
    if (size > decoder->bytes.size() - decoder->position) png_error(png, "ends too early");
    std::memcpy(data, decoder->bytes.data() + decoder->position, size);
    decoder->position += size;
}

// Whether every chunk up to the last, IEND, ends within the file: libpng takes the memory for some
// kinds before it reads them.
bool has_whole_chunks(std::string_view bytes) {
    constexpr std::size_t around = 12;  // bytes: length, kind, checksum
    for (std::size_t at = 8; bytes.size() - at >= around;) {
        std::size_t length = 0;  // big-endian
        for (std::size_t i = 0; i < 4; ++i)
            length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
        if (length > bytes.size() - at - around) return false;
        if (bytes.substr(at + 4, 4) == "IEND") return true;
        at += length + around;
    }
    return false;
}

// Size and layout, with every kind of PNG expanded to RGB or RGBA of 8 or 16 bits.
bool read_header(Decoder& d, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, &d, on_read);
    png_set_user_limits(png, 65536, 65536);
    png_set_chunk_malloc_max(png, 8 << 20);  // bytes; Debian's library has no limit of its own
    png_read_info(png, info);
    d.packed_row = static_cast<double>(png_get_rowbytes(png, info));
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_interlace_handling(png);
    double file_gamma = 0;
    int intent = 0;
    if (!png_get_sRGB(png, info, &intent) && png_get_gAMA(png, info, &file_gamma)) {
        // 0.45455 is how writers say "sRGB".
        if (std::abs(file_gamma - 0.45455) > 0.005 && file_gamma > 0.01) d.gamma = 1 / file_gamma;
    }
    png_read_update_info(png, info);
    d.width = static_cast<int>(png_get_image_width(png, info));
    d.height = static_cast<int>(png_get_image_height(png, info));
    d.channels = png_get_channels(png, info);
    d.bits = png_get_bit_depth(png, info);
    return true;
}

bool read_rows(Decoder& d, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, d.rows.data());
    png_read_end(png, info);
    return true;
}

void allocate_rows(Decoder& d, const std::string& path) {
    const auto row = static_cast<std::size_t>(d.width) * static_cast<std::size_t>(d.channels) *
                     static_cast<std::size_t>(d.bits / 8);
    const auto height = static_cast<std::size_t>(d.height);
    // Deflate shrinks by 1032 at most (RFC 1951).
    if (d.packed_row * d.height > 1032.0 * static_cast<double>(d.bytes.size())) {
        throw Error(ErrorKind::Input, path,
                    "broken PNG file: claims more pixels than its bytes can hold");
    }
    d.pixels.resize(row * height);
    for (std::size_t y = 0; y < height; ++y) d.rows.push_back(d.pixels.data() + y * row);
}

// Sample c of pixel i, in [0,1].
float sample(const Decoder& d, std::size_t i, std::size_t c) {
    const std::size_t k = i * static_cast<std::size_t>(d.channels) + c;
    if (d.bits == 8) return static_cast<float>(d.pixels[k]) / 255;
    return static_cast<float>(256 * d.pixels[2 * k] + d.pixels[2 * k + 1]) / 65535;
}

Image to_linear(const Decoder& d) {
    const bool has_alpha = d.channels == 4;
    Image image = has_alpha ? Image::rgba(d.width, d.height) : Image::rgb(d.width, d.height);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const float alpha = has_alpha ? sample(d, i, 3) : 1;
        for (std::size_t c = 0; c < 3; ++c) {
            const float v = sample(d, i, c);
            const float linear =
                d.gamma > 0 ? std::pow(v, static_cast<float>(d.gamma)) : srgb_decode(v);
            image.planes[c].values[i] = linear * alpha;
        }
        if (has_alpha) image.planes[3].values[i] = alpha;
    }
    return image;
}

// Owns libpng's two structures.
struct Reader {
    png_structp png;
    png_infop info = nullptr;
    explicit Reader(Decoder& d)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &d, on_error, on_warning)) {
        if (png) info = png_create_info_struct(png);
    }
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
};

}  // namespace

Image read_png(const std::string& path) {
    const std::string bytes = read_bytes(path);
    const auto* start = reinterpret_cast<const unsigned char*>(bytes.data());
    if (png_sig_cmp(start, 0, std::min<std::size_t>(8, bytes.size())) != 0 || bytes.size() < 8) {
        throw Error(ErrorKind::Input, path, "is not a PNG file");
    }
    if (!has_whole_chunks(bytes)) {
        throw Error(ErrorKind::Input, path, "broken PNG file: ends too early");
    }
    Decoder d(bytes);
    Reader reader(d);
    if (!reader.info) throw Error(ErrorKind::Resource, path, "out of memory");
    auto fail = [&] {
        throw Error(ErrorKind::Input, path, fmt::format("broken PNG file: {}", d.message.data()));
    };
    if (!read_header(d, reader.png, reader.info)) fail();
    allocate_rows(d, path);
    if (!read_rows(d, reader.png, reader.info)) fail();

    Image image = to_linear(d);
    png_textp texts = nullptr;
    const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
    for (int i = 0; i < count; ++i) image.metadata.set(texts[i].key, texts[i].text);
    return image;
}

}  // namespace gischt
