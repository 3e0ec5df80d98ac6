// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "base/error.h"

namespace gischt {

static constexpr std::size_t window_size = 1 << 16;  // headers of leafs lie some 100 bytes apart

VdbBytes::VdbBytes(const std::string& path) : path_(path), window_(window_size) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (!std::filesystem::exists(status)) fail("there is no such file");
    if (std::filesystem::is_directory(status)) fail("this is a folder, not a VDB file");
    if (!std::filesystem::is_regular_file(status)) fail("this is not a regular file");
    stream_.open(path, std::ios::binary);
    if (!stream_) fail("the file cannot be opened", "is it yours to read?");
    stream_.seekg(0, std::ios::end);
    size_ = stream_.tellg();
    stream_.seekg(0);
    if (!stream_) fail("the file cannot be read");
}

void VdbBytes::fail(const std::string& what, const std::string& hint) const {
    throw Error(ErrorKind::Input, path_, what, hint);
}

void VdbBytes::fail_short() const {
    fail(fmt::format("the file is cut short or broken ({} bytes)", size_),
         "copy or write it again");
}

void VdbBytes::seek(std::int64_t position) {
    if (position < 0 || position > size_) fail_short();
    if (position >= window_at_ && position <= window_at_ + static_cast<std::int64_t>(filled_)) {
        next_ = static_cast<std::size_t>(position - window_at_);
        return;
    }
    stream_.seekg(position);
    window_at_ = position;
    next_ = filled_ = 0;
}

void VdbBytes::skip(std::int64_t bytes) {
    if (bytes < 0 || bytes > left()) fail_short();
    seek(position() + bytes);
}

std::string VdbBytes::text(std::uint64_t length) {
    if (length > static_cast<std::uint64_t>(left())) fail_short();
    std::string out(length, '\0');
    read(out.data(), length);
    return out;
}

void VdbBytes::read(char* out, std::size_t length) {
    if (length > static_cast<std::uint64_t>(left())) fail_short();
    while (length > 0) {
        if (next_ == filled_) fill();
        const std::size_t n = std::min(length, filled_ - next_);
        std::memcpy(out, window_.data() + next_, n);
        out += n;
        next_ += n;
        length -= n;
    }
}

void VdbBytes::fill() {
    window_at_ += static_cast<std::int64_t>(filled_);
    const auto wanted = std::min<std::int64_t>(size_ - window_at_, window_size);
    stream_.read(window_.data(), wanted);
    next_ = 0;
    filled_ = static_cast<std::size_t>(stream_.gcount());
    if (!stream_ || filled_ == 0) fail_short();  // someone else is shortening it
}

}  // namespace gischt
