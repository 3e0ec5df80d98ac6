// SPDX-License-Identifier: Apache-2.0
#include "io/hdr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"

namespace gischt {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

// Our own decoder rather than stb_image's: that one takes the end of the file for zeros, so that a
// truncated picture would pass, or never end.
class Parser {
  public:
    Parser(const std::string& path, const std::string& bytes) : path_(path), rest_(bytes) {}

    Image image() {
        read_header();
        Image out = Image::rgb(width_, height_);
        std::vector<Rgbe> line(static_cast<std::size_t>(width_));
        for (int y = 0; y < height_; ++y) {
            read_line(line);
            store(out, upward_ ? height_ - 1 - y : y, line);
        }
        return out;
    }

  private:
    [[noreturn]] void fail(std::string_view what) const {
        throw Error(ErrorKind::Input, path_, fmt::format("broken Radiance file: {}", what));
    }

    std::uint8_t byte() {
        if (rest_.empty()) fail("ends too early");
        const auto b = static_cast<std::uint8_t>(rest_.front());
        rest_.remove_prefix(1);
        return b;
    }

    std::string text_line() {
        const std::size_t end = rest_.find('\n');
        if (end == std::string_view::npos) fail("ends within the header");
        std::string line(rest_.substr(0, end));
        rest_.remove_prefix(end + 1);
        if (line.ends_with('\r')) line.pop_back();
        return line;
    }

    void read_header() {
        for (std::string line = text_line(); !line.empty(); line = text_line()) {
            if (line.starts_with("EXPOSURE=")) {
                const double factor = std::strtod(line.c_str() + 9, nullptr);
                if (factor > 0 && std::isfinite(factor)) exposure_ *= factor;
            } else if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
                fail(fmt::format("format '{}', of which only 32-bit_rle_rgbe is read",
                                 line.substr(7, 40)));
            }
        }
        const std::string size = text_line();
        char sign = 0;
        int used = 0;
        if (std::sscanf(size.c_str(), "%cY %d +X %d%n", &sign, &height_, &width_, &used) != 3 ||
            (sign != '-' && sign != '+') || static_cast<std::size_t>(used) != size.size()) {
            fail(fmt::format("resolution line '{}'", size.substr(0, 40)));
        }
        upward_ = sign == '+';
        // Runs code at most 127 bytes in 2: four channels of a pixel take 8/127 bytes or more.
        const bool possible = width_ > 0 && height_ > 0 && width_ <= 65536 && height_ <= 65536 &&
                              1.0 * width_ * height_ <= 16.0 * static_cast<double>(rest_.size());
        if (!possible) fail(fmt::format("cannot hold {} x {} pixels", width_, height_));
    }

    void read_line(std::vector<Rgbe>& line) {
        const bool coded = width_ >= 8 && width_ < 32768 && rest_.size() >= 4 && rest_[0] == 2 &&
                           rest_[1] == 2 && (rest_[2] & 0x80) == 0;
        if (!coded) return read_flat(line);
        byte();
        byte();
        const int high = byte(), low = byte();
        if (high * 256 + low != width_) fail("a line of another width");
        for (std::size_t c = 0; c < 4; ++c) read_runs(line, c);
    }

    void read_runs(std::vector<Rgbe>& line, std::size_t channel) {
        for (std::size_t x = 0; x < line.size();) {
            const int code = byte();
            const bool run = code > 128;
            const auto count = static_cast<std::size_t>(run ? code - 128 : code);
            if (count == 0 || count > line.size() - x) fail("a run beyond its line");
            std::uint8_t value = run ? byte() : std::uint8_t{0};
            for (std::size_t k = 0; k < count; ++k) {
                if (!run) value = byte();
                line[x++][channel] = value;
            }
        }
    }

    // Pixels as they are, or the first kind of runs: (1, 1, 1, n) repeats the pixel before, the
    // counts of successive ones being digits of base 256.
    void read_flat(std::vector<Rgbe>& line) {
        int shift = 0;
        for (std::size_t x = 0; x < line.size();) {
            Rgbe p;
            for (auto& b : p) b = byte();
            if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
                line[x++] = p;
                shift = 0;
                continue;
            }
            if (shift > 16) fail("a run beyond its line");
            const std::size_t count = static_cast<std::size_t>(p[3]) << shift;
            if (x == 0 || count > line.size() - x) fail("a run beyond its line");
            for (std::size_t k = 0; k < count; ++k, ++x) line[x] = line[x - 1];
            shift += 8;
        }
    }

    void store(Image& image, int y, const std::vector<Rgbe>& line) const {
        std::size_t i = image.index(0, y);
        for (const Rgbe& p : line) {
            const double scale = p[3] == 0 ? 0 : std::ldexp(1 / exposure_, p[3] - 136);
            for (std::size_t c = 0; c < 3; ++c) {
                image.planes[c].values[i] = static_cast<float>(p[c] * scale);
            }
            ++i;
        }
    }

    const std::string& path_;
    std::string_view rest_;
    int width_ = 0, height_ = 0;
    bool upward_ = false;
    double exposure_ = 1;
};

// Nearest mantissas to the exponent of the largest channel.
Rgbe encode(const std::array<float, 3>& rgb) {
    std::array<float, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = rgb[k] > 0 ? std::min(rgb[k], 1.69e38f) : 0;
    const float largest = *std::max_element(c.begin(), c.end());
    if (!(largest > 1e-32f)) return {0, 0, 0, 0};
    int exponent = 0;
    std::frexp(largest, &exponent);
    if (std::lround(std::ldexp(largest, 8 - exponent)) == 256) ++exponent;
    Rgbe out{};
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] = static_cast<std::uint8_t>(std::lround(std::ldexp(c[k], 8 - exponent)));
    }
    out[3] = static_cast<std::uint8_t>(exponent + 128);
    return out;
}

// One channel of a line: runs of at least 4 equal bytes, and what lies between them as it is.
void append_runs(std::string& out, const std::vector<Rgbe>& line, std::size_t channel) {
    auto run_at = [&](std::size_t x) {
        std::size_t end = x + 1;
        while (end < line.size() && end - x < 127 && line[end][channel] == line[x][channel]) ++end;
        return end - x;
    };
    for (std::size_t x = 0; x < line.size();) {
        const std::size_t run = run_at(x);
        if (run >= 4) {
            out += static_cast<char>(128 + run);
            out += static_cast<char>(line[x][channel]);
            x += run;
            continue;
        }
        std::size_t end = x;
        while (end < line.size() && end - x < 128 && run_at(end) < 4) ++end;
        out += static_cast<char>(end - x);
        for (; x < end; ++x) out += static_cast<char>(line[x][channel]);
    }
}

void append_line(std::string& out, const std::vector<Rgbe>& line) {
    if (line.size() < 8 || line.size() >= 32768) {  // widths that the run-length code cannot say
        for (const Rgbe& p : line) out.append(p.begin(), p.end());
        return;
    }
    out += {2, 2, static_cast<char>(line.size() >> 8), static_cast<char>(line.size() & 0xff)};
    for (std::size_t c = 0; c < 4; ++c) append_runs(out, line, c);
}

std::string make_header(const Image& image) {
    std::string out = "#?RADIANCE\n";
    for (const auto& [key, value] : image.metadata.entries) {
        std::string comment = fmt::format("# {}: {}", key, value);
        std::replace(comment.begin(), comment.end(), '\n', ' ');
        out += comment + "\n";
    }
    return out + fmt::format("FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
}

}  // namespace

Image read_hdr(const std::string& path) {
    const std::string bytes = read_bytes(path);
    if (!bytes.starts_with("#?RADIANCE") && !bytes.starts_with("#?RGBE")) {
        throw Error(ErrorKind::Input, path, "is not a Radiance file");
    }
    return Parser(path, bytes).image();
}

void write_hdr(const std::string& path, const Image& image) {
    const auto color = image.color();
    AtomicFile file(path);
    std::string out = make_header(image);
    std::vector<Rgbe> line(static_cast<std::size_t>(image.width));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::size_t i = image.index(x, y);
            line[static_cast<std::size_t>(x)] = encode({color[0][i], color[1][i], color[2][i]});
        }
        append_line(out, line);
    }
    file.write(std::span<const char>(out));
    file.commit();
}

}  // namespace gischt
