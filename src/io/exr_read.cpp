// SPDX-License-Identifier: Apache-2.0
#include "io/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "base/error.h"
#include "image/primaries.h"
#include "io/exr_check.h"
#include "io/file_bytes.h"

namespace gischt {
namespace {

class MemoryInput : public Imf::IStream {
  public:
    MemoryInput(const std::string& name, const std::string& bytes)
        : IStream(name.c_str()), bytes_(bytes) {}
    bool read(char* out, int n) override {
        const auto count = static_cast<std::size_t>(n);
        if (n < 0 || position_ > bytes_.size() || count > bytes_.size() - position_) {
            throw std::runtime_error("ends too early");
        }
        std::memcpy(out, bytes_.data() + position_, count);
        position_ += count;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    const std::string& bytes_;
    std::size_t position_ = 0;
};

// Largest factor by which a compression shrinks pixels. A header that claims more pixels than that
// lies, and would only be found out after the memory for them had been taken.
double largest_ratio(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
            return 1;
        case Imf::RLE_COMPRESSION:
            return 64;                // 2 bytes for 128
        case Imf::ZIPS_COMPRESSION:   // deflate: 1032 (RFC 1951)
        case Imf::ZIP_COMPRESSION:    //
        case Imf::PXR24_COMPRESSION:  // and a byte less per value
        case Imf::PIZ_COMPRESSION:
            return 1400;            // Huffman runs of 255 16-bit words in 13 bits
        case Imf::B44_COMPRESSION:  //
        case Imf::B44A_COMPRESSION:
            return 11;  // 32 bytes in 3
        default:
            return 5000;  // DWA: constant blocks; an estimate
    }
}

struct Window {
    int x0, y0, width, height;  // pixels
};

// Refuses sizes that no image of ours can have before anything is computed with them.
Window checked(const Imath::Box2i& box, const char* name) {
    const std::int64_t width = std::int64_t{box.max.x} - box.min.x + 1;
    const std::int64_t height = std::int64_t{box.max.y} - box.min.y + 1;
    if (width < 1 || height < 1 || width > 65536 || height > 65536) {
        throw std::runtime_error(fmt::format("{} of {} x {} pixels", name, width, height));
    }
    return {box.min.x, box.min.y, static_cast<int>(width), static_cast<int>(height)};
}

void check_amount(const Imf::Header& header, const Window& data, const Window& display,
                  std::size_t file_size) {
    const double area = 1.0 * data.width * data.height,
                 shown = 1.0 * display.width * display.height;
    if (shown > 16e6 && shown > 16 * area) throw std::runtime_error("display window far too large");
    double bytes_per_pixel = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
            throw std::runtime_error(
                fmt::format("channel '{}' is subsampled, which gischt cannot "
                            "read",
                            c.name()));
        }
        bytes_per_pixel += c.channel().type == Imf::HALF ? 2 : 4;
    }
    const double bytes = bytes_per_pixel * area;
    constexpr double harmless = 64e6;  // bytes that may be taken without a proof
    if (bytes > harmless + largest_ratio(header.compression()) * static_cast<double>(file_size)) {
        throw std::runtime_error(fmt::format("claims {} x {} pixels, more than {} bytes can hold",
                                             data.width, data.height, file_size));
    }
}

// Reads one channel's data window and lays it into the display window of a plane.
void lay(const std::vector<float>& values, const Window& data, const Window& display,
         std::span<float> plane) {
    for (int y = 0; y < data.height; ++y) {
        const int row = data.y0 + y - display.y0;
        if (row < 0 || row >= display.height) continue;
        for (int x = 0; x < data.width; ++x) {
            const int column = data.x0 + x - display.x0;
            if (column < 0 || column >= display.width) continue;
            plane[static_cast<std::size_t>(row) * static_cast<std::size_t>(display.width) +
                  static_cast<std::size_t>(column)] =
                values[static_cast<std::size_t>(y) * static_cast<std::size_t>(data.width) +
                       static_cast<std::size_t>(x)];
        }
    }
}

void read_part(Imf::MultiPartInputFile& file, int number, std::size_t file_size, Image& image) {
    const Imf::Header& header = file.header(number);
    const Window display = checked(header.displayWindow(), "display window");
    const Window data = checked(header.dataWindow(), "data window");
    check_amount(header, data, display, file_size);
    const auto pixels =
        static_cast<std::size_t>(data.width) * static_cast<std::size_t>(data.height);

    // All channels in one go, as the library decompresses a block for every call.
    std::vector<std::string> names;
    std::vector<std::vector<float>> values;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        names.emplace_back(c.name());
        values.emplace_back(pixels);
    }
    Imf::FrameBuffer frame;
    const Imath::V2i origin(data.x0, data.y0);
    for (std::size_t i = 0; i < names.size(); ++i) {
        frame.insert(
            names[i],
            Imf::Slice::Make(Imf::FLOAT, values[i].data(), origin, data.width, data.height,
                             sizeof(float), sizeof(float) * static_cast<std::size_t>(data.width)));
    }
    Imf::InputPart part(file, number);
    part.setFrameBuffer(frame);
    part.readPixels(data.y0, data.y0 + data.height - 1);

    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool taken = image.has(names[i]) && header.hasName();
        const std::string name = taken ? header.name() + "." + names[i] : names[i];
        lay(values[i], data, display, image.add_channel(name));
    }
}

bool is_flat(const Imf::Header& header) {
    return !header.hasType() || header.type() == Imf::SCANLINEIMAGE ||
           header.type() == Imf::TILEDIMAGE;
}

// The matrix to Rec.709, where the file names chromaticities that are noticeably different.
std::optional<Transform> to_rec709(const Imf::Header& header) {
    if (!Imf::hasChromaticities(header)) return {};
    const Imf::Chromaticities c = Imf::chromaticities(header), d;
    const std::array<Imath::V2f, 8> both{c.red, c.green, c.blue, c.white,
                                         d.red, d.green, d.blue, d.white};
    float difference = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        difference = std::max(difference, (both[i] - both[i + 4]).length());
        if (both[i].y == 0) return {};  // blue of ACES AP0 has y < 0
    }
    if (!(difference > 1e-3f)) return {};
    auto xy = [](const Imath::V2f& v) { return Vec2d{v.x, v.y}; };
    const Primaries file{xy(c.red), xy(c.green), xy(c.blue), xy(c.white)};
    const Transform matrix = convert_primaries(file, rec709_primaries);
    return std::isfinite(matrix.determinant()) ? std::optional(matrix) : std::nullopt;
}

// Converts every layer that has R, G and B.
void convert_colors(Image& image, const Transform& matrix) {
    for (std::size_t k = 0; k < image.planes.size(); ++k) {
        const std::string name = image.planes[k].name;
        if (name != "R" && !name.ends_with(".R")) continue;
        const std::string layer = name.substr(0, name.size() - 1);
        if (!image.has(layer + "G") || !image.has(layer + "B")) continue;
        const auto r = image.channel(name), g = image.channel(layer + "G"),
                   b = image.channel(layer + "B");
        for (std::size_t i = 0; i < r.size(); ++i) {
            const Vec3f c(matrix.vector({r[i], g[i], b[i]}));
            r[i] = c.x, g[i] = c.y, b[i] = c.z;
        }
    }
}

// OpenEXR keeps channels sorted, B before R: give the colour back its usual order.
void sort_channels(Image& image) {
    auto rank = [](const Channel& p) {
        const std::string last = p.name.substr(p.name.rfind('.') + 1);  // npos + 1 is 0
        const std::size_t place = std::string("RGBA").find(last);
        const std::string layer = p.name.substr(0, p.name.size() - last.size());
        return std::make_pair(layer, last.size() == 1 && place < 4 ? place : 4);
    };
    std::stable_sort(image.planes.begin(), image.planes.end(),
                     [&](const Channel& a, const Channel& b) { return rank(a) < rank(b); });
}

Image decode(const std::string& path, const std::string& bytes) {
    check_exr_attributes(bytes);
    MemoryInput in(path, bytes);
    // No reconstruction of a chunk table that an interrupted writer left out: such a file is
    // broken.
    Imf::MultiPartInputFile file(in, 0, false);
    Image image;
    for (int p = 0; p < file.parts(); ++p) {
        const Imf::Header& header = file.header(p);
        if (!is_flat(header)) continue;
        const Window display = checked(header.displayWindow(), "display window");
        if (image.width == 0) {
            image = Image(display.width, display.height, {});
            for (auto a = header.begin(); a != header.end(); ++a) {
                const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
                const bool own =
                    std::string_view(a.name()) == "type" || std::string_view(a.name()) == "name";
                if (text && !own) image.metadata.set(a.name(), text->value());
            }
        }
        if (display.width != image.width || display.height != image.height) continue;
        read_part(file, p, bytes.size(), image);
    }
    if (image.planes.empty()) throw std::runtime_error("holds no flat image");
    if (const auto matrix = to_rec709(file.header(0))) convert_colors(image, *matrix);
    sort_channels(image);
    return image;
}

}  // namespace

Image read_exr(const std::string& path) {
    const std::string bytes = read_bytes(path);
    constexpr std::string_view magic("\x76\x2f\x31\x01", 4);
    if (std::string_view(bytes).substr(0, 4) != magic) {
        throw Error(ErrorKind::Input, path, "is not an OpenEXR file");
    }
    try {
        return decode(path, bytes);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, path, "the image does not fit into memory");
    } catch (const std::exception& e) {
        throw Error(ErrorKind::Input, path, fmt::format("broken OpenEXR file: {}", e.what()));
    }
}

}  // namespace gischt
