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
    std::vector<double> seen;
    for (std::size_t i = 0; i < r.size(); ++i) {
        if (alpha[i] > 0.02f) seen.push_back(luminance(Vec3f(r[i], g[i], b[i])));
    }
    const double bright = percentile(std::move(seen), 0.97);
    constexpr double wanted = 1.6;  // of the filmic curve's 16
    return bright > 0 ? std::clamp(std::log2(wanted / bright), -20.0, 20.0) : 0;
}

// By day for what scatters, at dusk for what glows.
std::string lights_for(const std::string& preset) {
    if (preset == "fire") {
        return R"(
[[light]]
name = "moon"
type = "sun"
irradiance = 0.5
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

    // An extinction of 1/m is the yardstick for the one that suits the size of things.
    const LoadedScene yardstick = load_scene_tree(name, tree, preset, {});
    const View view = World(yardstick.scene, job).view({frame}, request.frame, job);
    const double depth = optical_depth_percentile(view);
    if (!(depth > 0))
        throw Error(ErrorKind::Input, request.file,
                    "there is nothing to see: the density is zero everywhere");
    tree.find("fluid")->find("medium")->set("extinction", Value(8 / depth));

    LoadedScene loaded = load_scene_tree(name, tree, preset, request.overrides);
    if (!request.exposure_given && view.media[0]->is_emissive()) {
        World world(loaded.scene, job);
        const double exposure =
            choose_exposure(loaded.scene, world, world.view({frame}, request.frame, job), job);
        tree.set("film", Value()).set("exposure", Value(exposure));
        for (Value& light : tree.find("light")->array()) scale_light(light, std::exp2(-exposure));
        loaded = load_scene_tree(name, tree, preset, request.overrides);
    }
    const Vec3d size = view.media[0]->bounds().size();
    job.info(fmt::format(
        "assumed: {} up, {:.4g} x {:.4g} x {:.4g} m, field '{}', extinction {:.4g}/m at density 1, "
        "look '{}', "
        "exposure {:.2f}; each can be set",
        up, size.x, size.y, size.z, density, 8 / depth, preset, loaded.scene.film.exposure));
    return loaded;
}

}  // namespace gischt
