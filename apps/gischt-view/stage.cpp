// SPDX-License-Identifier: Apache-2.0
#include "stage.h"

#include <algorithm>
#include <chrono>

#include "base/error.h"

namespace gischt {
namespace {

constexpr std::size_t most_kept = std::size_t{2} << 30;  // bytes of frames to go back to

std::size_t bytes_of(const Frame& frame) {
    std::size_t bytes = 0;
    for (const auto& [name, field] : frame.fields) {
        bytes += field.component.size() * static_cast<std::size_t>(field.map().size()) *
                 tile_values * sizeof(float);
    }
    for (const auto& [name, particles] : frame.particles) bytes += particles.size() * 100;
    return bytes;
}

}  // namespace

Stage::Stage(SceneLoader loader, std::optional<std::filesystem::path> cache)
    : loader_(std::move(loader)), folder_(std::move(cache)), thread_([this] { work(); }) {}

Stage::~Stage() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    job_.cancel();
    changed_.notify_all();
    thread_.join();
}

void Stage::open(SceneLoader loader) {
    const std::lock_guard lock(mutex_);
    loader_ = std::move(loader);
    overrides_.clear();
    must_load_ = must_reset_ = true;
    changed_.notify_all();
}

void Stage::set_overrides(std::vector<std::string> overrides) {
    const std::lock_guard lock(mutex_);
    overrides_ = std::move(overrides);
    must_load_ = true;
    changed_.notify_all();
}

void Stage::seek(int frame) {
    const std::lock_guard lock(mutex_);
    wanted_ = frame;
    playing_ = false;
    changed_.notify_all();
}

void Stage::play(bool on) {
    const std::lock_guard lock(mutex_);
    playing_ = on;
    changed_.notify_all();
}

void Stage::reset() {
    const std::lock_guard lock(mutex_);
    must_reset_ = true;
    changed_.notify_all();
}

void Stage::stir(std::optional<EmitterParams> hand) {
    const std::lock_guard lock(mutex_);
    hand_ = std::move(hand);
}

std::shared_ptr<const Snapshot> Stage::latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
}

bool Stage::is_playing() const {
    const std::lock_guard lock(mutex_);
    return playing_;
}

bool Stage::is_busy() const {
    const std::lock_guard lock(mutex_);
    return busy_;
}

std::string Stage::error() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

int Stage::furthest_frame() const {
    const std::lock_guard lock(mutex_);
    return furthest_;
}

void Stage::work() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
        try {
            if (step(lock)) continue;
        } catch (const std::exception& e) {
            if (!lock.owns_lock()) lock.lock();
            error_ = e.what();
            playing_ = false;
            wanted_.reset();
        }
        busy_ = false;
        if (ends_) break;
        if (playing_) {  // until the next frame is due
            changed_.wait_for(lock, std::chrono::duration<double>(
                                        std::clamp(next_at_ - now_seconds(), 0.001, 0.1)));
        } else {
            changed_.wait(lock, [&] {
                return ends_ || must_load_ || must_reset_ || playing_ || wanted_.has_value();
            });
        }
    }
}

// Does one thing that is wished for; false where there is nothing to do at this moment.
bool Stage::step(std::unique_lock<std::mutex>& lock) {
    if (must_load_) {
        load(lock);
        return true;
    }
    if (!scene_) return false;
    const Vec2i range = scene_->scene.frames;
    if (must_reset_) {
        must_reset_ = false;
        begin_fluids();
        wanted_ = range.x;
    }
    std::optional<int> number = std::exchange(wanted_, std::nullopt);
    if (!number && playing_ && now_seconds() >= next_at_) {
        number = shown_ + 1;
        const bool is_live = std::ranges::any_of(
            fluids_, [](const FluidFrames& f) { return f.last_computed().has_value(); });
        if (*number > range.y && !is_live) number = range.x;
    }
    if (!number) return false;
    const std::optional<EmitterParams> hand = hand_;
    busy_ = true;
    lock.unlock();
    const double start = now_seconds();
    std::vector<EmitterParams> hands;
    if (hand) hands = {*hand};
    for (FluidFrames& fluid : fluids_) {
        // A hand works on the newest frame: what was seen after an older one is no more.
        if (fluid.last_computed() && fluid.stir(hands, job_) && hand) {
            number = std::max(*number, *fluid.last_computed() + 1);
        }
    }
    const Frames those = frames(*number);
    publish(*number, those, start);
    lock.lock();
    next_at_ = std::max(now_seconds(), start + 1 / scene_->scene.fps);
    return true;
}

void Stage::load(std::unique_lock<std::mutex>& lock) {
    must_load_ = false;
    const SceneLoader loader = loader_;
    const std::vector<std::string> overrides = overrides_;
    busy_ = true;
    lock.unlock();
    auto scene = std::make_shared<const LoadedScene>(loader(overrides, job_));
    auto world = std::make_shared<World>(scene->scene, job_);
    const bool is_same_motion =
        scene_ && scene_->motion_hash == scene->motion_hash && !fluids_.empty();
    const int number =
        is_same_motion && shown_ > 0 ? shown_ : std::max(shown_, scene->scene.frames.x);
    lock.lock();
    error_.clear();
    const bool is_new = std::exchange(must_reset_, false) || !is_same_motion;
    scene_ = std::move(scene);
    world_ = std::move(world);
    if (is_new) begin_fluids();
    if (!wanted_) wanted_ = is_new ? scene_->scene.frames.x : number;
}

// The fluids of the scene, none of whose frames are known.
void Stage::begin_fluids() {
    fluids_.clear();
    motion_ = scene_;
    cache_.reset();
    if (folder_) cache_.emplace(*folder_, *motion_, false, true);
    for (std::size_t i = 0; i < motion_->scene.fluids.size(); ++i) {
        fluids_.emplace_back(*motion_, i, cache_ ? &*cache_ : nullptr);
    }
    kept_.clear();
    bytes_.clear();
    kept_bytes_ = 0;
    furthest_ = 0;
    shown_ = 0;
}

Stage::Frames Stage::frames(int number) {
    if (const auto found = kept_.find(number); found != kept_.end()) return found->second;
    RunStatistics run;
    Frames all;
    for (FluidFrames& fluid : fluids_) all.push_back(fluid.get(number, run, job_));
    keep(number, all);
    return all;
}

void Stage::keep(int number, const Frames& frames) {
    std::size_t bytes = 0;
    for (const auto& frame : frames) bytes += bytes_of(*frame);
    kept_[number] = frames;
    bytes_[number] = bytes;
    kept_bytes_ += bytes;
    while (kept_bytes_ > most_kept && kept_.size() > 1) {
        const int oldest = kept_.begin()->first;
        kept_bytes_ -= bytes_[oldest];
        bytes_.erase(oldest);
        kept_.erase(kept_.begin());
    }
}

void Stage::publish(int number, const Frames& frames, double start) {
    auto shot = std::make_shared<Snapshot>();
    shot->scene = scene_;
    shot->world = world_;
    shot->view = world_->view(frames, number, job_);
    shot->camera = world_->camera(shot->view);
    shot->frame = number;
    shot->seconds = now_seconds() - start;
    shot->serial = ++serial_;
    const std::lock_guard lock(mutex_);
    shown_ = number;
    furthest_ = std::max(furthest_, kept_.empty() ? number : kept_.rbegin()->first);
    latest_ = std::move(shot);
}

}  // namespace gischt
