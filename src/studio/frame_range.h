// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gischt {

// Frames first, first + step, ... up to last.
struct FrameRange {
    int first = 1, last = 1, step = 1;

    int count() const { return (last - first) / step + 1; }
    int operator[](int index) const { return first + index * step; }
    bool operator==(const FrameRange&) const = default;
};

// "A-B", "A-BxSTEP" or "A". Throws Error{Usage} with the form expected.
FrameRange parse_frame_range(std::string_view text);

// The path of a frame: "dir/name.png" becomes "dir/name_0001.png".
std::filesystem::path frame_path(const std::filesystem::path& path, int frame);

}  // namespace gischt
