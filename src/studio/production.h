// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/display.h"
#include "optics/view.h"
#include "studio/fluid_frames.h"
#include "studio/frame_range.h"

namespace gischt {

// What is to come of a scene, beside what the scene says.
struct Order {
    FrameRange frames;
    int turntable = 0;  // > 0: this many views around one frame, in place of a sequence
    // Patterns of pictures (.png, .exr, .hdr), states to go on with (.film) and movies (.mp4).
    std::vector<std::string> outputs;
    std::optional<std::filesystem::path> cache;
    // Where tables of probes go; unset: `probes` in the cache, and nowhere without one.
    std::optional<std::filesystem::path> probes;
    bool keeps_scene = false;  // the scene of that cache stays as it is
    bool restart = false;
    double noise = 0, time_limit = 0;  // as in RenderSettings; the time counts per picture
    int first_sample = 0;
    bool adaptive = true;  // as in RenderSettings
    bool preview = false;
    std::string command;  // for the metadata of the pictures
};

// Simulates frame by frame what is not cached; writes nothing else.
void simulate(const LoadedScene& scene, const Order& order, RunStatistics& run, Job& job);

// Renders every frame as soon as it is there, and writes the pictures and movies. Pictures get the
// frame's number where there are several. Returns the paths written.
std::vector<std::string> render(const LoadedScene& scene, const Order& order, RunStatistics& run,
                                Job& job);

// The view of one frame, as render() would show it; simulates up to it where it is not cached.
View frame_view(const LoadedScene& scene, const Order& order, int frame, RunStatistics& run,
                Job& job);

// How the scene wants its pictures shown; a picture of data, with codes of its own, as it is.
DisplayOptions display_of(const Scene& scene, const Image& image);

}  // namespace gischt
