// SPDX-License-Identifier: Apache-2.0
#include "scene/bare.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "image/color.h"
#include "optics/medium.h"
#include "scene/world.h"
#include "schema/toml.h"

namespace gischt {
namespace {

float largest_value(const Field& field) {
    float largest = 0;
    for (const float v : field.component[0].values()) largest = std::max(largest, v);
    return largest;
}

// The field that stands for the density: the one of that name, else the first fog volume of
// scalars.
std::string find_density(const Frame& frame, const std::string& file) {
    auto usable = [](const Field& f) {
        return !f.is_vector() && f.map().size() > 0 && largest_value(f) > 0;
    };
    if (const Field* f = frame.find("density"); f && usable(*f)) return "density";
    for (const auto& [name, field] : frame.fields) {
        if (usable(field) && field.kind != FieldClass::LevelSet && name != "temperature" &&
            name != "flame")
            return name;
    }
    std::string there;
    for (const auto& [name, field] : frame.fields) there += (there.empty() ? "" : ", ") + name;
    throw Error(ErrorKind::Input, file, "has no field that could be a density",
                there.empty() ? "the file holds no values"
                              : "the fields are: " + there + "; a scene file can name one");
}

bool is_burning(const Frame& frame) {
    const Field* flame = frame.find("flame");
    return flame && flame->map().size() > 0 && largest_value(*flame) > 0.01f;
}

// How the values of a file become fire: the field that glows, and its values at the cold and the
// hot end of a flame's colours.
struct Burning {
    std::string field;
    double cold = 0, hot = 1;
    bool is_true = false;  // kelvin of something that hot: nothing is to be mapped
};

Burning find_burning(const Frame& frame, const std::string& density) {
    if (is_burning(frame)) {
        return {"flame", 0, static_cast<double>(largest_value(*frame.find("flame")))};
    }
    const Field* heat = frame.find("temperature");
    if (heat && !heat->is_vector() && heat->map().size() > 0 && largest_value(*heat) > 0) {
        const auto hot = static_cast<double>(largest_value(*heat));
        const auto unit = frame.metadata.find("temperature_unit");
        const bool is_relative = unit != frame.metadata.end() && unit->second == "relative";
        if (is_relative) return {"temperature", 0, hot};
        constexpr double least_glow = 900;  // K: a dull red
        if (hot > least_glow) return {"temperature", 0, 1, true};
        if (hot > ambient_temperature) return {"temperature", ambient_temperature, hot};
    }
    return {density, 0, static_cast<double>(largest_value(*frame.find(density)))};
}

// The keys of a medium that burns so: a flame's soot is black at 800 K and yellow at 1900 K. Air
// that is warm at best counts from 500 K, where nothing glows.
std::vector<std::string> fire_keys(const Burning& b) {
    if (b.is_true) return {"medium.emission=blackbody"};
    const double coldest = b.cold > 0 ? 500 : 800, hottest = 1900;
    const double per_value = (hottest - coldest) / (b.hot - b.cold);
    const double zero = coldest - per_value * b.cold;
    return {fmt::format("medium.emission_field='{}'", b.field),
            fmt::format("medium.temperature_range=[{},{}]", zero, zero + per_value)};
}

// What the file says, as gischt's and Blender's do, else y: the habit of most other programs.
std::string up_of(const Frame& frame) {
    const auto up = frame.metadata.find("up");
    return up != frame.metadata.end() && up->second == "z" ? "z" : "y";
}

// 0 of an empty list.
double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto rank = static_cast<std::ptrdiff_t>(static_cast<double>(values.size() - 1) * share);
    std::ranges::nth_element(values, values.begin() + rank);
    return values[static_cast<std::size_t>(rank)];
}

// 90th percentile over the view of the optical depth that an extinction of 1/m has, of the rays
// that meet anything.
double optical_depth_percentile(const View& view) {
    std::vector<double> depths;
    constexpr int columns = 96;
    const int rows = std::max(1, columns * view.height() / view.width());
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const Ray ray = view.camera.ray((x + 0.5) * view.width() / columns,
                                            (y + 0.5) * view.height() / rows);
            double depth = 0;
            SegmentWalk walk = view.media[0]->segments(ray);
            for (MediumSegment s; walk.next(s);) depth += s.mean * (s.t1 - s.t0);
            if (depth > 0) depths.push_back(depth);
        }
    }
    return percentile(std::move(depths), 0.9);
}

// The stops by which the brightest of what glows becomes a light tone that has colour left.
double choose_exposure(const Scene& scene, const World& world, const View& view, Job& job) {
    RenderSettings settings;
    settings.samples_per_pixel = 1;
    settings.preview = true;
    View small = view;
    const int height = std::max(1, 128 * view.height() / view.width());
    small.camera = Camera(world.camera(view), view.time, 128, height, scene.up_vector());
    const Image image =
        make_method("march", scene.render.methods)->render(small, settings, job).image;
    const auto [r, g, b] = image.color();
    const auto alpha = image.channel("A");
    // The mean of the luminance, each pixel weighed by its own: that of the parts that shine.
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
        if (alpha[i] <= 0.02f) continue;
        const auto y = static_cast<double>(luminance(Vec3f(r[i], g[i], b[i])));
        sum += y;
        squares += y * y;
    }
    constexpr double wanted = 0.9;  // of the filmic curve's 16: light, with colour left
    return sum > 0 ? std::clamp(std::log2(wanted * sum / squares), -20.0, 20.0) : 0;
}

// By day for what scatters, at dusk for what glows.
std::string lights_for(const std::string& preset) {
    if (preset == "fire") {
        return R"(
[[light]]
name = "moon"
type = "sun"
irradiance = 1.2
color = [0.8, 0.95, 1.3]
[[light]]
name = "dusk"
type = "constant"
radiance = 0.03
color = [0.8, 1.0, 1.5]
)";
    }
    return R"(
[[light]]
name = "daylight"
type = "sky"
azimuth_degrees = -40
elevation_degrees = 42
strength = 0.011
)";
}

// The dusk is as bright as the picture's exposure makes visible, whatever glows in it.
void scale_light(Value& light, double factor) {
    for (const char* key : {"irradiance", "radiance", "strength"}) {
        if (const Value* strength = light.find(key))
            light.set(key, Value(strength->number() * factor));
    }
}

}  // namespace

LoadedScene load_bare(const BareRequest& request, Job& job) {
    FileParams params;
    params.file = request.file;
    const auto frame = std::make_shared<const Frame>(read_file_frame(params, request.frame, job));
    const std::string density = find_density(*frame, request.file);
    const std::string preset = !request.preset.empty() ? request.preset
                               : is_burning(*frame)    ? "fire"
                                                       : "cloud";
    const std::string up = up_of(*frame);
    std::string text =
        fmt::format("up = \"{}\"\nframes = [{}, {}]\n[fluid]\nname = \"volume\"\ntype = \"file\"\n",
                    up, request.frame, request.frame);
    text += "[fluid.medium]\nextinction = 1\n" +
            (density == "density" ? "" : "density_field = \"" + density + "\"\n");
    text += lights_for(preset);
    Value tree = parse_toml(text, request.file);
    tree.find("fluid")->set("file", Value(std::filesystem::absolute(request.file).string()));
    const std::string name = std::filesystem::path(request.file).stem().string();

    std::vector<std::string> overrides;
    if (preset == "fire") overrides = fire_keys(find_burning(*frame, density));
    // An extinction of 1/m is the yardstick for the one that suits the size of things.
    const LoadedScene yardstick = load_scene_tree(name, tree, preset, overrides);
    const View view = World(yardstick.scene, job).view({frame}, request.frame, job);
    const double depth = optical_depth_percentile(view);
    if (!(depth > 0))
        throw Error(ErrorKind::Input, request.file,
                    "there is nothing to see: the density is zero everywhere");
    // Soot hides its own flames, and so gives them a shape.
    const double extinction = (preset == "fire" ? 12 : 8) / depth;
    tree.find("fluid")->find("medium")->set("extinction", Value(extinction));

    overrides.insert(overrides.end(), request.overrides.begin(), request.overrides.end());
    LoadedScene loaded = load_scene_tree(name, tree, preset, overrides);
    if (!request.exposure_given && view.media[0]->is_emissive()) {
        World world(loaded.scene, job);
        const double exposure =
            choose_exposure(loaded.scene, world, world.view({frame}, request.frame, job), job);
        tree.set("film", Value()).set("exposure", Value(exposure));
        for (Value& light : tree.find("light")->array()) scale_light(light, std::exp2(-exposure));
        loaded = load_scene_tree(name, tree, preset, overrides);
    }
    const Vec3d size = view.media[0]->bounds().size();
    job.info(fmt::format(
        "assumed: {} up, {:.4g} x {:.4g} x {:.4g} m, field '{}', extinction {:.4g}/m at density 1, "
        "look '{}', "
        "exposure {:.2f}; each can be set",
        up, size.x, size.y, size.z, density, extinction, preset, loaded.scene.film.exposure));
    return loaded;
}

}  // namespace gischt
