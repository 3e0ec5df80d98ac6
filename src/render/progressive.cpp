// SPDX-License-Identifier: Apache-2.0
#include "render/progressive.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/parallel.h"

namespace gischt {
namespace {

constexpr int tile_edge = 16;  // pixels
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

// One picture being made. A tile has a goal: the number of samples that its pixels shall have when
// the pass is over. A pixel's own count tells which sample comes next, so that the work can be left
// and taken up between any two samples.
class Progression {
  public:
    Progression(const View& view, const RenderSettings& settings, const ProgressiveTask& task,
                Job& job)
        : view_(view),
          settings_(settings),
          task_(task),
          job_(job),
          film_(view.width(), view.height(),
                ReconstructionFilter(settings.filter, static_cast<float>(settings.filter_radius)),
                task.extra_channels),
          pool_(task),
          tiles_x_((view.width() + tile_edge - 1) / tile_edge),
          tiles_y_((view.height() + tile_edge - 1) / tile_edge),
          start_(now_seconds()),
          next_partial_(settings.on_partial ? start_ + settings.partial_interval : never),
          stop_(settings.time_limit > 0 ? start_ + settings.time_limit : never) {}

    RenderResult run() {
        for (int goal = 1; pass(goal); goal = next_goal(goal)) {
            if (goal >= settings_.samples_per_pixel || now_seconds() >= stop_) break;
            if (settings_.noise > 0 && goal > 1 && film_.noise() <= settings_.noise) break;
        }
        return result();
    }

  private:
    // Passes double, and grow by a quarter where one may be the last: its noise is looked at.
    int next_goal(int goal) const {
        const int next = settings_.noise > 0 && goal >= 8 ? goal + goal / 4 : 2 * goal;
        return std::min(next, settings_.samples_per_pixel);
    }

    // Brings all pixels to the goal; false when the time was up before.
    bool pass(int goal) {
        const PhaseTimer timer(job_, task_.method);
        goal_ = goal;
        pending_.clear();
        for (int t = 0; t < tiles_x_ * tiles_y_; ++t) pending_.push_back(t);
        while (true) {
            const double stop = goal == 1 ? never : stop_;
            work_until(std::min(next_partial_, stop));
            job_.check();
            if (pending_.empty()) return true;
            const double now = now_seconds();
            if (now >= next_partial_) {
                settings_.on_partial(film_.image());
                next_partial_ = now_seconds() + settings_.partial_interval;
            }
            if (now >= stop) return false;
        }
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
        const int x0 = number % tiles_x_ * tile_edge, y0 = number / tiles_x_ * tile_edge;
        const int x1 = std::min(x0 + tile_edge, view_.width()),
                  y1 = std::min(y0 + tile_edge, view_.height());
        std::vector<float> extra(task_.extra_channels.size());
        for (int y = y0; y < y1; ++y) {
            std::int64_t taken = 0;
            for (int x = x0; x < x1; ++x) {
                if (job_.is_cancelled() || now_seconds() >= pause) return false;
                for (auto s = film_.samples(x, y); s < goal_; ++s, ++taken) {
                    pixel(worker, x, y, static_cast<int>(s), extra);
                }
            }
            report(taken);
        }
        return true;
    }

    void pixel(PixelWorker& worker, int x, int y, int sample, std::vector<float>& extra) {
        PixelSample at;
        at.x = x;
        at.y = y;
        at.index = static_cast<std::uint32_t>(settings_.first_sample + sample);
        at.numbers = PixelSampler(settings_.seed, view_.frame, x, y, at.index);
        // The same places in every frame: the edges of what stands still do not flicker.
        const PixelSampler places(settings_.seed, 0, x, y, at.index);
        const FilterSample place = film_.sample_filter(places.two(SampleDimension::Film));
        at.film_x = x + 0.5 + static_cast<double>(place.offset.x);
        at.film_y = y + 0.5 + static_cast<double>(place.offset.y);

        FilmSample out;
        std::fill(extra.begin(), extra.end(), 0.0f);
        worker.sample(at, out, extra);
        out.weight = place.weight;
        film_.add(x, y, out, extra);
    }

    void report(std::int64_t taken) {
        const std::int64_t all =
            static_cast<std::int64_t>(view_.width()) * view_.height() * settings_.samples_per_pixel;
        const std::int64_t done = taken_ += taken;
        job_.progress(static_cast<double>(done) / static_cast<double>(all), task_.method);
    }

    RenderResult result() const {
        const double pixels = static_cast<double>(view_.width()) * view_.height();
        RenderResult out;
        out.image = film_.image();
        out.statistics.samples_per_pixel = static_cast<double>(film_.total_samples()) / pixels;
        pool_.count(out.statistics);
        const double noise = film_.noise();
        out.statistics.noise = std::isfinite(noise) ? noise : 0;
        out.statistics.wall_seconds = now_seconds() - start_;
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
    Film film_;
    WorkerPool pool_;
    int tiles_x_, tiles_y_;
    double start_, next_partial_, stop_;  // of now_seconds()
    int goal_ = 0;                        // samples per pixel when the pass is over
    std::vector<int> pending_;            // tiles of this pass that are not done
    std::atomic<std::int64_t> taken_{0};  // samples, for the progress
};

}  // namespace

RenderResult render_progressively(const View& view, const RenderSettings& settings,
                                  const ProgressiveTask& task, Job& job) {
    return Progression(view, settings, task, job).run();
}

}  // namespace gischt
