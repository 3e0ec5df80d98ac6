// SPDX-License-Identifier: Apache-2.0
#include "studio/production.h"

#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "base/units.h"
#include "base/version.h"
#include "image/denoise.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "io/mp4.h"
#include "studio/film_keeper.h"

namespace gischt {
namespace fs = std::filesystem;
namespace {

std::vector<FluidFrames> open_fluids(const LoadedScene& scene, const Cache* cache,
                                     const Order& order) {
    std::vector<FluidFrames> fluids;
    for (std::size_t i = 0; i < scene.scene.fluids.size(); ++i) {
        fluids.emplace_back(scene, i, cache);
        if (order.probes) {
            fluids.back().probe(*order.probes, order.restart);
        } else if (order.cache) {
            fluids.back().probe(*order.cache / "probes", order.restart);
        }
    }
    return fluids;
}

std::optional<Cache> open_cache(const LoadedScene& scene, const Order& order) {
    if (!order.cache) return std::nullopt;
    return Cache(*order.cache, scene, order.restart, order.keeps_scene);
}

bool is_movie(const std::string& path) {
    return fs::path(path).extension() == ".mp4";
}

// Where pictures and movies of an order go.
class Outputs {
  public:
    Outputs(const LoadedScene& scene, const Order& order, bool numbered)
        : scene_(scene), order_(order), numbered_(numbered) {
        for (const std::string& path : order.outputs) {
            if (!is_movie(path) && !is_image_file(path) && !is_film_file(path)) {
                throw Error(ErrorKind::Usage, path, "has no extension that tells a format",
                            hint_for(fs::path(path).extension().string(), formats()));
            }
        }
        // Who cannot write what comes of the work learns it before the work.
        const int first = order.turntable > 0 ? 1 : order.frames.first;
        for (const std::string& path : order.outputs)
            const AtomicFile probe(is_movie(path) ? path : path_of(path, first));
    }

    WriteOptions options(const Image& image) const {
        WriteOptions o;
        o.display = display_of(scene_.scene, image);
        return o;
    }
    std::string path_of(const std::string& pattern, int frame) const {
        return numbered_ ? frame_path(pattern, frame).string() : pattern;
    }
    // The `.film` files of a picture.
    std::vector<std::string> films(int frame) const {
        std::vector<std::string> paths;
        for (const std::string& pattern : order_.outputs) {
            if (is_film_file(pattern)) paths.push_back(path_of(pattern, frame));
        }
        return paths;
    }
    // A picture that is still growing: shown in the .png files only.
    void show_partial(const Image& image, int frame) const {
        for (const std::string& pattern : order_.outputs) {
            if (fs::path(pattern).extension() == ".png")
                write_image(path_of(pattern, frame), image, options(image));
        }
    }
    void write(const RenderResult& result, int frame, RunStatistics& run,
               std::vector<std::string>& written) {
        for (const std::string& pattern : order_.outputs) {
            std::string path = pattern;
            if (is_movie(pattern)) {
                movie(pattern, result.image).add(result.image);
            } else {
                path = path_of(pattern, frame);
                if (!is_film_file(path)) write_image(path, result.image, options(result.image));
                written.push_back(path);
            }
            run.images.push_back({path, result.image.metadata.get("method"), frame,
                                  result.image.width, result.image.height, result.statistics});
        }
    }
    void finish(std::vector<std::string>& written) {
        for (auto& [path, writer] : movies_) {
            writer->finish();
            written.push_back(path);
        }
    }

  private:
    static std::vector<std::string> formats() {
        std::vector<std::string> list = image_extensions();
        list.push_back(".film");
        list.push_back(".mp4");
        return list;
    }
    Mp4Writer& movie(const std::string& path, const Image& image) {
        for (auto& [name, writer] : movies_) {
            if (name == path) return *writer;
        }
        Mp4Options o;
        o.frames_per_second = scene_.scene.fps;
        o.display = options(image).display;
        o.metadata = image.metadata;
        movies_.emplace_back(path, std::make_unique<Mp4Writer>(path, image.width, image.height, o));
        return *movies_.back().second;
    }

    const LoadedScene& scene_;
    const Order& order_;
    bool numbered_;
    std::vector<std::pair<std::string, std::unique_ptr<Mp4Writer>>> movies_;
};

// Turns the camera around the up axis through its target.
void turn_camera(CameraParams& camera, const Vec3d& up, double angle) {
    const Transform turn = Transform::rotation(up, angle);
    const Vec3d target = camera.target.at(0);
    camera.position = target + turn.vector(camera.position.at(0) - target);
}

RenderSettings settings_of(const Scene& scene, const Order& order) {
    RenderSettings s;
    s.samples_per_pixel = scene.render.spp;
    s.first_sample = order.first_sample;
    s.seed = static_cast<std::uint64_t>(scene.seed);
    s.depth = scene.render.depth;
    s.noise = order.noise;
    s.time_limit = order.time_limit;
    s.filter = scene.film.filter;
    s.filter_radius = scene.film.filter_radius;
    s.preview = order.preview;
    s.adaptive = order.adaptive;
    s.checkpoint_interval = 1;  // s; less often where saving takes more than a twentieth of it
    s.aovs = scene.film.aovs;
    if (scene.film.denoise) s.aovs.emplace_back("variance");
    return s;
}

// What the picture of a frame, or of a view of a turntable, says of itself.
Metadata metadata_of(const LoadedScene& scene, const Order& order, int frame, int view) {
    Metadata m;
    m.set("version", version);
    m.set("command", order.command);
    m.set("scene", scene.name);
    m.set("scene_hash", scene.hash);
    m.set("seed", std::to_string(scene.scene.seed));
    m.set("frame", std::to_string(frame));
    if (order.turntable > 0) m.set("view", fmt::format("{}/{}", view, order.turntable));
    m.set("method", scene.scene.render.method);
    return m;
}

// Beside that, what its film keeps: to be recognized, and developed as here.
Metadata film_metadata(const LoadedScene& scene, const Order& order, Metadata m) {
    m.set("picture_hash", scene.picture_hash);
    m.set("preview", order.preview ? "true" : "false");
    m.set("tone", tone_name(scene.scene.film.tone));
    m.set("exposure", fmt::format("{}", scene.scene.film.exposure));
    if (scene.scene.film.denoise) m.set("denoise", "true");
    return m;
}

RenderResult render_with(const LoadedScene& scene, const View& view, RenderSettings settings,
                         const Metadata& metadata, FilmKeeper& films, Job& job) {
    const PhaseTimer timer(job, "render");
    films.attach(settings);
    RenderResult result;
    try {
        result = make_method(scene.scene.render.method, scene.scene.render.methods)
                     ->render(view, settings, job);
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Cancelled) films.save();
        throw;
    }
    films.finish(scene.scene.render.method);
    for (const auto& [key, value] : metadata.entries) result.image.metadata.set(key, value);
    if (scene.scene.film.denoise) {
        const PhaseTimer denoising(job, "denoise");
        if (!result.image.has("variance.Y")) {
            throw Error(ErrorKind::Usage, "film.denoise",
                        fmt::format("method '{}' does not know the variance of its pictures",
                                    scene.scene.render.method),
                        "take path or march, or turn it off");
        }
        denoise(result.image, job);
    }
    return result;
}

}  // namespace

void simulate(const LoadedScene& scene, const Order& order, RunStatistics& run, Job& job) {
    const std::optional<Cache> cache = open_cache(scene, order);
    std::vector<FluidFrames> fluids = open_fluids(scene, cache ? &*cache : nullptr, order);
    for (int i = 0; i < order.frames.count(); ++i) {
        const int frame = order.frames[i];
        const JobPart part(job, static_cast<double>(i) / order.frames.count(),
                           (i + 1.0) / order.frames.count(), fmt::format("frame {}", frame));
        for (FluidFrames& fluid : fluids) fluid.ensure(frame, run, job);
    }
    for (FluidFrames& fluid : fluids) fluid.finish();
}

View frame_view(const LoadedScene& scene, const Order& order, int frame, RunStatistics& run,
                Job& job) {
    const std::optional<Cache> cache = open_cache(scene, order);
    std::vector<FluidFrames> fluids = open_fluids(scene, cache ? &*cache : nullptr, order);
    std::vector<std::shared_ptr<const Frame>> frames;
    for (FluidFrames& fluid : fluids) frames.push_back(fluid.get(frame, run, job));
    for (FluidFrames& fluid : fluids) fluid.finish();
    return World(scene.scene, job).view(frames, frame, job);
}

DisplayOptions display_of(const Scene& scene, const Image& image) {
    // A colour map is a picture of itself: its codes are written as they are.
    if (image.metadata.get("display_referred") == "true")
        return {.tone = ToneKind::Linear, .exposure = 0, .dither = false};
    DisplayOptions o;
    o.tone = scene.film.tone;
    o.exposure = scene.film.exposure;
    return o;
}

std::vector<std::string> render(const LoadedScene& scene, const Order& order, RunStatistics& run,
                                Job& job) {
    const std::optional<Cache> cache = open_cache(scene, order);
    std::vector<FluidFrames> fluids = open_fluids(scene, cache ? &*cache : nullptr, order);
    const int count = order.turntable > 0 ? order.turntable : order.frames.count();
    Outputs outputs(scene, order, count > 1);
    std::vector<std::string> written;
    std::vector<std::shared_ptr<const Frame>> frames(fluids.size());
    std::optional<View> base;
    World world(scene.scene, job);
    for (int i = 0; i < count; ++i) {
        const int frame = order.turntable > 0 ? order.frames.first : order.frames[i];
        const int number = order.turntable > 0 ? i + 1 : frame;
        const JobPart part(job, static_cast<double>(i) / count, (i + 1.0) / count,
                           fmt::format("frame {}", number));
        if (i == 0 || order.turntable == 0) {
            const JobPart simulation(job, 0, 0.5, "");
            for (std::size_t f = 0; f < fluids.size(); ++f)
                frames[f] = fluids[f].get(frame, run, job);
            base = world.view(frames, frame, job);
        }
        View view = *base;
        if (order.turntable > 0) {
            CameraParams camera = world.camera(view);
            turn_camera(camera, scene.scene.up_vector(), 2 * pi * i / count);
            view.camera =
                Camera(camera, view.time, view.width(), view.height(), scene.scene.up_vector());
        }
        const JobPart rendering(job, 0.5, 1, "");
        RenderSettings settings = settings_of(scene.scene, order);
        settings.on_partial = [&](const Image& image) { outputs.show_partial(image, number); };
        const Metadata metadata = metadata_of(scene, order, view.frame, i + 1);
        FilmKeeper films(outputs.films(number), film_metadata(scene, order, metadata),
                         order.restart);
        outputs.write(render_with(scene, view, settings, metadata, films, job), number, run,
                      written);
    }
    for (FluidFrames& fluid : fluids) fluid.finish();
    outputs.finish(written);
    return written;
}

}  // namespace gischt
