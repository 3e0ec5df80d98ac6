// SPDX-License-Identifier: Apache-2.0
#include "io/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "io/atomic_file.h"

namespace gischt {
namespace {

// The file in memory, so that its bytes reach the disk through AtomicFile alone.
class MemoryOutput : public Imf::OStream {
  public:
    MemoryOutput() : OStream("memory") {}
    void write(const char* in, int n) override {
        const auto count = static_cast<std::size_t>(n);
        if (position_ + count > bytes.size()) bytes.resize(position_ + count);
        std::memcpy(bytes.data() + position_, in, count);
        position_ += count;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::string bytes;

  private:
    std::size_t position_ = 0;
};

// Whether half keeps 10 bits of all that is within a thousandth of the largest value.
bool suits_half(const Channel& plane) {
    float largest = 0;
    for (const float v : plane.values) {
        if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
    }
    return largest == 0 || (largest >= 0.0625f && largest <= 65504.0f);
}

bool as_half(const Channel& plane, const ExrOptions& options) {
    const auto& always = options.float_channels;
    return options.half && std::find(always.begin(), always.end(), plane.name) == always.end() &&
           suits_half(plane);
}

Imf::Header make_header(const std::string& path, const Image& image) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec.709 with D65
    for (const auto& [key, value] : image.metadata.entries) {
        if (key.empty() || key.size() > 255 || header.find(key) != header.end()) {
            throw Error(ErrorKind::Usage, path, fmt::format("metadata key '{}'", key),
                        "OpenEXR reserves it; choose another name");
        }
        header.insert(key, Imf::StringAttribute(value));
    }
    return header;
}

// The bytes of the file.
std::string encode(const std::string& path, const Image& image, const ExrOptions& options) {
    Imf::Header header = make_header(path, image);
    Imf::FrameBuffer frame;
    std::vector<std::vector<half>> halves(image.planes.size());
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < image.planes.size(); ++i) {
        const Channel& plane = image.planes[i];
        const bool half_type = as_half(plane, options);
        const Imf::PixelType type = half_type ? Imf::HALF : Imf::FLOAT;
        header.channels().insert(plane.name, Imf::Channel(type));
        const std::size_t size = half_type ? sizeof(half) : sizeof(float);
        const void* data = plane.values.data();
        if (half_type) {
            halves[i].assign(plane.values.begin(), plane.values.end());
            data = halves[i].data();
        }
        // The library wants a pointer that it could write through; for output it only reads.
        char* base = const_cast<char*>(static_cast<const char*>(data));
        frame.insert(plane.name, Imf::Slice(type, base, size, size * width));
    }
    MemoryOutput out;
    {
        Imf::OutputFile file(out, header);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }
    return std::move(out.bytes);
}

}  // namespace

void write_exr(const std::string& path, const Image& image, const ExrOptions& options) {
    if (image.planes.empty()) throw Error(ErrorKind::Usage, path, "the image has no channels");
    AtomicFile file(path);  // first, so that a folder that cannot be written is found at once
    std::string bytes;
    try {
        bytes = encode(path, image, options);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throw Error(ErrorKind::Resource, path, fmt::format("cannot write OpenEXR: {}", e.what()));
    }
    file.write(std::span<const char>(bytes));
    file.commit();
}

}  // namespace gischt
