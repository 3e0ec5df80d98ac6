// SPDX-License-Identifier: Apache-2.0
#include "artist.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "gl/device.h"
#include "render/billboards/billboard_drawer.h"
#include "render/march/gpu_march_drawer.h"
#include "render/params.h"
#include "render/points/point_drawer.h"
#include "render/slices/slice_drawer.h"

namespace gischt {
namespace {

std::unique_ptr<SceneDrawer> make_drawer(const std::string& method, const RenderParams& params) {
    GlDevice& device = offscreen_device();
    if (method == "slices") return std::make_unique<SliceDrawer>(device, params.slices);
    if (method == "gpu_march") return std::make_unique<GpuMarchDrawer>(device, params.gpu_march);
    if (method == "points") return std::make_unique<PointDrawer>(device, params.points);
    return std::make_unique<BillboardDrawer>(device, params.billboards);
}

// Rows from bottom to top, four floats per pixel.
Image to_image(const std::vector<float>& rgba, const Vec2i& size) {
    Image image = Image::rgba(size.x, size.y);
    constexpr std::array<const char*, 4> names{"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) {
        const auto out = image.channel(names[c]);
        for (int y = 0; y < size.y; ++y) {
            const std::size_t row = image.index(0, size.y - 1 - y);
            for (int x = 0; x < size.x; ++x) {
                out[image.index(x, y)] = rgba[4 * (row + static_cast<std::size_t>(x)) + c];
            }
        }
    }
    return image;
}

Camera camera_of(const PictureWish& wish) {
    return Camera(wish.camera, wish.shot->view.time, wish.size.x, wish.size.y,
                  wish.shot->scene->scene.up_vector());
}

}  // namespace

bool is_realtime(const std::string& method) {
    constexpr std::array<const char*, 4> names{"slices", "gpu_march", "points", "billboards"};
    return std::ranges::find(names, method) != names.end();
}

struct Artist::Board {
    std::shared_ptr<const Snapshot> shot;
    std::string method;
    View view;
    std::unique_ptr<SceneDrawer> drawer;
    std::optional<OpaquePainter> painter;
    std::optional<OpaqueLayer> layer;
    std::optional<GlFramebuffer> target;
};

Artist::Artist() : thread_([this] { work(); }) {}

Artist::~Artist() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        if (job_) job_->cancel();
    }
    changed_.notify_all();
    thread_.join();
}

std::uint64_t Artist::wish(PictureWish wish) {
    const std::lock_guard lock(mutex_);
    wished_ = std::move(wish);
    if (job_) job_->cancel();
    changed_.notify_all();
    return ++wishes_;
}

void Artist::rest() {
    const std::lock_guard lock(mutex_);
    wished_.reset();
    if (job_) job_->cancel();
}

std::shared_ptr<const Picture> Artist::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(newest_, nullptr);
}

std::string Artist::error(std::uint64_t wish) const {
    const std::lock_guard lock(mutex_);
    return failed_ == wish ? error_ : std::string();
}

void Artist::work() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
        if (!wished_) {
            changed_.wait(lock, [&] { return ends_ || wished_; });
            continue;
        }
        const PictureWish wish = *std::exchange(wished_, std::nullopt);
        const std::uint64_t id = wishes_;
        job_ = std::make_shared<Job>();
        const std::shared_ptr<Job> job = job_;
        lock.unlock();
        std::string error;
        try {
            make(wish, id, *job);
        } catch (const std::exception& e) {
            if (!job->is_cancelled()) error = e.what();
        }
        lock.lock();
        if (!error.empty()) {
            error_ = error;
            failed_ = id;
        }
    }
    board_.reset();  // on the thread of its context
}

void Artist::show(Picture picture) {
    const std::lock_guard lock(mutex_);
    picture.number = ++pictures_;
    newest_ = std::make_shared<const Picture>(std::move(picture));
}

void Artist::make(const PictureWish& wish, std::uint64_t id, Job& job) {
    if (is_realtime(wish.method)) {
        draw(wish, id, job);
    } else {
        render(wish, id, job);
    }
}

void Artist::draw(const PictureWish& wish, std::uint64_t id, Job&) {
    const double start = now_seconds();
    Job unstopped;  // a picture is over soon, and what was made for it serves the next one
    if (!board_) board_ = std::make_unique<Board>();
    Board& b = *board_;
    const bool is_other_scene = !b.shot || b.shot->scene != wish.shot->scene;
    if (!b.drawer || b.method != wish.method || is_other_scene) {
        b.painter.reset();
        b.drawer = make_drawer(wish.method, wish.shot->scene->scene.render.methods);
        b.method = wish.method;
        b.shot = nullptr;
    }
    if (b.shot != wish.shot) {
        b.painter.reset();
        b.shot = nullptr;
        b.view = wish.shot->view;
        b.drawer->upload(b.view, unstopped);
        b.painter.emplace(b.view, b.drawer->grid());
        b.shot = wish.shot;
    }
    if (!b.layer) b.layer.emplace(offscreen_device());
    if (!b.target || b.target->size() != wish.size) b.target.emplace(offscreen_device(), wish.size);
    const Camera camera = camera_of(wish);
    b.layer->upload(b.painter->paint(camera, {0, 0}, {0.5f, 0.5f}, unstopped));
    b.drawer->draw({camera, {0, 0}, 0.5f, false}, *b.layer, *b.target);
    show({to_image(b.target->read(), wish.size), wish.method, camera, wish.shot->frame,
          now_seconds() - start, 1, true, id, 0});
}

void Artist::render(const PictureWish& wish, std::uint64_t id, Job& job) {
    const double start = now_seconds();
    const Scene& scene = wish.shot->scene->scene;
    View view = wish.shot->view;
    view.camera = camera_of(wish);
    RenderSettings settings;
    settings.samples_per_pixel = wish.samples;
    settings.seed = static_cast<std::uint64_t>(scene.seed);
    settings.depth = scene.render.depth;
    settings.filter = scene.film.filter;
    settings.filter_radius = scene.film.filter_radius;
    settings.partial_interval = 0.4;
    const auto picture = [&](const Image& image, double samples, bool is_whole) {
        return Picture{image,
                       wish.method,
                       view.camera,
                       wish.shot->frame,
                       now_seconds() - start,
                       samples,
                       is_whole,
                       id,
                       0};
    };
    settings.on_partial = [&](const Image& image) { show(picture(image, 0, false)); };
    const RenderResult result =
        make_method(wish.method, scene.render.methods)->render(view, settings, job);
    show(picture(result.image, result.statistics.samples_per_pixel, true));
}

}  // namespace gischt
