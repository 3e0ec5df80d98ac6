// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace gischt {

// A VDB file as bytes, read forward through a window: every length is checked against what is left
// of the file, and skipping a few bytes costs no call into the system. All members throw
// Error{Input} with the path.
class VdbBytes {
  public:
    explicit VdbBytes(const std::string& path);

    std::int64_t size() const { return size_; }
    std::int64_t position() const { return window_at_ + static_cast<std::int64_t>(next_); }
    std::int64_t left() const { return size_ - position(); }
    void seek(std::int64_t position);
    void skip(std::int64_t bytes);

    template <class T>
    T number() {
        T value;
        read(reinterpret_cast<char*>(&value), sizeof(T));
        return value;
    }
    std::string text(std::uint64_t length);
    // OpenVDB's strings: 32-bit length, bytes.
    std::string text() { return text(number<std::uint32_t>()); }
    void read(char* out, std::size_t length);

    [[noreturn]] void fail(const std::string& what, const std::string& hint = {}) const;
    // "the file is cut short or broken"
    [[noreturn]] void fail_short() const;

  private:
    void fill();

    std::string path_;
    std::ifstream stream_;
    std::int64_t size_ = 0;
    std::vector<char> window_;
    std::int64_t window_at_ = 0;         // its place in the file
    std::size_t next_ = 0, filled_ = 0;  // in the window
};

}  // namespace gischt
