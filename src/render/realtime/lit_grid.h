// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/job.h"
#include "optics/medium_bake.h"
#include "optics/view.h"
#include "render/march/octave.h"
#include "render/realtime/grid_params.h"

namespace gischt {

// A light that comes from one direction at each point, and how much of it reaches the cells.
struct GridLight {
    LightPtr light;
    bool is_infinite = false;
    Vec3d place;  // unit vector towards it, or its position in metres
    Vec3f color;  // W/m^2 where `arrival` is 1
    // Optical depth between the light and the centre of each cell: one channel if all media are
    // grey, else three.
    std::vector<std::vector<float>> depth;
    // Share of the colour that would arrive without media: surfaces in the way, distance, cone.
    // Empty where it is 1 everywhere.
    std::vector<float> arrival;
};

// A medium's constants.
struct GridMedium {
    Vec3f extinction, scattering;  // 1/m at density 1
    std::vector<Octave> octaves;
};

// The light of the sky that reaches each cell of a coarser grid, as if it came evenly from all
// sides: mean radiance over the sphere, dimmed, W/(m^2 sr). One set for each medium, which its
// octaves of approximate multiple scattering are part of.
struct GridSky {
    Vec3i cells;
    std::vector<std::vector<Vec3f>> radiance;
    std::vector<float> seen;  // share of the light that is not absorbed on the way
};

// All that graphics hardware is told of the media and lights of a view, made by the processor. It
// holds for every camera.
class LitGrid {
  public:
    // Nothing where the view has no media, or empty ones. Throws Error{Usage}, with the name of
    // the method in front, for media without end, lights with a size, and surfaces that are not
    // Lambert's.
    LitGrid(const View& view, const GridParams& params, std::string_view method, Job& job);

    bool is_empty() const { return matter.media.empty(); }
    bool is_grey() const { return is_grey_; }
    // Whether this is still the light of a view: the camera alone has moved.
    bool holds_for(const View& view) const;
    Vec3d cell_size() const { return matter.box.size() / Vec3d(matter.cells); }
    // Extinction of one channel in every cell, 1/m.
    std::vector<float> extinction(int channel) const;
    // Share of a light's colour that reaches a point, which may lie outside of the box, through the
    // media; surfaces not counted.
    Vec3f transmittance(const GridLight& light, const Vec3d& point, const Vec3d& towards) const;
    // The share of the sky's light, the same way.
    float sky_seen(const Vec3d& point) const;

    MatterGrid matter;
    std::vector<GridMedium> media;
    std::vector<GridLight> lights;
    std::vector<const Light*> broad;  // lights from all of the sky
    std::optional<GridSky> sky;

  private:
    void lay(const View& view, int resolution, Job& job);
    void light_cells(GridLight& light, const View& view, LightGridMethod method, Job& job) const;
    void light_sky(const View& view, int directions, Job& job);

    bool is_grey_ = true;
    // What it was made of, kept so that it can be recognized.
    std::vector<std::shared_ptr<const Medium>> view_media_;
    std::vector<LightPtr> view_lights_;
    SurfaceSet surfaces_;
};

}  // namespace gischt
