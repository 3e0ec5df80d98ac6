// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "base/error.h"

namespace gischt {
namespace {

constexpr int max_side = 65536;  // wider than any film; keeps width * height * 4 bytes addressable

std::vector<float> zeros(std::size_t count) {
    try {
        return std::vector<float>(count, 0.0f);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, "image",
                    fmt::format("no memory for {:.1f} MB of pixels", 4e-6 * double(count)),
                    "make the image smaller");
    }
}

[[noreturn]] void throw_missing(const Image& image, std::string_view name) {
    std::string there;
    for (const Channel& p : image.planes) there += (there.empty() ? "" : ", ") + p.name;
    throw Error(ErrorKind::Input, "image", fmt::format("no channel '{}'", name),
                there.empty() ? "it has no channels" : "channels: " + there);
}

}  // namespace

void Metadata::set(std::string_view key, std::string_view value) {
    for (auto& [k, v] : entries) {
        if (k == key) {
            v = value;
            return;
        }
    }
    entries.emplace_back(key, value);
}

std::string Metadata::get(std::string_view key) const {
    for (const auto& [k, v] : entries) {
        if (k == key) return v;
    }
    return {};
}

Image::Image(int image_width, int image_height, std::span<const std::string_view> channels)
    : width(image_width), height(image_height) {
    if (width < 1 || height < 1 || width > max_side || height > max_side) {
        throw Error(ErrorKind::Usage, "image", fmt::format("size {} x {}", width, height),
                    fmt::format("each side must be 1 to {}", max_side));
    }
    for (const std::string_view name : channels) add_channel(name);
}

Image Image::rgb(int width, int height) {
    return {width, height, std::array<std::string_view, 3>{"R", "G", "B"}};
}

Image Image::rgba(int width, int height) {
    return {width, height, std::array<std::string_view, 4>{"R", "G", "B", "A"}};
}

const Channel* Image::find(std::string_view channel) const {
    const auto it = std::find_if(planes.begin(), planes.end(),
                                 [&](const Channel& p) { return p.name == channel; });
    return it == planes.end() ? nullptr : &*it;
}

std::span<const float> Image::channel(std::string_view name) const& {
    const Channel* plane = find(name);
    if (!plane) throw_missing(*this, name);
    return plane->values;
}

std::span<float> Image::channel(std::string_view name) & {
    const Channel* plane = find(name);
    if (!plane) throw_missing(*this, name);
    return planes[static_cast<std::size_t>(plane - planes.data())].values;
}

std::span<float> Image::add_channel(std::string_view name) {
    if (!has(name)) planes.push_back({std::string(name), zeros(pixel_count())});
    return channel(name);
}

std::array<std::span<const float>, 3> Image::color(std::string_view layer) const& {
    const std::string prefix = layer.empty() ? std::string() : std::string(layer) + ".";
    if (!has(prefix + "R") && has(prefix + "Y")) {
        const auto grey = channel(prefix + "Y");
        return {grey, grey, grey};
    }
    return {channel(prefix + "R"), channel(prefix + "G"), channel(prefix + "B")};
}

std::array<std::span<float>, 3> Image::color() & {
    return {channel("R"), channel("G"), channel("B")};
}

}  // namespace gischt
