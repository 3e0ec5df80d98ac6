// SPDX-License-Identifier: Apache-2.0
#include "optics/medium_pack.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "grid/resample.h"

namespace gischt {
namespace {

const Field& find_field(const Frame& frame, const std::string& name) {
    if (const Field* field = frame.find(name)) return *field;
    std::vector<std::string> names;
    for (const auto& [key, value] : frame.fields) names.push_back(key);
    throw Error(ErrorKind::Input, "medium", fmt::format("the frame has no field '{}'", name),
                names.empty() ? "it has no fields at all"
                              : fmt::format("fields: {}", fmt::join(names, ", ")));
}

const Field& find_scalar(const Frame& frame, const std::string& name) {
    const Field& field = find_field(frame, name);
    if (field.is_vector()) {
        throw Error(ErrorKind::Input, "medium", fmt::format("field '{}' is a vector", name),
                    "a medium needs a scalar");
    }
    return field;
}

void warn_of(std::int64_t count, const std::string& name, float background, Job& job) {
    if (count == 0) return;
    job.warn(fmt::format("field '{}': {} values that are not finite count as {:g}", name, count,
                         background));
}

// One component of a colour, on the lattice of the density.
struct ColorChannel {
    const Field* field;
    int axis;
    std::string name;
};

ColorChannel find_channel(const Frame& frame, const std::string& name, int axis) {
    const Field* field = frame.find(name);
    if (field && field->is_vector()) return {field, axis, name};
    if (field) {
        throw Error(ErrorKind::Input, "medium", fmt::format("field '{}' is a scalar", name),
                    "a colour is a vector, or three scalars with _r, _g, _b at the end");
    }
    const std::string channel = name + (axis == 0 ? "_r" : axis == 1 ? "_g" : "_b");
    return {&find_scalar(frame, channel), 0, channel};
}

Field times_color(const Field& density, const ColorChannel& channel, Job& job) {
    const bool is_aligned = channel.field->to_world == density.to_world;
    const Field moved =
        is_aligned ? Field{} : resample(*channel.field, channel.axis, density.to_world, job);
    const Field& color = is_aligned ? *channel.field : moved;
    const auto axis = static_cast<std::size_t>(is_aligned ? channel.axis : 0);
    const float outside = color.background[axis];

    Field out = density;
    const TileMap& map = out.map();
    std::atomic<std::int64_t> infinite{0}, bright{0};
    parallel_for(map.size(), 4, [&](int t) {
        job.check();
        float* values = out.component[0].tile(t);
        for (int i = 0; i < tile_values; ++i) {
            if (!(values[i] > 0)) continue;
            float c = color.component[axis].get(map.first_cell(t) + map.shape().cell(i), outside);
            if (!std::isfinite(c)) ++infinite, c = 0;
            if (c > 1.0001f) ++bright;
            values[i] *= std::clamp(c, 0.0f, 1.0f);
        }
    });
    warn_of(infinite, channel.name, 0, job);
    if (bright > 0) {
        job.warn(
            fmt::format("field '{}': {} colours above 1 count as 1", channel.name, bright.load()));
    }
    return out;
}

}  // namespace

BrickVolume pack_scalar(const Frame& frame, const std::string& name, const BrickOptions& options,
                        const Transform* lattice, Job& job) {
    const Field& field = find_scalar(frame, name);
    const BrickVolume volume = !lattice || field.to_world == *lattice
                                   ? BrickVolume(field, options, job)
                                   : BrickVolume(resample(field, 0, *lattice, job), options, job);
    warn_of(volume.non_finite(), name, volume.background(), job);
    return volume;
}

std::vector<BrickVolume> pack_dyed_density(const Frame& frame, const std::string& density,
                                           const std::string& name, const BrickVolume& like,
                                           Job& job) {
    std::vector<BrickVolume> out;
    for (int axis = 0; axis < 3; ++axis) {
        const ColorChannel channel = find_channel(frame, name, axis);
        out.emplace_back(times_color(find_scalar(frame, density), channel, job),
                         BrickOptions{.non_negative = true, .like = &like}, job);
    }
    return out;
}

}  // namespace gischt
