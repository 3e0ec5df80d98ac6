// SPDX-License-Identifier: Apache-2.0
#include "gl/types.h"

namespace gischt {

int channels_of(GlFormat format) {
    switch (format) {
        case GlFormat::Rg32F:
            return 2;
        case GlFormat::Rgba32F:
        case GlFormat::Rgba16F:
        case GlFormat::Rgba8:
            return 4;
        default:
            return 1;
    }
}

std::size_t texel_bytes(GlFormat format) {
    if (format == GlFormat::Rgba8) return 4;
    return 4 * static_cast<std::size_t>(channels_of(format));
}

}  // namespace gischt
