// SPDX-License-Identifier: Apache-2.0
#include "fluid/procedural/procedural.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "fluid/procedural/envelope.h"
#include "math/keyframe_integral.h"

namespace gischt {
namespace {

// Octaves whose features span at least two cells: finer ones would alias.
TurbulenceShape resolved(const TurbulenceParams& p, double h) {
    int octaves = 1;
    double size = p.scale * min_component(p.stretch) / p.lacunarity;
    for (; octaves < p.octaves && size >= 2 * h; ++octaves) size /= p.lacunarity;
    return {p.kind, octaves, p.lacunarity, p.gain, static_cast<std::uint64_t>(p.seed)};
}

// Half the width of the level set, as OpenVDB has it by custom.
constexpr int band_cells = 3;

// What a cell holds.
struct Content {
    float density = 0, heat = 0;  // heat: share of the core's
    float surface = 0;            // m to the surface, negative inside, within the band
    Vec3f drift;                  // m/s of the shape
};

// The formula of ProceduralParams at one moment.
class Formula {
  public:
    Formula(const ProceduralParams& p, const MeshDistance* mesh, const Vec3d& up, double time,
            double h)
        : envelope_(p, mesh, up, time),
          noise_(resolved(p.noise, h)),
          origin_(p.position.at(time) + integral(p.velocity, time)),
          size_(p.noise.scale * p.noise.stretch),
          warp_(p.noise.warp.at(time) / p.noise.scale),
          moment_(integral(p.noise.evolution, time)),
          seed_(static_cast<std::uint64_t>(p.noise.seed)),
          edge_(p.edge.at(time)),
          core_(p.core.at(time)),
          displacement_(p.displacement.at(time)),
          density_(p.density.at(time)),
          softness_(p.softness.at(time)),
          band_(p.surface ? band_cells * h : 0),
          saturation_(std::max(p.temperature || p.flame ? std::max(edge_, core_) : edge_, band_)) {
        if (p.threshold) threshold_ = p.threshold->at(time);
        if (p.falloff) falloff_ = p.falloff->at(time);
    }

    std::vector<int> parts_near(const Vec3d& center, double radius) const {
        return envelope_.parts_near(center, radius, outwards(displacement_) + band_);
    }

    Content at(std::span<const int> parts, const Vec3d& x) const {
        const EnvelopeSample shape = envelope_.at(parts, x);
        const double throw_ = displacement_ * shape.hold;
        if (shape.depth + outwards(throw_) <= -band_) return {0, 0, static_cast<float>(band_), {}};

        const double n = noise(x, shape.depth, throw_);
        const double depth = shape.depth + throw_ * n;
        const double fill = threshold_ ? smoothstep((n - *threshold_) / softness_) : 1.0;
        const double rise = smoothstep(depth / edge_) * fill;
        const double falloff =
            falloff_ ? std::exp(-std::max(0.0, envelope_.height(x)) / *falloff_) : 1.0;
        return {static_cast<float>(density_ * rise * falloff),
                static_cast<float>(smoothstep(depth / core_) * fill),
                static_cast<float>(std::clamp(-depth, -band_, band_)), Vec3f(shape.drift)};
    }

  private:
    // Metres by which noise moves the surface outwards at most.
    double outwards(double displacement) const {
        return displacement * (displacement > 0 ? noise_.most() : noise_.least());
    }
    // As exact as it matters to what follows.
    double noise(const Vec3d& x, double depth, double throw_) const {
        // Between the first of these values and the last anything changes.
        double low = 1e30, high = -1e30;
        if (threshold_) {
            low = *threshold_;
            high = *threshold_ + softness_;
        }
        if (throw_ != 0) {
            const double a = (-band_ - depth) / throw_, b = (saturation_ - depth) / throw_;
            low = std::min({low, a, b});
            high = std::max({high, a, b});
        }
        if (low > high) return 0;
        Vec3d q = (x - origin_) / size_;
        if (warp_ != 0) q = warped(q, moment_, warp_, seed_);
        return noise_.value_within(q, moment_, low, high);
    }

    Envelope envelope_;
    Turbulence noise_;
    Vec3d origin_;
    Vec3d size_;  // m, of the largest features
    double warp_, moment_;
    std::uint64_t seed_;
    double edge_, core_, displacement_, density_, softness_, band_, saturation_;
    std::optional<double> threshold_, falloff_;
};

// The tiles that remain when those without any density are dropped, with one field's values.
TileField<float> packed(const TileField<float>& all, const std::vector<int>& kept,
                        const TileMap::Ptr& map) {
    TileField<float> out(map);
    parallel_for(map->size(), 16, [&](int t) {
        const float* from = all.tile(kept[static_cast<std::size_t>(t)]);
        std::copy(from, from + tile_values, out.tile(t));
    });
    return out;
}

// One value after the other on the tiles that may hold any, then on those that do.
struct Fields {
    TileField<float> density, heat, surface;
    std::vector<TileField<float>> drift;
    std::vector<char> is_used;
    float band;  // m

    Fields(const TileMap::Ptr& map, const ProceduralParams& params, double h)
        : density(map),
          is_used(static_cast<std::size_t>(map->size())),
          band(static_cast<float>(band_cells * h)) {
        const bool is_hot = params.temperature || params.flame, is_drifting = is_moving(params);
        if (is_hot) heat = TileField<float>(map);
        if (params.surface) {
            surface = TileField<float>(map);
            std::ranges::fill(surface.values(), band);
        }
        if (is_drifting) drift.assign(3, TileField<float>(map));
    }

    void set(int tile, int i, const Content& c) {
        density.tile(tile)[i] = c.density;
        if (!heat.is_empty()) heat.tile(tile)[i] = c.heat;
        for (std::size_t a = 0; a < drift.size(); ++a)
            drift[a].tile(tile)[i] = c.drift[static_cast<int>(a)];
        if (!surface.is_empty()) surface.tile(tile)[i] = c.surface;
        if (c.density > 0 || (!surface.is_empty() && c.surface < band))
            is_used[static_cast<std::size_t>(tile)] = 1;
    }

    void pack() {
        std::vector<int> kept;
        std::vector<Vec3i> tiles;
        for (int t = 0; t < density.map().size(); ++t) {
            if (!is_used[static_cast<std::size_t>(t)]) continue;
            kept.push_back(t);
            tiles.push_back(density.map().coord(t));
        }
        // Tiles are in Morton order and stay so.
        const auto map = TileMap::sparse(std::move(tiles), density.map().bounds());
        density = packed(density, kept, map);
        if (!heat.is_empty()) heat = packed(heat, kept, map);
        if (!surface.is_empty()) surface = packed(surface, kept, map);
        for (auto& component : drift) component = packed(component, kept, map);
    }
};

// a + b heat as a field of its own.
Field heated(const TileField<float>& heat, const Transform& to_world, double a, double b) {
    Field field;
    field.component.push_back(heat);
    field.to_world = to_world;
    field.background[0] = static_cast<float>(a);
    for (float& v : field.component[0].values()) v = static_cast<float>(a + b * double(v));
    return field;
}

// Tiles of the box in which there may be something.
std::vector<Vec3i> tiles_near(const Formula& formula, const Vec3i& cells, const Vec3d& origin,
                              double h) {
    const TileMap::Ptr box = TileMap::box(cells);
    std::vector<char> is_near(static_cast<std::size_t>(box->size()));
    parallel_for(box->size(), 16, [&](int t) {
        const Vec3d center = origin + (Vec3d(box->first_cell(t)) + Vec3d(4)) * h;
        is_near[static_cast<std::size_t>(t)] =
            !formula.parts_near(center, 4 * std::sqrt(3.0) * h).empty();
    });
    std::vector<Vec3i> tiles;
    for (int t = 0; t < box->size(); ++t) {
        if (is_near[static_cast<std::size_t>(t)]) tiles.push_back(box->coord(t));
    }
    return tiles;
}

void require(bool holds, const char* key) {
    if (!holds)
        throw Error(ErrorKind::Usage, "procedural",
                    std::string("'") + key + "' must be positive at any time");
}

}  // namespace

bool is_moving(const ProceduralParams& params) {
    const auto moves = [](const Keyed<Vec3d>& position) { return !position.is_constant(); };
    bool is =
        moves(params.position) || moves(params.velocity) || length(params.velocity.v.front()) > 0;
    if (params.shape == ProceduralShape::Blobs) {
        for (const BlobParams& b : params.blobs) is = is || moves(b.position);
    }
    return is;
}

MeshDistance filled_mesh(const MeshShapeParams& params, Mesh mesh) {
    Transform place = Transform::scale_translate(params.scale, {});
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d e;
        e[axis] = 1;
        place = Transform::rotation(e, radians(params.rotate_degrees[axis])) * place;
    }
    try {
        return MeshDistance(transformed(std::move(mesh), place));
    } catch (const Error& e) {
        throw Error(e.kind(), params.file, e.fact(), e.hint());
    }
}

Frame make_procedural(const ProceduralParams& params, const Vec3d& up, double time, Job& job,
                      const MeshDistance* mesh) {
    const Vec3d size = params.max - params.min;
    require(min_component(size) > 0, "max - min");
    require(params.edge.at(time) > 0, "edge");
    require(params.core.at(time) > 0, "core");
    require(params.softness.at(time) > 0, "softness");
    require(!params.falloff || params.falloff->at(time) > 0, "falloff");
    if (params.shape == ProceduralShape::Mesh && !mesh)
        throw Error(ErrorKind::Usage, "procedural", "the shape 'mesh' needs a mesh");
    const double h = max_component(size) / params.resolution;
    const Vec3i cells = max(floor(size / h + Vec3d(0.5)), Vec3i(2));
    const Formula formula(params, mesh, up, time, h);

    // Evaluate the formula where the shape is near, ...
    const auto map = TileMap::sparse(tiles_near(formula, cells, params.min, h), {{}, cells});
    Fields fields(map, params, h);
    const Vec3f wind(params.velocity.at(time));
    parallel_for(map->size(), 1, [&](int t) {
        if (job.is_cancelled()) return;
        const Vec3i first = map->first_cell(t);
        const Vec3d center = params.min + (Vec3d(first) + Vec3d(4)) * h;
        const auto parts = formula.parts_near(center, 4 * std::sqrt(3.0) * h);
        for (int i = 0; i < tile_values; ++i) {
            const Vec3i c = first + map->shape().cell(i);
            if (!map->bounds().contains(c)) continue;
            Content content = formula.at(parts, params.min + (Vec3d(c) + Vec3d(0.5)) * h);
            content.drift += wind;
            fields.set(t, i, content);
        }
    });
    job.check();

    // ... and keep the tiles in which something is.
    fields.pack();
    Frame frame;
    frame.time = time;
    const Transform to_world = Transform::scale_translate(h, params.min);
    if (params.temperature) {
        const double ambient = params.ambient_temperature;
        frame.fields["temperature"] =
            heated(fields.heat, to_world, ambient, params.temperature->at(time) - ambient);
    }
    if (params.flame)
        frame.fields["flame"] = heated(fields.heat, to_world, 0, params.flame->at(time));
    if (params.surface) {
        Field& surface = frame.fields["surface"];
        surface.component.push_back(std::move(fields.surface));
        surface.background[0] = fields.band;
        surface.kind = FieldClass::LevelSet;
        surface.to_world = to_world;
    }
    if (!fields.drift.empty()) {
        Field& velocity = frame.fields["velocity"];
        velocity.component = std::move(fields.drift);
        velocity.to_world = to_world;
    }
    Field& density = frame.fields["density"];
    density.component.push_back(std::move(fields.density));
    density.to_world = to_world;
    return frame;
}

}  // namespace gischt
