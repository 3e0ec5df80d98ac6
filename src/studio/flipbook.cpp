// SPDX-License-Identifier: Apache-2.0
#include "studio/flipbook.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "image/color.h"
#include "optics/orientation.h"
#include "studio/flipbook_view.h"

namespace gischt {
namespace fs = std::filesystem;

FlipbookLayers flipbook_layers(const std::vector<std::string>& names) {
    static const std::vector<std::string> valid{"color", "emission", "depth", "motion", "light"};
    if (names.empty()) return {};
    FlipbookLayers layers{false, false, false, false, false};
    bool* const chosen[] = {&layers.color, &layers.emission, &layers.depth, &layers.motion,
                            &layers.light};
    for (const std::string& name : names) {
        const auto found = std::ranges::find(valid, name);
        if (found == valid.end()) {
            throw Error(ErrorKind::Usage, "--layers", fmt::format("there is no '{}'", name),
                        hint_for(name, valid));
        }
        *chosen[found - valid.begin()] = true;
    }
    return layers;
}

namespace {

// What goes into the sheets of an order, known before anything is computed.
struct SheetPlan {
    int frames = 0, cells = 0;
    SheetLayout layout;
    bool glows = false;
    int pictures = 0;  // that the method renders for each frame
};

SheetPlan plan(const LoadedScene& scene, const FlipbookOrder& order) {
    for (const std::string& path : order.outputs) {
        const fs::path extension = fs::path(path).extension();
        if (extension != ".png" && extension != ".exr") {
            throw Error(ErrorKind::Usage, path, "sprite sheets are .png or .exr",
                        "name the stem and one of them: -o smoke.png");
        }
    }
    if (scene.scene.render.method == "field") {
        throw Error(ErrorKind::Usage, "flipbook", "method 'field' shows colour maps, not light",
                    "take --method march or path");
    }
    if (!(order.light_scale > 0) || !std::isfinite(order.light_scale))
        throw Error(ErrorKind::Usage, "--light-scale", "must be positive",
                    "1 keeps a white wall at 1");

    SheetPlan p;
    p.frames = order.frames.count();
    check_loop(p.frames, order.loop);
    p.cells = p.frames - order.loop;
    if (order.grid) {
        p.layout = {order.grid->x, order.grid->y, order.cell.x, order.cell.y};
        check_sheet(p.layout, p.cells);
    } else {
        p.layout = square_sheet(p.cells, order.cell);
    }
    p.glows = has_glow(scene.scene);
    if (order.emission_asked && !p.glows) {
        throw Error(ErrorKind::Usage, "--layers", "nothing in the scene glows",
                    "leave out 'emission', or set medium.emission");
    }
    p.pictures = (order.layers.color ? 1 : 0) + (order.layers.light ? 6 : 0) + (p.glows ? 1 : 0);
    return p;
}

void announce(const SheetPlan& p, const FlipbookOrder& order, Job& job) {
    const int channels = (order.layers.color ? 4 : 0) + (p.glows ? 4 : 0) +
                         (order.layers.depth || order.layers.motion ? 4 : 0) +
                         (order.layers.light ? 7 : 0);
    // While files are written there is a second copy of two sheets.
    const double bytes = (channels + 12.0) * 4 * p.layout.width() * p.layout.height();
    job.info(
        fmt::format("{} cells of {} x {} pixels in a sheet of {} x {}, {:.0f} MB; {} pictures "
                    "for each of {} frames",
                    p.cells, p.layout.cell_width, p.layout.cell_height, p.layout.width(),
                    p.layout.height(), std::ceil(1e-6 * bytes), p.pictures, p.frames));
}

// The fluids' frames, over and over in rising order.
class FrameReader {
  public:
    FrameReader(const LoadedScene& scene, const FlipbookOrder& order, RunStatistics& run)
        : run_(run) {
        if (order.cache) cache_.emplace(*order.cache, scene, order.restart, order.keeps_scene);
        for (std::size_t i = 0; i < scene.scene.fluids.size(); ++i)
            fluids_.emplace_back(scene, i, cache_ ? &*cache_ : nullptr);
    }
    std::vector<std::shared_ptr<const Frame>> get(int frame, Job& job) {
        std::vector<std::shared_ptr<const Frame>> frames;
        for (FluidFrames& fluid : fluids_) frames.push_back(fluid.get(frame, run_, job));
        return frames;
    }
    void finish() {
        for (FluidFrames& fluid : fluids_) fluid.finish();
    }

  private:
    RunStatistics& run_;
    std::optional<Cache> cache_;
    std::vector<FluidFrames> fluids_;
};

// Looks at every frame and fits a camera to all of them; from the side of the scene's camera where
// it has one, else level from the front.
CameraParams fit_to_frames(const Scene& scene, const FlipbookOrder& order, FrameReader& reader,
                           Job& job) {
    const double start = scene.time_of(order.frames.first);
    Vec3d up = scene.up_vector(), forward = -horizon_direction(0, 0, up);
    if (scene.camera) {
        const Camera camera(camera_held_still(*scene.camera, start), start, 1, 1, up);
        up = camera.up();
        forward = camera.forward();
    }
    SpriteFit fit(forward, up);
    const Scene dark = [&] {
        Scene s = sprite_scene(scene, order.cell);
        s.lights.clear();
        s.camera = CameraParams{};  // of no account
        return s;
    }();
    World world(dark, job);
    for (int i = 0; i < order.frames.count(); ++i) {
        const JobPart part(job, static_cast<double>(i) / order.frames.count(),
                           (i + 1.0) / order.frames.count(),
                           fmt::format("frame {}", order.frames[i]));
        job.progress(0, "frame the fluids");
        fit.add(world.view(reader.get(order.frames[i], job), order.frames[i], job));
    }
    constexpr double margin = 0.03;
    return fit.camera(static_cast<double>(order.cell.x) / order.cell.y, margin);
}

RenderSettings settings_of(const Scene& scene, const FlipbookOrder& order) {
    RenderSettings s;
    s.samples_per_pixel = scene.render.spp;
    s.seed = static_cast<std::uint64_t>(scene.seed);
    s.depth = scene.render.depth;
    s.noise = order.noise;
    s.time_limit = order.time_limit;
    s.filter = scene.film.filter;
    s.filter_radius = scene.film.filter_radius;
    s.preview = order.preview;
    return s;
}

// Renders the pictures of a frame into the sheets.
class SheetPainter {
  public:
    SheetPainter(const Scene& sprite, const FlipbookOrder& order, const SheetPlan& p, Job& job)
        : sprite_(sprite),
          dark_(without_glow(sprite)),
          order_(order),
          plan_(p),
          job_(job),
          world_(sprite_, job),
          dark_world_(dark_, job) {
        const auto sheet = [&](std::span<const std::string_view> channels) {
            return Image(p.layout.width(), p.layout.height(), channels);
        };
        constexpr std::array<std::string_view, 4> rgba{"R", "G", "B", "A"};
        constexpr std::array<std::string_view, 4> traced{"A", "Z", "motion.X", "motion.Y"};
        book_.layout = p.layout;
        book_.cells = p.cells;
        book_.camera = *sprite.camera;
        if (order.layers.color) book_.color = sheet(rgba);
        if (p.glows) book_.glow = sheet(rgba);
        if (order.layers.depth || order.layers.motion) book_.motion = sheet(traced);
        if (order.layers.light) {
            std::vector<std::string_view> sides(std::begin(light_sides), std::end(light_sides));
            sides.push_back("A");
            book_.light = sheet(sides);
        }
    }

    void add(int index, const std::vector<std::shared_ptr<const Frame>>& frames) {
        const int number = order_.frames[index];
        share_ = cell_share(index, plan_.frames, order_.loop);
        picture_ = 0;
        const View view = world_.view(frames, number, job_);
        if (book_.color) put(*book_.color, render("colour", view), 1);
        if (book_.glow) put(*book_.glow, render("emission", unlit(view)), 1);
        if (book_.light) add_light(plan_.glows ? dark_world_.view(frames, number, job_) : view);
        if (book_.motion) put(*book_.motion, trace_motion(view, order_.frames.step, job_), 1);
    }

    Flipbook take() { return std::move(book_); }

  private:
    void put(Image& sheet, const Image& picture, float weight) const {
        add_cell(sheet, plan_.layout, share_.cell, picture, weight * share_.weight);
    }
    Image render(const char* what, const View& view) {
        const PhaseTimer timer(job_, "render");
        const JobPart part(job_, static_cast<double>(picture_) / plan_.pictures,
                           (picture_ + 1.0) / plan_.pictures, what);
        ++picture_;
        RenderResult result = make_method(sprite_.render.method, sprite_.render.methods)
                                  ->render(view, settings_of(sprite_, order_), job_);
        RenderStatistics& sum = book_.statistics;
        sum.samples_per_pixel = result.statistics.samples_per_pixel;
        sum.rays += result.statistics.rays;
        sum.lookups += result.statistics.lookups;
        sum.noise = std::max(sum.noise, result.statistics.noise);
        sum.wall_seconds += result.statistics.wall_seconds;
        return std::move(result.image);
    }
    // A white Lambertian wall that faces a light of 1 W/m^2 has the radiance 1/pi.
    void add_light(const View& view) {
        const std::array<Vec3d, 6> towards = light_directions(view.camera);
        for (std::size_t s = 0; s < 6; ++s) {
            const Image lit = render(light_sides[s], lit_from(view, towards[s]));
            Image part(lit.width, lit.height, std::array<std::string_view, 2>{light_sides[s], "A"});
            const auto [r, g, b] = lit.color();
            const auto value = part.channel(light_sides[s]);
            for (std::size_t i = 0; i < value.size(); ++i)
                value[i] = static_cast<float>(pi) * luminance(Vec3f{r[i], g[i], b[i]});
            // All six see the same coverage, but for noise.
            const auto from = lit.channel("A");
            const auto to = part.channel("A");
            std::ranges::transform(from, to.begin(), [](float a) { return a / 6; });
            put(*book_.light, part, 1);
        }
    }

    Scene sprite_, dark_;
    const FlipbookOrder& order_;
    const SheetPlan& plan_;
    Job& job_;
    World world_, dark_world_;
    Flipbook book_;
    CellShare share_;
    int picture_ = 0;
};

}  // namespace

Flipbook render_flipbook(const LoadedScene& scene, const FlipbookOrder& order, RunStatistics& run,
                         Job& job) {
    const SheetPlan p = plan(scene, order);
    announce(p, order, job);
    FrameReader reader(scene, order, run);
    const bool fits = order.fit || !scene.scene.camera;
    Scene sprite = sprite_scene(scene.scene, order.cell);
    if (!scene.scene.solids.empty() || sprite.media.size() < scene.scene.media.size())
        job.info("solids, fog and air are left out: sheets show the fluids alone");
    if (fits) {
        const JobPart part(job, 0, 0.3, "");
        sprite.camera = fit_to_frames(scene.scene, order, reader, job);
    } else {
        sprite.camera =
            camera_held_still(*scene.scene.camera, scene.scene.time_of(order.frames.first));
    }
    const JobPart rendering(job, fits ? 0.3 : 0, 1, "");
    SheetPainter painter(sprite, order, p, job);
    for (int i = 0; i < p.frames; ++i) {
        const JobPart part(job, static_cast<double>(i) / p.frames, (i + 1.0) / p.frames,
                           fmt::format("frame {}", order.frames[i]));
        painter.add(i, reader.get(order.frames[i], job));
    }
    reader.finish();
    return painter.take();
}

}  // namespace gischt
