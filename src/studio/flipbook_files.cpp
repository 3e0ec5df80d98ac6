// SPDX-License-Identifier: Apache-2.0
// The sheets of a flipbook as files, and their description.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/version.h"
#include "image/color.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/png.h"
#include "studio/flipbook.h"
#include "studio/flipbook_codes.h"

namespace gischt {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

// A picture of one to three channels in R, G, B.
Image as_rgb(const Image& sheet, std::initializer_list<std::string_view> channels) {
    Image out = Image::rgb(sheet.width, sheet.height);
    std::size_t c = 0;
    for (const std::string_view name : channels) {
        const auto values = sheet.channel(name);
        std::copy(values.begin(), values.end(), out.color()[c++].begin());
    }
    return out;
}

float largest_of(std::span<const float> values) {
    float largest = 0;
    for (const float v : values) largest = std::max(largest, v);
    return largest;
}

Json json_of(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

// One flipbook on its way to the disk.
class SheetWriter {
  public:
    SheetWriter(const LoadedScene& scene, const FlipbookOrder& order, Flipbook book,
                RunStatistics& run, Job& job)
        : scene_(scene), order_(order), book_(std::move(book)), run_(run), job_(job) {
        for (const std::string& path : order.outputs) {
            const fs::path p(path);
            formats_[(p.parent_path() / p.stem()).string()].push_back(p.extension().string());
        }
        metadata_.set("version", version);
        metadata_.set("command", order.command);
        metadata_.set("scene", scene.name);
        metadata_.set("scene_hash", scene.hash);
        metadata_.set("seed", std::to_string(scene.scene.seed));
        metadata_.set("method", scene.scene.render.method);
        metadata_.set("alpha", alpha());
    }

    std::vector<std::string> write() {
        const PhaseTimer timer(job_, "write");
        if (book_.color) write_color();
        if (order_.layers.emission && book_.glow) write_emission();
        if (book_.motion) write_motion();
        if (book_.light) write_light();
        for (const auto& [stem, formats] : formats_) write_json(stem);
        return std::move(written_);
    }

  private:
    const char* alpha() const { return order_.premultiplied ? "premultiplied" : "straight"; }

    // Writes a layer in each format; the description names the files and what their values mean.
    void save(const std::string& layer, const Image& exr, const DisplayImage& png, Json meaning,
              const Json& of_png, const Json& of_exr) {
        for (const auto& [stem, formats] : formats_) {
            Json files = Json::object();
            for (const std::string& format : formats) {
                job_.check();
                const std::string path = stem + "_" + layer + format;
                if (format == ".png") {
                    write_png(path, png, metadata_);
                } else {
                    Image image = exr;
                    image.metadata = metadata_;
                    write_exr(path, image);
                }
                Json file = {{"file", fs::path(path).filename().string()}};
                file.update(format == ".png" ? of_png : of_exr);
                files[format.substr(1)] = file;
                written_.push_back(path);
                run_.images.push_back({path, scene_.scene.render.method, order_.frames.first,
                                       exr.width, exr.height, book_.statistics});
            }
            Json entry = meaning;
            entry.update(files);
            layers_[stem][layer] = entry;
        }
    }

    void write_color() {
        const FilmParams& film = scene_.scene.film;
        Image sheet = *book_.color;
        if (!order_.premultiplied) {
            if (book_.glow) {
                carry_glow(sheet, *book_.glow, exposure_factor(scene_.scene.film.exposure));
            }
            make_straight(sheet, book_.layout);
        }
        save("color", sheet, color_codes(sheet, film.tone, film.exposure, order_.premultiplied),
             {{"channels", "RGB: radiance of all light, with what glows; A: coverage"}},
             {{"encoding", "sRGB"},
              {"tone", tone_name(scene_.scene.film.tone)},
              {"exposure", scene_.scene.film.exposure}},
             {{"encoding", "linear"}, {"unit", "W/(m^2 sr)"}});
    }

    void write_emission() {
        const Image sheet = as_rgb(*book_.glow, {"R", "G", "B"});
        float scale = 0;
        for (const auto values : sheet.color()) scale = std::max(scale, largest_of(values));
        if (!(scale > 0)) scale = 1;
        save("emission", sheet, light_codes(sheet, scale),
             {{"channels", "RGB: radiance of what glows, to be added"}, {"unit", "W/(m^2 sr)"}},
             {{"encoding", "sRGB"}, {"scale", scale}}, {{"encoding", "linear"}, {"scale", 1}});
    }

    void write_motion() {
        Image sheet = std::move(*book_.motion);
        book_.motion.reset();
        make_straight(sheet, book_.layout);
        if (order_.layers.depth) write_depth(sheet);
        if (!order_.layers.motion) return;
        float largest = 0;
        for (const char* name : {"motion.X", "motion.Y"}) {
            for (const float v : sheet.channel(name)) largest = std::max(largest, std::abs(v));
        }
        // Rest is a code, 128, so that what does not move does not creep.
        constexpr float zero = 128.0f / 255, reach = 127.0f / 255;
        const float scale = largest > 0 ? largest / reach : 1;
        const Image exr = as_rgb(sheet, {"motion.X", "motion.Y"});
        Image coded = exr;
        for (const char* name : {"R", "G"}) {
            for (float& v : coded.channel(name)) v = zero + v / scale;
        }
        save("motion", exr, data_codes(coded, {"R", "G", "B"}),
             {{"channels", "R: to the right, G: down; B: nothing"},
              {"meaning", "(value - zero) * scale"},
              {"unit", "pixels of the cell from one cell to the next"}},
             {{"encoding", "linear"}, {"zero", zero}, {"scale", scale}},
             {{"encoding", "linear"}, {"zero", 0}, {"scale", 1}});
    }

    void write_depth(const Image& traced) {
        const auto coverage = traced.channel("A"), depth = traced.channel("Z");
        float near = std::numeric_limits<float>::max(), far = std::numeric_limits<float>::lowest();
        for (std::size_t i = 0; i < depth.size(); ++i) {
            if (coverage[i] < least_coverage) continue;
            near = std::min(near, depth[i]);
            far = std::max(far, depth[i]);
        }
        if (!(near < far)) {
            if (near > far) near = 0;  // nothing anywhere
            far = near + 1;
        }
        Image exr(traced.width, traced.height, std::array<std::string_view, 1>{"Z"});
        Image coded(traced.width, traced.height, std::array<std::string_view, 1>{"Z"});
        for (std::size_t i = 0; i < depth.size(); ++i) {
            const bool is_there = coverage[i] >= least_coverage;
            exr.channel("Z")[i] = is_there ? depth[i] : std::numeric_limits<float>::infinity();
            coded.channel("Z")[i] = is_there ? (depth[i] - near) / (far - near) : 1;
        }
        save("depth", exr, data_codes(coded, {"Z", "Z", "Z"}),
             {{"channels", "distance from the camera along its axis, mean over the opacity"},
              {"unit", "m"}},
             {{"encoding", "linear"}, {"near", near}, {"far", far}, {"clear", 1}},
             {{"encoding", "linear"}, {"clear", "infinity"}});
    }

    // The glow as the light maps cover it.
    std::optional<Image> glow_on(Image& light) {
        if (!book_.glow) return std::nullopt;
        Image glow = *book_.glow;
        if (order_.premultiplied) return glow;
        carry_glow(light, glow, exposure_factor(scene_.scene.film.exposure));
        const auto coverage = std::as_const(light).channel("A");
        std::ranges::copy(coverage, glow.channel("A").begin());
        make_straight(glow, book_.layout);
        return glow;
    }

    void write_light() {
        Image sheet = std::move(*book_.light);
        book_.light.reset();
        const std::optional<Image> glow = glow_on(sheet);
        if (!order_.premultiplied) make_straight(sheet, book_.layout);
        const float peak = scale_sides(sheet);
        float glow_scale = 0;
        if (glow) {
            const auto [r, g, b] = glow->color();
            for (std::size_t i = 0; i < r.size(); ++i)
                glow_scale = std::max(glow_scale, luminance(Vec3f{r[i], g[i], b[i]}));
        }
        if (!(glow_scale > 0)) glow_scale = 1;
        const Json numbers = {{"encoding", "linear"}, {"scale", order_.light_scale}};
        const Json light = {
            {"normalization", "scale: an opaque white Lambertian wall that faces the light is 1"},
            {"peak", peak}};
        Json a = {{"R", "right"}, {"G", "top"}, {"B", "back"}, {"A", "transparency"}};
        Json b = {{"R", "left"}, {"G", "bottom"}, {"B", "front"}, {"A", "emissive"}};
        a.update(light);
        b.update(light);
        b["emissive_scale"] = glow ? glow_scale : 0;
        b["emissive_unit"] = "W/(m^2 sr), luminance";
        const auto rgba = {std::string_view("R"), std::string_view("G"), std::string_view("B"),
                           std::string_view("A")};
        Image map = pack_light_a(sheet);
        save("light_a", map, data_codes(map, rgba), a, numbers, numbers);
        map = pack_light_b(sheet, glow ? &*glow : nullptr, glow_scale);
        save("light_b", map, data_codes(map, rgba), b, numbers, numbers);
    }

    // Divides the six sides by the scale; the largest value of a texel that is seen.
    float scale_sides(Image& sheet) const {
        const auto coverage = std::as_const(sheet).channel("A");
        float peak = 0;
        std::size_t over = 0, seen = 0;
        for (const char* side : light_sides) {
            const auto values = sheet.channel(side);
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i] /= static_cast<float>(order_.light_scale);
                if (coverage[i] < least_coverage) continue;
                peak = std::max(peak, values[i]);
                over += values[i] > 1;
                ++seen;
            }
        }
        const bool is_cut = std::ranges::any_of(order_.outputs, [](const std::string& path) {
            return fs::path(path).extension() == ".png";
        });
        if (over > 0 && is_cut) {
            job_.warn(
                fmt::format("light maps reach {:.3g}: PNG cuts {:.2g} % of their values at 1; "
                            "--light-scale {:.3g} keeps them",
                            peak, 100.0 * static_cast<double>(over) / static_cast<double>(seen),
                            static_cast<double>(peak) * order_.light_scale));
        }
        return peak;
    }

    Json describe_camera() const {
        const CameraParams& p = book_.camera;
        const Camera camera(p, 0, book_.layout.cell_width, book_.layout.cell_height,
                            scene_.scene.up_vector());
        const bool is_flat = p.projection == Projection::Orthographic;
        Json out = {{"projection", is_flat ? "orthographic" : "perspective"},
                    {"position", json_of(camera.position())},
                    {"right", json_of(camera.right())},
                    {"up", json_of(camera.up())},
                    {"forward", json_of(camera.forward())}};
        if (is_flat) {
            const double height = p.height.at(0);
            out["width"] = height * book_.layout.cell_width / book_.layout.cell_height;
            out["height"] = height;
        } else {
            out["fov_degrees"] = p.fov_degrees.at(0);
        }
        return out;
    }

    void write_json(const std::string& stem) {
        const FrameRange& f = order_.frames;
        const SheetLayout& l = book_.layout;
        const Json out = {{"generator", std::string("gischt ") + version},
                          {"command", order_.command},
                          {"scene", scene_.name},
                          {"scene_hash", scene_.hash},
                          {"method", scene_.scene.render.method},
                          {"sheet", {{"width", l.width()}, {"height", l.height()}}},
                          {"grid",
                           {{"columns", l.columns},
                            {"rows", l.rows},
                            {"order", "row by row, the first frame top left"}}},
                          {"cell", {{"width", l.cell_width}, {"height", l.cell_height}}},
                          {"cells", book_.cells},
                          {"cells_per_second", scene_.scene.fps / f.step},
                          {"frames",
                           {{"first", f.first},
                            {"last", f[f.count() - 1]},
                            {"step", f.step},
                            {"count", f.count()}}},
                          {"loop", order_.loop > 0},
                          {"cross_fade_cells", order_.loop},
                          {"alpha", alpha()},
                          {"camera", describe_camera()},
                          {"layers", layers_[stem]}};
        AtomicFile file(stem + ".json");
        file.write(std::span<const char>(out.dump(2) + "\n"));
        file.commit();
        written_.push_back(stem + ".json");
    }

    const LoadedScene& scene_;
    const FlipbookOrder& order_;
    Flipbook book_;
    RunStatistics& run_;
    Job& job_;
    std::map<std::string, std::vector<std::string>> formats_;  // by stem
    std::map<std::string, Json> layers_;                       // by stem
    Metadata metadata_;
    std::vector<std::string> written_;
};

}  // namespace

std::vector<std::string> write_flipbook(const LoadedScene& scene, const FlipbookOrder& order,
                                        Flipbook flipbook, RunStatistics& run, Job& job) {
    return SheetWriter(scene, order, std::move(flipbook), run, job).write();
}

}  // namespace gischt
