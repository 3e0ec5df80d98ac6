// SPDX-License-Identifier: Apache-2.0
#include "studio/frame_range.h"

#include <fmt/format.h>

#include <charconv>

#include "base/error.h"

namespace gischt {

// Reads a number at the start of `text` and removes it.
static bool take_number(std::string_view& text, int& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

static bool take(std::string_view& text, char c) {
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
}

FrameRange parse_frame_range(std::string_view text) {
    FrameRange range;
    std::string_view rest = text;
    bool good = take_number(rest, range.first);
    range.last = range.first;
    if (good && take(rest, '-')) {
        good = take_number(rest, range.last);
        if (good && take(rest, 'x')) good = take_number(rest, range.step);
    }
    if (!good || !rest.empty() || range.first < 0 || range.last < range.first || range.step < 1) {
        throw Error(ErrorKind::Usage, "--frames", fmt::format("'{}' is no range of frames", text),
                    "write A-B, A-BxSTEP or A with 0 <= A <= B and STEP >= 1");
    }
    constexpr int most_frames = 100'000'000;  // 48 days at 24 frames per second
    if (range.last >= most_frames) {
        throw Error(ErrorKind::Usage, "--frames",
                    fmt::format("frame {} is beyond the last possible one", range.last),
                    fmt::format("frames go up to {}", most_frames - 1));
    }
    return range;
}

std::filesystem::path frame_path(const std::filesystem::path& path, int frame) {
    std::filesystem::path out = path;
    out.replace_filename(
        fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()));
    return out;
}

}  // namespace gischt
