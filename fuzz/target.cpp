// SPDX-License-Identifier: Apache-2.0
// What libFuzzer calls; GISCHT_READER is one of readers.h.
#include <cstddef>
#include <cstdint>

#include "readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    gischt::GISCHT_READER({reinterpret_cast<const char*>(data), size});
    return 0;
}
