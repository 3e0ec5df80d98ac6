// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gischt {

// Ordered pairs of key and text that travel with an image: version, command, seed, scene_hash,
// exposure, units. EXR keeps them as string attributes, PNG as text chunks.
struct Metadata {
    std::vector<std::pair<std::string, std::string>> entries;

    // Replaces the value of a key that exists, else appends.
    void set(std::string_view key, std::string_view value);
    // The value, or an empty string.
    std::string get(std::string_view key) const;
    bool operator==(const Metadata&) const = default;
};

// One channel: width * height values, rows from top to bottom, columns from left to right.
struct Channel {
    std::string name;  // "R", "G", "B", "A", "Z"; in a layer "direct.R"
    std::vector<float> values;
    bool operator==(const Channel&) const = default;
};

// Named float channels of one size. R, G, B are linear radiance with Rec.709 primaries and white
// D65, a flat spectrum of 1 W/(m^2 sr) being (1, 1, 1), premultiplied by A, the coverage in [0,1].
// Z is the distance along the view axis in metres, infinity where nothing was hit.
struct Image {
    int width = 0, height = 0;
    std::vector<Channel> planes;
    Metadata metadata;

    Image() = default;
    // Channels are zero. Throws Error{Usage} unless 1 <= width, height <= 65536, and
    // Error{Resource} when the memory does not suffice.
    Image(int image_width, int image_height, std::span<const std::string_view> channels);
    static Image rgb(int width, int height);
    static Image rgba(int width, int height);

    std::size_t pixel_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    // Position of a pixel in a plane.
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    bool has(std::string_view channel) const { return find(channel) != nullptr; }
    // Null when there is no such channel. Linear search: look up once, not per pixel.
    const Channel* find(std::string_view channel) const;
    // The values of a channel. Throws Error{Input}, naming the channels there are. Not on a
    // temporary image, whose values would be gone.
    std::span<float> channel(std::string_view name) &;
    std::span<const float> channel(std::string_view name) const&;
    void channel(std::string_view name) && = delete;
    // A new channel of zeros, or the one of that name if it exists.
    std::span<float> add_channel(std::string_view name);
    // The planes R, G, B, of a layer if one is named ("direct"); one grey channel "Y" stands for
    // all three. Throws Error{Input} when neither is there.
    std::array<std::span<const float>, 3> color(std::string_view layer = {}) const&;
    std::array<std::span<float>, 3> color() &;
    void color(std::string_view layer = {}) && = delete;

    bool operator==(const Image&) const = default;
};

}  // namespace gischt
