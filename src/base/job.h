// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace gischt {

// Everything that can take longer than 100 ms takes a Job&: it reports how far it is, may be asked
// to stop, and leaves remarks and times behind. The library never prints: who owns the job decides
// what becomes of the reports. All members may be called from several threads.
class Job {
  public:
    enum class Level { Info, Warning };

    // Called with the fraction done in [0,1] and the name of the phase; null is allowed.
    std::function<void(double fraction, std::string_view phase)> on_progress;
    // Called with what the user should know: an assumption made, a grid skipped; null is allowed.
    std::function<void(Level, std::string_view text)> on_message;

    void progress(double fraction, std::string_view phase);
    void info(std::string_view text) { message(Level::Info, text); }
    void warn(std::string_view text) { message(Level::Warning, text); }

    // Asks the work to stop; safe in a signal handler.
    void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
    bool is_cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
    // Throws Error{Cancelled} once cancel() was called. Loops call it about every 10 ms of work.
    void check() const;

    // Wall seconds by phase name, for --stats.
    void add_time(std::string_view phase, double seconds);
    std::map<std::string, double> times() const;

  private:
    friend class JobPart;
    void message(Level level, std::string_view text);

    std::atomic<bool> cancelled_{false};
    static_assert(std::atomic<bool>::is_always_lock_free);
    mutable std::mutex mutex_;
    std::map<std::string, double> times_;
    double part_begin_ = 0, part_end_ = 1;
    std::string part_name_;
};

// While it lives, progress() of the job counts from `begin` to `end` of what it counted before, and
// names the part before the phase: a sequence gives each of its frames such a part. Parts nest; one
// thread makes them.
class JobPart {
  public:
    JobPart(Job& job, double begin, double end, std::string_view name);
    ~JobPart();
    JobPart(const JobPart&) = delete;
    JobPart& operator=(const JobPart&) = delete;

  private:
    Job& job_;
    double begin_, end_;
    std::string name_;
};

// Adds the wall time of a scope to a phase of a job.
class PhaseTimer {
  public:
    PhaseTimer(Job& job, std::string_view phase);
    ~PhaseTimer();
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

  private:
    Job& job_;
    std::string phase_;
    double start_;
};

// Seconds of a monotonic clock.
double now_seconds();

}  // namespace gischt
