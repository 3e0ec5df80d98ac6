// SPDX-License-Identifier: Apache-2.0
#include "studio/fluid_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/version.h"
#include "io/atomic_file.h"

namespace gischt {
namespace fs = std::filesystem;

// A state is written this often, in seconds, and more often where that takes at most this share of
// the time: what comes after it is simulated again when the process is killed.
constexpr double state_interval = 5, state_share = 0.05;

FluidFrames::FluidFrames(const LoadedScene& scene, std::size_t fluid, const Cache* cache)
    : scene_(scene),
      fluid_(fluid),
      cache_(is_computed(scene.scene.fluids[fluid]) ? cache : nullptr),
      name_(fluid_names(scene.scene)[fluid]) {}

void FluidFrames::probe(const fs::path& folder, bool restart) {
    if (probes_of(scene_.scene, fluid_).empty()) return;
    tables_.emplace(scene_, fluid_, folder, restart);
}

// Once: what frames of the cache were not measured when they were computed is not known.
void FluidFrames::report_unmeasured(int number, Job& job) {
    if (!tables_ || reported_unmeasured_) return;
    const std::string names =
        tables_->missing_at(scene_.scene.time_of(number), 1 / scene_.scene.fps);
    if (names.empty()) return;
    reported_unmeasured_ = true;
    job.warn(
        fmt::format("frame {} lies in the cache and was not measured by the probes {}: frames "
                    "are measured when they are computed, --restart does",
                    number, names));
}

bool FluidFrames::is_cached(int number) const {
    std::error_code ignored;
    return cache_ && fs::is_regular_file(cache_->vdb(fluid_, number), ignored);
}

// Whether the source could go on from the saved state. A damaged one is no loss but of time: the
// frames come again with the same bits.
bool FluidFrames::load_state(Job& job) {
    std::error_code ignored;
    if (!fs::is_regular_file(cache_->state(fluid_), ignored)) return false;
    try {
        source_->load_state(cache_->state(fluid_));
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input) throw;
        job.warn(fmt::format("{}: {}; '{}' is simulated from its beginning", e.where(), e.fact(),
                             name_));
        return false;
    }
    saved_ = source_->last_frame();
    return true;
}

// Makes a source that can go on to `number`: from the saved state where that is earlier, else from
// the beginning.
void FluidFrames::start(int number, Job& job) {
    source_ = make_source(scene_.scene, scene_.scene.fluids[fluid_]);
    report_unmet_solids(scene_.scene, scene_.scene.fluids[fluid_], job);
    if (cache_) {
        cache_->claim();
        if (load_state(job) && (saved_ < 0 || saved_ >= number)) {
            source_ = make_source(scene_.scene, scene_.scene.fluids[fluid_]);
        }
    }
    if (tables_) source_->set_probes(tables_->probes());
}

// Whether the source can give that frame without starting anew.
bool FluidFrames::can_give(int number) const {
    return source_ && (!source_->is_sequential() || source_->last_frame() < number);
}

Frame FluidFrames::compute(int number, RunStatistics& run, Job& job) {
    const PhaseTimer timer(job, "simulate");
    Frame frame = source_->frame(number, job);
    if (tables_) tables_->add(source_->take_probe_rows());
    frame.metadata["creator"] = std::string("gischt ") + version;
    frame.metadata["scene_hash"] = scene_.hash;
    frame.metadata.emplace("up", scene_.scene.up == UpAxis::Y ? "y" : "z");
    frame.metadata["fps"] = fmt::format("{:g}", scene_.scene.fps);
    run.frames.push_back({name_, number, frame.time, source_->statistics()});
    return frame;
}

void FluidFrames::save_state(bool now) {
    // A state of a later frame stays: a frame that was missing in between is no reason to go back.
    if (!source_->is_sequential() || saved_ >= source_->last_frame()) return;
    const double begin = now_seconds();
    if (!now && begin - saved_at_ < std::min(state_interval, saving_took_ / state_share)) return;
    AtomicFile file(cache_->state(fluid_).string());
    try {
        source_->save_state(file.temporary());
    } catch (const Error& e) {
        throw Error(e.kind(), file.path(), e.fact(), e.hint());
    }
    file.commit();
    saved_ = source_->last_frame();
    saved_at_ = now_seconds();
    saving_took_ = saved_at_ - begin;
}

void FluidFrames::compute_and_write(int number, RunStatistics& run, Job& job) {
    // Between frames the state is whole and can be gone on from; in the middle of one it is not.
    if (job.is_cancelled()) save_state(true);
    job.check();
    const Frame frame = compute(number, run, job);
    const PhaseTimer timer(job, "write");
    write_vdb(cache_->vdb(fluid_, number), frame, {}, job);
}

void FluidFrames::ensure(int number, RunStatistics& run, Job& job) {
    if (!cache_) return;
    if (is_cached(number)) {
        report_unmeasured(number, job);
        return;
    }
    if (!can_give(number)) start(number, job);
    const int first = source_->is_sequential() ? source_->last_frame() + 1 : number;
    for (int n = first; n <= number; ++n) {
        compute_and_write(n, run, job);
        save_state(false);
    }
}

bool FluidFrames::stir(const std::vector<EmitterParams>& hand, Job& job) {
    if (cache_) return false;
    if (!source_) start(1, job);
    const Transform placement = common_of(scene_.scene.fluids[fluid_]).placement();
    const Transform inverse = placement.inverse();
    std::vector<EmitterParams> own = hand;
    for (EmitterParams& e : own) {
        e.position = inverse.point(e.position.at(0));
        e.radius = e.radius.at(0) * std::cbrt(std::abs(inverse.determinant()));
        if (e.velocity) e.velocity = inverse.vector(e.velocity->at(0));
    }
    return source_->set_hand(own);
}

std::optional<int> FluidFrames::last_computed() const {
    if (cache_) return std::nullopt;
    if (!source_) return is_computed(scene_.scene.fluids[fluid_]) ? std::optional(0) : std::nullopt;
    return source_->is_sequential() ? std::optional(source_->last_frame()) : std::nullopt;
}

void FluidFrames::finish() {
    if (cache_ && source_) save_state(true);
}

std::shared_ptr<const Frame> FluidFrames::get(int number, RunStatistics& run, Job& job) {
    if (cache_) {
        ensure(number, run, job);
        const PhaseTimer timer(job, "read");
        VdbReadOptions options;
        options.half_voxel = HalfVoxel::Follow;
        options.customary = false;  // the frames are gischt's own
        Frame frame = read_vdb(cache_->vdb(fluid_, number), options, job);
        frame.number = number;
        frame.time = scene_.scene.time_of(number);
        return std::make_shared<const Frame>(std::move(frame));
    }
    if (!can_give(number)) start(number, job);
    if (source_->is_sequential()) {
        for (int n = source_->last_frame() + 1; n < number; ++n) compute(n, run, job);
    }
    const bool computed = is_computed(scene_.scene.fluids[fluid_]);
    return std::make_shared<const Frame>(computed ? compute(number, run, job)
                                                  : source_->frame(number, job));
}

}  // namespace gischt
