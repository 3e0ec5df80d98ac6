// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studio/flipbook_sheet.h"
#include "studio/production.h"

namespace gischt {

// The sheets of a flipbook, by what they show.
struct FlipbookLayers {
    bool color = true, emission = true, depth = true, motion = true, light = true;
};
// From names: color, emission, depth, motion, light; none means all of them. Throws Error{Usage}
// with the nearest name.
FlipbookLayers flipbook_layers(const std::vector<std::string>& names);

// What is to become of a scene as sprite sheets. Of Order, `outputs` are stems with .png or .exr;
// turntable, first_sample and adaptive have no meaning.
struct FlipbookOrder : Order {
    std::optional<Vec2i> grid;  // columns, rows; unset: a sheet about as wide as high
    Vec2i cell{128, 128};       // pixels
    int loop = 0;               // frames of the cross-fade, see cell_share()
    FlipbookLayers layers;
    bool emission_asked = false;  // the emission is wanted even where nothing glows: an error
    bool premultiplied = false;   // else straight alpha
    bool fit = false;             // frame the fluids though the scene has a camera
    double light_scale = 1;       // the value of light maps that becomes 1
};

// Sheets of linear values premultiplied by their coverage, before they become files.
struct Flipbook {
    SheetLayout layout;
    int cells = 0;                // of them used, the rest is clear
    std::optional<Image> color;   // R, G, B, A, W/(m^2 sr)
    std::optional<Image> glow;    // R, G, B, A, W/(m^2 sr), where something glows
    std::optional<Image> motion;  // A, Z (m), motion.X, motion.Y (pixels per cell)
    std::optional<Image> light;  // light_sides and A; 1 is a white Lambertian wall facing the light
    CameraParams camera;
    RenderStatistics statistics;  // summed over all pictures
};

// Renders every frame into its cell, from one camera that holds still: the scene's at the first of
// the frames, or one that frames all that is seen in any of them. Throws Error{Usage} for orders
// that cannot be met, before anything is computed.
Flipbook render_flipbook(const LoadedScene& scene, const FlipbookOrder& order, RunStatistics& run,
                         Job& job);

// Writes STEM_color, STEM_emission, STEM_depth, STEM_motion, STEM_light_a and STEM_light_b in each
// of the formats, and STEM.json, which describes them. Returns the paths.
std::vector<std::string> write_flipbook(const LoadedScene& scene, const FlipbookOrder& order,
                                        Flipbook flipbook, RunStatistics& run, Job& job);

}  // namespace gischt
