// SPDX-License-Identifier: Apache-2.0
#include "render/progressive.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "image/coarse_order.h"
#include "render/tile_grid.h"

namespace gischt {
namespace {

constexpr int tile_edge = 16;          // pixels
constexpr double worth_showing = 0.5;  // s of work, after which the coarsest picture is shown
constexpr double never = std::numeric_limits<double>::infinity();

// Workers that no thread holds at the moment: at most as many as threads are ever made.
class WorkerPool {
  public:
    explicit WorkerPool(const ProgressiveTask& task) : task_(task) {}

    std::unique_ptr<PixelWorker> take() {
        const std::scoped_lock lock(mutex_);
        if (idle_.empty()) return task_.make_worker();
        std::unique_ptr<PixelWorker> worker = std::move(idle_.back());
        idle_.pop_back();
        return worker;
    }
    void give(std::unique_ptr<PixelWorker> worker) {
        const std::scoped_lock lock(mutex_);
        idle_.push_back(std::move(worker));
    }
    void count(RenderStatistics& statistics) const {
        for (const auto& worker : idle_) {
            statistics.rays += worker->rays;
            statistics.lookups += worker->lookups;
        }
    }

  private:
    const ProgressiveTask& task_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<PixelWorker>> idle_;
};

// Passes double, and grow by a quarter where one may be the last because of its noise. They end
// with a group of samples.
int next_goal(int goal, const RenderSettings& settings, const ProgressiveTask& task) {
    int next = settings.noise > 0 && goal >= 8 ? goal + goal / 4 : 2 * goal;
    if (task.prepare) {
        const int at = settings.first_sample + goal;
        next = std::min(next, (at / task.group + 1) * task.group - settings.first_sample);
    }
    return std::min(next, settings.samples_per_pixel);
}

constexpr int first_adaptive_goal = 16;

// One picture being made. A tile has a goal: the number of samples that its pixels shall have when
// the pass is over. A pixel's own count tells which sample comes next, so that the work can be left
// and taken up between any two samples.
class Progression {
  public:
    Progression(const View& view, const RenderSettings& settings, const ProgressiveTask& task,
                Job& job, FilmState& state)
        : view_(view),
          settings_(settings),
          task_(task),
          job_(job),
          state_(state),
          pool_(task),
          tiles_(view.width(), view.height(), tile_edge),
          order_(view.width(), view.height()),
          start_(now_seconds()),
          next_partial_(settings.on_partial ? start_ + settings.partial_interval : never),
          next_checkpoint_(settings.on_checkpoint ? start_ + settings.checkpoint_interval : never),
          stop_(settings.time_limit > 0 ? start_ + settings.time_limit : never) {}

    RenderResult run() {
        open_film();
        taken_ = film().total_samples();
        while (pass() && set_goals()) {
        }
        return result();
    }

  private:
    Film& film() { return *state_.film; }
    bool has_splats() const { return task_.has_light_paths || task_.paint; }

    // Makes the film, or checks that the one there can be gone on with.
    void open_film() {
        const ReconstructionFilter filter(settings_.filter,
                                          static_cast<float>(settings_.filter_radius));
        state_.has_variance = task_.layout.variance;
        state_.has_samples = task_.layout.samples;
        if (!state_.film) {
            state_.film.emplace(view_.width(), view_.height(), filter, task_.layout.channels);
            if (has_splats()) film().want_splats();
            state_.ranges.clear();
            goals().assign(tiles_.count(), 1);
            return;
        }
        const Film& old = film();
        const bool fits =
            old.width() == view_.width() && old.height() == view_.height() &&
            old.filter().kind() == filter.kind() && old.filter().radius() == filter.radius() &&
            old.extra_names() == task_.layout.channels && old.has_splats() == has_splats();
        const bool is_one_run =
            state_.ranges.empty() ||
            (state_.ranges.size() == 1 && state_.ranges[0].begin == settings_.first_sample);
        const std::string holds = fmt::format("it holds the samples {}", to_text(state_.ranges));
        if (!fits) fail("its size, filter or channels are others");
        if (goals().empty() && state_.is_complete()) goals().assign(tiles_.count(), most_samples());
        if (!is_one_run || goals().size() != tiles_.count())
            fail(holds + ", with gaps or not from the first one on");
        if (most_samples() > settings_.samples_per_pixel) fail(holds + ", more than asked for");
        for (auto& goal : goals()) goal = std::clamp(goal, 1, settings_.samples_per_pixel);
        if (task_.paint) note_painted();
    }
    // How many indices of samples the film's light paths are of.
    void note_painted() { painted_ = static_cast<int>(film().light_paths() / task_.painted_paths); }
    [[noreturn]] static void fail(const std::string& what) {
        throw Error(ErrorKind::Usage, "film", "cannot go on with the film: " + what,
                    "--restart throws it away");
    }

    std::vector<std::int32_t>& goals() { return state_.tile_goals; }
    std::int32_t goal() { return *std::max_element(goals().begin(), goals().end()); }
    int most_samples() {
        std::int32_t most = 0;
        for (const FilmPixel& p : std::as_const(film()).pixels()) most = std::max(most, p.count);
        return most;
    }

    // The goals of the next pass; false when there is none.
    bool set_goals() {
        const int now = goal(), next = next_goal(now, settings_, task_);
        if (now >= settings_.samples_per_pixel || now_seconds() >= stop_) return false;
        if (settings_.noise > 0 && now > 1) {
            const double noise = film().noise();
            least_done_ = noise > 0 ? std::min(1.0, std::pow(settings_.noise / noise, 2)) : 1;
            if (!is_adaptive() && noise <= settings_.noise) return false;
        }
        if (!(settings_.noise > 0 && is_adaptive() && now >= first_adaptive_goal)) {
            goals().assign(tiles_.count(), next);
            return true;
        }
        const std::vector<char> noisy = tiles_.noisy(film(), settings_.noise);
        bool any = false;
        for (std::size_t t = 0; t < noisy.size(); ++t) {
            if (!noisy[t]) continue;
            goals()[t] = next;
            any = true;
        }
        return any;
    }

    bool is_adaptive() const { return settings_.adaptive && !task_.prepare; }

    void prepare() {
        const int last = goal();
        const auto& pixels = std::as_const(film()).pixels();
        const bool is_done = std::all_of(pixels.begin(), pixels.end(),
                                         [&](const FilmPixel& p) { return p.count >= last; });
        if (!is_done) task_.prepare((settings_.first_sample + last - 1) / task_.group);
    }

    // Brings all tiles to their goals; false when the time was up before.
    bool pass() {
        if (task_.prepare) prepare();
        const PhaseTimer timer(job_, task_.method);
        if (goal() > 1) return sweep(1, stop_);
        // The first samples come from coarse to fine.
        if (!sweep(CoarseOrder::coarsest, never)) return false;
        if (next_partial_ < never && now_seconds() > start_ + worth_showing) next_partial_ = 0;
        for (int edge = CoarseOrder::coarsest / 2; edge > 0; edge /= 2) {
            if (!sweep(edge, stop_)) return false;
        }
        return true;
    }

    // The same for one pixel of each block of that edge.
    bool sweep(int edge, double stop) {
        edge_ = edge;
        pending_.resize(tiles_.count());
        std::iota(pending_.begin(), pending_.end(), 0);
        while (true) {
            work_until(std::min({next_partial_, next_checkpoint_, stop}));
            note_range();
            job_.check();
            if (pending_.empty() && !paints(stop)) return true;
            if (now_seconds() >= stop) return false;
            show_and_save();
        }
    }

    // Paints what belongs to the next index of samples; false when all are painted.
    bool paints(double stop) {
        if (!task_.paint || painted_ >= goal() || now_seconds() >= stop) return false;
        const auto painting =
            task_.paint(static_cast<std::uint32_t>(settings_.first_sample + painted_));
        for (const auto& splats : painting) {
            for (const FilmSplat& s : splats) film().splat(s);
        }
        film().count_light_paths(task_.painted_paths);
        return ++painted_ < goal();
    }

    void show_and_save() {
        if (now_seconds() >= next_partial_) {
            settings_.on_partial(state_.image());
            next_partial_ = now_seconds() + settings_.partial_interval;
        }
        const double before = now_seconds();
        if (before < next_checkpoint_) return;
        settings_.on_checkpoint();
        // At most a twentieth of the time goes into saving.
        const double after = now_seconds();
        next_checkpoint_ = after + std::max(settings_.checkpoint_interval, 20 * (after - before));
    }

    void note_range() {
        const int first = settings_.first_sample, most = most_samples();
        state_.ranges.clear();
        if (most > 0) state_.ranges.push_back({first, first + most});
    }

    // Works on the pending tiles and drops those that are done.
    void work_until(double pause) {
        std::vector<char> done(pending_.size(), 0);
        const auto count = static_cast<int>(pending_.size());
        parallel_ranges(count, 1, [&](int begin, int end) {
            std::unique_ptr<PixelWorker> worker = pool_.take();
            for (int i = begin; i < end; ++i) {
                const auto at = static_cast<std::size_t>(i);
                done[at] = tile(*worker, pending_[at], pause) ? 1 : 0;
            }
            pool_.give(std::move(worker));
        });
        std::size_t left = 0;
        for (std::size_t i = 0; i < done.size(); ++i) {
            if (!done[i]) pending_[left++] = pending_[i];
        }
        pending_.resize(left);
    }

    // False when it was left before its end.
    bool tile(PixelWorker& worker, int number, double pause) {
        const PixelTile area = tiles_.at(number);
        const std::int64_t tile_goal = goals()[static_cast<std::size_t>(number)];
        std::vector<float> extra(task_.layout.channels.size());
        LightLanded landed;
        std::int64_t taken = 0;
        bool whole = true;
        for (int y = area.y0; y < area.y1 && whole; ++y) {
            for (int x = area.x0; x < area.x1 && whole; ++x) {
                if (edge_ > 1 && !order_.is_first(x, y, edge_)) continue;
                for (auto s = film().samples(x, y); s < tile_goal && whole; ++s, ++taken) {
                    // One sample may take long.
                    whole = !job_.is_cancelled() && now_seconds() < pause;
                    if (whole) pixel(worker, x, y, static_cast<int>(s), extra, landed);
                }
            }
        }
        put_down(landed);
        report(taken);
        return whole;
    }

    // What light paths have left, until it is put on the film.
    struct LightLanded {
        std::vector<FilmSplat> splats;
        std::int64_t paths = 0;
    };
    void put_down(LightLanded& landed) {
        if (landed.paths == 0) return;
        const std::scoped_lock lock(splat_mutex_);
        for (const FilmSplat& s : landed.splats) film().splat(s);
        film().count_light_paths(landed.paths);
        landed.splats.clear();
        landed.paths = 0;
    }
    void land(PixelWorker& worker, FilmSample& out, LightLanded& landed) {
        if (!task_.has_light_paths) return;
        const bool counts =
            std::all_of(worker.splats.begin(), worker.splats.end(), Film::is_countable);
        if (!counts) out.radiance = Vec3f(std::numeric_limits<float>::quiet_NaN());
        if (counts) {
            landed.splats.insert(landed.splats.end(), worker.splats.begin(), worker.splats.end());
        }
        ++landed.paths;
        constexpr std::size_t many = 1 << 14;
        if (landed.splats.size() > many) put_down(landed);
    }

    void pixel(PixelWorker& worker, int x, int y, int sample, std::vector<float>& extra,
               LightLanded& landed) {
        PixelSample at;
        at.x = x;
        at.y = y;
        at.index = static_cast<std::uint32_t>(settings_.first_sample + sample);
        at.numbers = PixelSampler(settings_.seed, view_.frame, x, y, at.index);
        // The same places in every frame: the edges of what stands still do not flicker.
        const PixelSampler places(settings_.seed, 0, x, y, at.index);
        const FilterSample place = film().sample_filter(places.two(SampleDimension::Film));
        at.film_x = x + 0.5 + static_cast<double>(place.offset.x);
        at.film_y = y + 0.5 + static_cast<double>(place.offset.y);
        if (view_.camera.has_aperture()) at.lens = at.numbers.two(SampleDimension::Lens);
        if (view_.shutter > 0) {
            at.time = static_cast<double>(at.numbers.one(SampleDimension::Time));
        }

        FilmSample out;
        std::fill(extra.begin(), extra.end(), 0.0f);
        worker.splats.clear();
        worker.sample(at, out, extra);
        land(worker, out, landed);
        out.weight = place.weight;
        film().add(x, y, out, extra);
    }

    void report(std::int64_t taken) {
        const double all =
            static_cast<double>(view_.width()) * view_.height() * settings_.samples_per_pixel;
        double done = std::max(static_cast<double>(taken_ += taken) / all, least_done_.load());
        if (stop_ < never) done = std::max(done, (now_seconds() - start_) / (stop_ - start_));
        job_.progress(std::min(done, 1.0), task_.method);
    }

    RenderResult result() {
        const double pixels = static_cast<double>(view_.width()) * view_.height();
        RenderResult out;
        out.image = state_.image();
        out.statistics.samples_per_pixel = static_cast<double>(film().total_samples()) / pixels;
        pool_.count(out.statistics);
        const double noise = film().noise();
        out.statistics.noise = std::isfinite(noise) ? noise : 0;
        out.statistics.wall_seconds = now_seconds() - start_;
        if (const std::int64_t rejected = film().rejected(); rejected > 0) {
            job_.warn(fmt::format("{} samples were no numbers or out of range; they count as black",
                                  rejected));
        }
        Metadata& m = out.image.metadata;
        m.set("method", task_.method);
        m.set("samples", fmt::format("{}", out.statistics.samples_per_pixel));
        m.set("seed", fmt::format("{}", settings_.seed));
        return out;
    }

    const View& view_;
    const RenderSettings& settings_;
    const ProgressiveTask& task_;
    Job& job_;
    FilmState& state_;
    WorkerPool pool_;
    TileGrid tiles_;
    CoarseOrder order_;
    int edge_ = 1;  // of the blocks of which one pixel is taken
    double start_, next_partial_, next_checkpoint_, stop_;  // of now_seconds()
    std::mutex splat_mutex_;
    int painted_ = 0;                     // indices of samples
    std::vector<int> pending_;            // tiles of this pass that are not done
    std::atomic<std::int64_t> taken_{0};  // samples, for the progress
    std::atomic<double> least_done_{0};   // what the noise says of it
};

}  // namespace

RenderResult render_progressively(const View& view, const RenderSettings& settings,
                                  const ProgressiveTask& task, Job& job) {
    FilmState own;
    return Progression(view, settings, task, job, settings.film ? *settings.film : own).run();
}

}  // namespace gischt
