// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "render/realtime/gl_camera.h"
#include "render/realtime/lit_grid.h"

namespace gischt {

// How a piece of media is drawn over what lies behind it: it adds the first colour, and lets
// through 1 - coverage; or, where its channels lose differently, the share of each that the second
// colour of the shader says.
GlDraw over_draw(bool is_grey);

// A LitGrid as textures: what every cell adds to a ray (source, W/(m^3 sr)) and takes from it
// (extinction, 1/m), for one camera. Where the phase functions are not even, the source depends on
// where the camera stands, and is made anew by a compute shader; the light itself is kept.
class LitVolume {
  public:
    explicit LitVolume(GlDevice& device);

    // What is scattered of the light `apart`, an index of grid.lights, goes to lit() in place of
    // source().
    void upload(const LitGrid& grid, std::optional<std::size_t> apart = {});
    // Does nothing when the source that is there holds for this camera.
    void shade(const GlCamera& camera);

    bool is_empty() const { return cells_ == Vec3i(); }
    bool is_grey() const { return extinction_.is_empty(); }
    // Three of source and one of the strongest channel's extinction.
    const GlTexture& source() const { return source_; }
    // Of three channels; only where not is_grey().
    const GlTexture& extinction() const { return extinction_; }
    // What every cell adds of the light that is kept apart, per share of it that the media on its
    // way let through, W/(m^3 sr). Only where there is such a light.
    const GlTexture& lit() const { return lit_; }
    // The largest extinction of each block of cells with the cells that touch it; 0 only where
    // there is nothing to see.
    const GlTexture& blocks() const { return blocks_; }
    static constexpr int block = 8;  // cells along an edge

    const Box3d& box() const { return box_; }
    const Vec3i& cells() const { return cells_; }
    Vec3d origin() const { return 0.5 * (box_.lo + box_.hi); }
    double reach() const { return 0.5 * length(box_.size()); }
    std::size_t bytes() const;  // of all textures

  private:
    struct Medium {
        GridMedium constants;
        GlTexture density, color;
        int phase_row = 0;  // of its first octave
    };
    struct Light {
        bool is_infinite = false, is_everywhere = true;
        Vec3f place, color;  // relative to the origin
        GlTexture depth;     // and arrival in the last channel
    };

    void upload_media(const LitGrid& grid);
    void upload_lights(const LitGrid& grid);
    void upload_blocks(const LitGrid& grid);
    void set_phase(const LitGrid& grid);
    void start_medium(std::size_t m);
    void scatter_medium(std::size_t m, const GlCamera& camera);

    GlDevice& device_;
    GlProgram start_, scatter_;
    Box3d box_;
    Vec3i cells_;
    std::vector<Medium> media_;
    std::vector<Light> lights_;
    std::vector<GlTexture> sky_;  // by medium
    GlTexture emission_, phase_, source_, extinction_, blocks_, lit_;
    GlBuffer dense_blocks_;  // coordinates of the blocks that hold something
    int block_count_ = 0;
    Vec3i groups_;
    bool is_even_ = true;  // all phase functions
    int phase_rows_ = 0;
    std::optional<std::size_t> apart_;
    std::optional<GlCamera> shaded_;
};

}  // namespace gischt
