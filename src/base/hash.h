// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace gischt {

// FNV-1a, 64 bits (Fowler, Noll, Vo 1991): names a scene or file's content; not cryptographic.
std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed = 0xcbf29ce484222325ULL);

// The hash as 16 hexadecimal digits.
std::string hex(std::uint64_t hash);

}  // namespace gischt
