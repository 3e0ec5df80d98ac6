// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/job.h"
#include "image/film_state.h"
#include "image/image.h"
#include "optics/view.h"

namespace gischt {

struct RenderParams;  // render/params.h: the parameters of all methods

// What all methods are told beside the view. A method that has no use for a member ignores it.
struct RenderSettings {
    int samples_per_pixel = 16;
    int first_sample = 0;  // the samples rendered are [first, first + samples_per_pixel)
    std::uint64_t seed = 0;
    int depth = 1;          // most scattering events of a light path
    double noise = 0;       // stop at this relative noise; 0: never
    double time_limit = 0;  // stop after this many seconds of wall time; 0: never
    FilterKind filter = FilterKind::BlackmanHarris;
    double filter_radius = 0;  // pixels; 0: the filter's own
    bool preview = false;      // coarser numbers, the same picture
    // With noise: parts of the picture that are good enough get no further samples.
    bool adaptive = true;
    std::vector<std::string> aovs;  // further layers, by the names of render/aov.h; "all"

    // Called about every partial_interval seconds with the picture so far, by one thread at a time;
    // null is allowed.
    std::function<void(const Image&)> on_partial;
    double partial_interval = 3;  // s

    // Where the film is kept; null: nobody sees it. One that holds samples already is gone on with,
    // to the same bits as if it had been made at once; it must have the view's size, the filter,
    // the channels, and the samples [first_sample, n) of every pixel, n differing among them. After
    // an Error{Cancelled} it can be gone on with later.
    FilmState* film = nullptr;
    // Called about every checkpoint_interval seconds when `film` is a good state to save, by one
    // thread at a time; null is allowed.
    std::function<void()> on_checkpoint;
    double checkpoint_interval = 30;  // s
};

struct RenderStatistics {
    double samples_per_pixel = 0;
    std::int64_t rays = 0;     // segments followed: camera, shadow, scattered
    std::int64_t lookups = 0;  // evaluations of a medium's or field's values at a point
    double noise = 0;          // sqrt(mean variance of the pixel means) / mean; 0 where unknown
    double wall_seconds = 0;
};

struct RenderResult {
    // R, G, B premultiplied by A, and Z (see image/image.h); metadata "method", "samples", "seed".
    Image image;
    RenderStatistics statistics;
};

// One way to turn a view into an image. The same view, settings and parameters give the same bits
// on any number of threads. A method keeps no state between calls.
class RenderMethod {
  public:
    virtual ~RenderMethod() = default;
    // Throws Error{Usage} when the method cannot show this view, and Error{Cancelled} when the job
    // is.
    virtual RenderResult render(const View& view, const RenderSettings& settings, Job& job) = 0;
};

// A row of the table of methods, for `gischt methods`.
struct MethodInfo {
    std::string_view name;
    std::string_view simulates;   // what light does in it
    std::string_view leaves_out;  // and what it does not
    std::string_view cost;        // what its time grows with
    std::unique_ptr<RenderMethod> (*make)(const RenderParams&);
};

// All methods, from preview to final.
std::span<const MethodInfo> render_methods();

// Throws Error{Usage} with the nearest name for one that does not exist.
const MethodInfo& find_method(std::string_view name);
std::unique_ptr<RenderMethod> make_method(std::string_view name, const RenderParams& params);

}  // namespace gischt
