// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/compare.h"
#include "studio/production.h"

namespace gischt {

// One scene by every method, compared with a reference. Of Order, the first of `frames`, `cache`,
// `preview`, `noise` and `time_limit` have a meaning.
struct LadderOrder : Order {
    std::vector<std::string> methods;  // none: all that show light
    std::string reference = "path";    // a method, or a picture (.exr, .hdr)
    int reference_samples = 0;  // per pixel, where a method makes it; 0: four times the scene's
    std::filesystem::path folder;
};

// A method at a depth.
struct LadderRung {
    std::string method;
    int depth = 1;      // most scattering events
    std::string label;  // "march, depth 2"
};

// What became of it.
struct LadderStep {
    LadderRung rung;
    std::string refusal;    // why there is no picture; empty: there is one
    Image image;            // W/(m^2 sr)
    Comparison difference;  // from the reference
    RenderStatistics statistics;
    double wall_seconds = 0, cpu_seconds = 0;
};

struct Ladder {
    std::vector<LadderStep> steps;  // from the simplest method to the most complete
    Image reference;
    std::string reference_label;  // "path, 256 samples per pixel", or the file
};

// The rungs of a scene whose light is to be followed up to `depth`: the methods in the order of
// their table, the march at depth 1, 2, 3 and the scene's. Throws Error{Usage} with the nearest
// name for a method that does not exist, and for `field`, which shows no light.
std::vector<LadderRung> ladder_rungs(const std::vector<std::string>& methods, int depth);

// Renders all rungs. A method that cannot show the scene is a step with its refusal. Throws
// Error{Input} when a reference picture has another size than the scene's film.
Ladder render_ladder(const LoadedScene& scene, const LadderOrder& order, RunStatistics& run,
                     Job& job);

// Writes into the folder: an .exr and .png of each picture and of the reference,
// NAME-difference.png of each, ladder.png (the labelled sheet of all of them) and ladder.md (the
// table). Returns the paths.
std::vector<std::string> write_ladder(const LoadedScene& scene, const LadderOrder& order,
                                      const Ladder& ladder, RunStatistics& run);

// (A - B) / mean luminance of B: -1 blue, 0 light grey, 1 red; display-linear.
Image difference_image(const Image& a, const Image& b);

}  // namespace gischt
