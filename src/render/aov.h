// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec.h"
#include "optics/view.h"

namespace gischt {

struct RenderSettings;  // render/method.h

// AOVs (arbitrary output variables): layers of the picture beside R, G, B, A and Z. Radiance in
// W/(m^2 sr) and every other value is a mean over the samples, so premultiplied: a sample that has
// none counts as 0. direct + indirect + emission + what is seen behind make up R, G, B.
enum class Aov {
    Direct,    // light that was scattered once
    Indirect,  // light that was scattered more often
    Emission,  // light that came unscattered from glowing media and surfaces
    Albedo,    // of the first scattering: single-scattering albedo or reflectance
    Normal,    // unit, towards the camera's side: of the surface or against the density gradient
    Motion,    // of what was hit, in pixels per frame, x to the right and y down
    Transmittance,  // of what lies in front of the background
    Variance,       // of the pixel's mean luminance; from the film, not from the method
    Samples,        // per pixel; from the film
};

struct AovInfo {
    Aov aov;
    std::string_view name;      // of the layer and in `film.aovs`
    std::string_view channels;  // one letter each
};
// In the order of the enum.
std::span<const AovInfo> aov_table();

// Where a method puts the values of a sample: places in `extra` of PixelWorker::sample, -1 for what
// is not asked for.
struct AovLayout {
    std::vector<std::string> channels;  // of the film: "direct.R", ..., "light_key.R", ...
    int direct = -1, indirect = -1, emission = -1, albedo = -1, normal = -1, motion = -1,
        transmittance = -1;
    bool variance = false, samples = false;
    // Of the light's group, by index in view.lights; -1 for a light without group. What reaches the
    // camera from that light, scattered or not, is to be added there.
    std::vector<int> light_group;

    // Adds to the channels at a place; nothing happens at place -1.
    static void add(std::span<float> extra, int place, const Vec3f& value) {
        if (place < 0) return;
        for (int c = 0; c < 3; ++c) extra[static_cast<std::size_t>(place + c)] += value[c];
    }
    static void add(std::span<float> extra, int place, Vec2f value) {
        if (place < 0) return;
        extra[static_cast<std::size_t>(place)] += value.x;
        extra[static_cast<std::size_t>(place) + 1] += value.y;
    }
};

// What a method can fill in, beside variance and samples.
struct AovSupport {
    std::string_view method;
    std::span<const Aov> aovs{};
    bool light_groups = false;
};

// The layout for settings.aovs (names, or "all" for whatever the method can) and, where the method
// separates them, for the groups of the view's lights, in alphabetical order. Throws Error{Usage}
// for an unknown name and for one that the method cannot fill in.
AovLayout aov_layout(const View& view, const RenderSettings& settings, const AovSupport& support);

}  // namespace gischt
