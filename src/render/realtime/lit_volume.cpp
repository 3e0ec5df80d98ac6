// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/lit_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "render/realtime/lit_volume_glsl.h"

namespace gischt {
namespace {

constexpr int phase_steps = 1024;  // of the table over the angle

// Vectors as four floats, the last one 0.
std::vector<float> padded(const std::vector<Vec3f>& values) {
    std::vector<float> out(4 * values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int c = 0; c < 3; ++c) out[4 * i + static_cast<std::size_t>(c)] = values[i][c];
    }
    return out;
}

GlTextureSpec volume_spec(GlFormat format, const Vec3i& cells) {
    return {GlShape::Volume, format, cells};
}

}  // namespace

GlDraw over_draw(bool is_grey) {
    GlDraw draw;
    const BlendFactor through = is_grey ? BlendFactor::OneMinusSrcAlpha : BlendFactor::Src1Color;
    const BlendFactor alpha = is_grey ? BlendFactor::OneMinusSrcAlpha : BlendFactor::Src1Alpha;
    draw.blend = GlBlend{BlendFactor::One, through, BlendFactor::One, alpha, {}};
    return draw;
}

LitVolume::LitVolume(GlDevice& device)
    : device_(device),
      start_(device, "lit_volume_start", {{GlStageKind::Compute, start_cells_glsl}}),
      scatter_(device, "lit_volume_scatter", {{GlStageKind::Compute, scatter_cells_glsl}}) {}

void LitVolume::upload(const LitGrid& grid, std::optional<std::size_t> apart) {
    shaded_.reset();
    apart_ = apart;
    lit_ = GlTexture();
    media_.clear();
    lights_.clear();
    sky_.clear();
    emission_ = GlTexture();
    extinction_ = GlTexture();
    cells_ = {};
    box_ = {};
    if (grid.is_empty()) return;
    box_ = grid.matter.box;
    cells_ = grid.matter.cells;
    // Empty blocks are never written.
    source_ = GlTexture(device_, volume_spec(GlFormat::Rgba32F, cells_),
                        std::vector<float>(4 * volume(cells_)).data());
    if (apart_) {
        lit_ = GlTexture(device_, volume_spec(GlFormat::Rgba32F, cells_),
                         std::vector<float>(4 * volume(cells_)).data());
    }
    set_phase(grid);
    upload_media(grid);
    upload_lights(grid);
    upload_blocks(grid);
}

// Rows of a table over the angle between the way of the camera's ray and that to the light.
void LitVolume::set_phase(const LitGrid& grid) {
    std::vector<float> table;
    is_even_ = true;
    phase_rows_ = 0;
    for (const GridMedium& m : grid.media) {
        for (const Octave& o : m.octaves) {
            for (int i = 0; i < phase_steps; ++i) {
                const double angle = pi * i / (phase_steps - 1);
                table.push_back(value(o.phase, static_cast<float>(std::cos(angle))));
                const std::size_t first = table.size() - 1 - static_cast<std::size_t>(i);
                is_even_ = is_even_ && table.back() == table[first];
            }
            ++phase_rows_;
        }
    }
    phase_ = GlTexture(device_, {GlShape::Flat, GlFormat::R32F, Vec3i(phase_steps, phase_rows_, 1)},
                       table.data());
}

void LitVolume::upload_media(const LitGrid& grid) {
    int row = 0;
    for (std::size_t m = 0; m < grid.media.size(); ++m) {
        const MatterGrid::Matter& matter = grid.matter.media[m];
        Medium medium;
        medium.constants = grid.media[m];
        medium.phase_row = row;
        row += static_cast<int>(grid.media[m].octaves.size());
        medium.density =
            GlTexture(device_, volume_spec(GlFormat::R32F, cells_), matter.density.data());
        if (!matter.color.empty()) {
            medium.color = GlTexture(device_, volume_spec(GlFormat::Rgba32F, cells_),
                                     padded(matter.color).data());
        }
        media_.push_back(std::move(medium));
        if (grid.sky) {
            sky_.emplace_back(device_, volume_spec(GlFormat::Rgba32F, grid.sky->cells),
                              padded(grid.sky->radiance[m]).data());
        }
    }
    if (!grid.matter.emission.empty()) {
        emission_ = GlTexture(device_, volume_spec(GlFormat::Rgba32F, cells_),
                              padded(grid.matter.emission).data());
    }
    if (grid.is_grey()) return;
    std::vector<float> extinction(4 * volume(cells_));
    for (int c = 0; c < 3; ++c) {
        const std::vector<float> channel = grid.extinction(c);
        for (std::size_t i = 0; i < channel.size(); ++i) {
            extinction[4 * i + static_cast<std::size_t>(c)] = channel[i];
        }
    }
    extinction_ = GlTexture(device_, volume_spec(GlFormat::Rgba32F, cells_), extinction.data());
}

void LitVolume::upload_lights(const LitGrid& grid) {
    const std::size_t n = volume(cells_), channels = grid.is_grey() ? 1 : 3;
    const std::size_t stride = grid.is_grey() ? 2 : 4;
    for (const GridLight& g : grid.lights) {
        Light light;
        light.is_infinite = g.is_infinite;
        light.is_everywhere = g.arrival.empty();
        light.place = Vec3f(g.is_infinite ? g.place : g.place - origin());
        light.color = g.color;
        std::vector<float> texels(stride * n);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t c = 0; c < channels; ++c) texels[stride * i + c] = g.depth[c][i];
            if (!g.arrival.empty()) texels[stride * i + stride - 1] = g.arrival[i];
        }
        light.depth = GlTexture(
            device_, volume_spec(grid.is_grey() ? GlFormat::Rg32F : GlFormat::Rgba32F, cells_),
            texels.data());
        lights_.push_back(std::move(light));
    }
}

void LitVolume::upload_blocks(const LitGrid& grid) {
    std::vector<float> strongest(volume(cells_));
    for (int c = 0; c < (grid.is_grey() ? 1 : 3); ++c) {
        const std::vector<float> e = grid.extinction(c);
        for (std::size_t i = 0; i < e.size(); ++i) strongest[i] = std::max(strongest[i], e[i]);
    }
    // What glows without density must not be skipped either.
    constexpr float least = 1e-20f;
    for (std::size_t i = 0; i < grid.matter.emission.size(); ++i) {
        if (max_component(grid.matter.emission[i]) > 0) {
            strongest[i] = std::max(strongest[i], least);
        }
    }
    const Vec3i n = (cells_ + Vec3i(block - 1)) / Vec3i(block);
    std::vector<float> most(volume(n));
    std::size_t out = 0;
    for (Vec3i b; b.z < n.z; ++b.z) {
        for (b.y = 0; b.y < n.y; ++b.y) {
            for (b.x = 0; b.x < n.x; ++b.x, ++out) {
                const Vec3i lo = max(block * b - Vec3i(1), Vec3i(0));
                const Vec3i hi = min(block * (b + Vec3i(1)) + Vec3i(1), cells_);
                for (int k = lo.z; k < hi.z; ++k) {
                    for (int j = lo.y; j < hi.y; ++j) {
                        const std::size_t row =
                            (static_cast<std::size_t>(k) * static_cast<std::size_t>(cells_.y) +
                             static_cast<std::size_t>(j)) *
                            static_cast<std::size_t>(cells_.x);
                        for (int i = lo.x; i < hi.x; ++i) {
                            most[out] =
                                std::max(most[out], strongest[row + static_cast<std::size_t>(i)]);
                        }
                    }
                }
            }
        }
    }
    std::vector<std::array<std::int32_t, 4>> dense;
    for (std::size_t i = 0; i < most.size(); ++i) {
        const auto k = static_cast<int>(i);
        if (most[i] > 0) dense.push_back({k % n.x, k / n.x % n.y, k / n.x / n.y, 0});
    }
    dense_blocks_ = GlBuffer(device_, dense);
    block_count_ = static_cast<int>(dense.size());
    groups_ = {256, block_count_ / 256 + 1, 1};
    blocks_ = GlTexture(device_, {GlShape::Volume, GlFormat::R32F, n, false}, most.data());
}

void LitVolume::shade(const GlCamera& camera) {
    if (is_empty()) return;
    if (shaded_ && (is_even_ ||
                    (shaded_->position == camera.position && shaded_->forward == camera.forward))) {
        return;
    }
    shaded_ = camera;
    device_.bind_storage(0, dense_blocks_.id());
    for (std::size_t m = 0; m < media_.size(); ++m) {
        media_[m].density.bind(1);
        if (!media_[m].color.is_empty()) media_[m].color.bind(2);
        start_medium(m);
        scatter_medium(m, camera);
    }
}

void LitVolume::start_medium(std::size_t m) {
    const GridMedium& constants = media_[m].constants;
    source_.bind_image(0);
    start_.use();
    start_.set("cells", cells_);
    start_.set("block_count", block_count_);
    start_.set("is_first", m == 0 ? 1 : 0);
    start_.set("has_tint", media_[m].color.is_empty() ? 0 : 1);
    start_.set("has_emission", emission_.is_empty() ? 0 : 1);
    start_.set("has_sky", sky_.empty() ? 0 : 1);
    start_.set("scattering", constants.scattering);
    start_.set("extinction", max_component(constants.extinction));
    if (!emission_.is_empty()) emission_.bind(3);
    if (!sky_.empty()) sky_[m].bind(4);
    device_.dispatch(groups_);
    device_.barrier();
}

void LitVolume::scatter_medium(std::size_t m, const GlCamera& camera) {
    const Medium& medium = media_[m];
    scatter_.use();
    camera.set(scatter_);
    scatter_.set("cells", cells_);
    scatter_.set("block_count", block_count_);
    scatter_.set("has_tint", medium.color.is_empty() ? 0 : 1);
    scatter_.set("is_colored", is_grey() ? 0 : 1);
    scatter_.set("is_even", is_even_ ? 1 : 0);
    scatter_.set("scattering", medium.constants.scattering);
    scatter_.set("low", Vec3f(box_.lo - origin()));
    scatter_.set("cell", Vec3f(box_.size() / Vec3d(cells_)));
    scatter_.set("first_row", medium.phase_row);
    scatter_.set("rows", phase_rows_);
    scatter_.set("octaves", static_cast<int>(medium.constants.octaves.size()));
    for (std::size_t o = 0; o < medium.constants.octaves.size(); ++o) {
        const Octave& octave = medium.constants.octaves[o];
        scatter_.set(("octave[" + std::to_string(o) + "]").c_str(),
                     Vec2f{octave.attenuation, octave.contribution});
    }
    phase_.bind(6);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const Light& light = lights_[i];
        if (max_component(light.color) <= 0) continue;
        const bool is_apart = apart_ == i;
        (is_apart ? lit_ : source_).bind_image(0);
        light.depth.bind(5);
        scatter_.set("is_apart", is_apart ? 1 : 0);
        scatter_.set("is_first", is_apart && m == 0 ? 1 : 0);
        scatter_.set("is_infinite", light.is_infinite ? 1 : 0);
        scatter_.set("has_arrival", light.is_everywhere ? 0 : 1);
        scatter_.set("light_color", light.color);
        scatter_.set("light_place", light.place);
        device_.dispatch(groups_);
        device_.barrier();
    }
}

std::size_t LitVolume::bytes() const {
    const auto of = [](const GlTexture& t) {
        return t.is_empty() ? 0 : volume(t.spec().size) * texel_bytes(t.spec().format);
    };
    std::size_t sum =
        of(source_) + of(extinction_) + of(blocks_) + of(emission_) + of(phase_) + of(lit_);
    for (const Medium& m : media_) sum += of(m.density) + of(m.color);
    for (const Light& l : lights_) sum += of(l.depth);
    for (const GlTexture& s : sky_) sum += of(s);
    return sum;
}

}  // namespace gischt
