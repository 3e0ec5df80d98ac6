// SPDX-License-Identifier: Apache-2.0
#include "render/slices/slice_glsl.h"

namespace gischt {

// Along the ray of a pixel it is spacing / cosine long, of which only
// the part before a surface counts. Within it source and extinction are constant: eq. 19.
const char* const slab_glsl = R"(
layout(binding = 2) uniform sampler2D opaque_depth;
uniform vec3 across;
uniform float spacing;

// Metres, and the depth along the view axis.
vec2 slab() {
    vec3 to = place - eye;
    float z = dot(to, forward), cosine = 1;
    float ds = spacing / max(abs(dot(forward, across)), 1e-4);
    if (is_perspective != 0) {
        float per_length = inversesqrt(dot(to, to));
        ds = spacing / max(abs(dot(to, across)) * per_length, 1e-4);
        cosine = z * per_length;
    }
#ifdef SURFACES
    float behind = texelFetch(opaque_depth, ivec2(gl_FragCoord.xy), 0).r - z;
    ds *= clamp(behind / (ds * cosine) + 0.5, 0.0, 1.0);
#endif
    return vec2(ds, z);
}
)";

}  // namespace gischt
