// SPDX-License-Identifier: Apache-2.0
#include "base/job.h"

#include <chrono>

#include "base/error.h"

namespace gischt {

void Job::progress(double fraction, std::string_view phase) {
    const std::scoped_lock lock(mutex_);
    if (on_progress) on_progress(fraction, phase);
}

void Job::message(Level level, std::string_view text) {
    const std::scoped_lock lock(mutex_);
    if (on_message) on_message(level, text);
}

void Job::check() const {
    if (is_cancelled()) throw Error(ErrorKind::Cancelled, "", "interrupted");
}

void Job::add_time(std::string_view phase, double seconds) {
    const std::scoped_lock lock(mutex_);
    times_[std::string(phase)] += seconds;
}

std::map<std::string, double> Job::times() const {
    const std::scoped_lock lock(mutex_);
    return times_;
}

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

PhaseTimer::PhaseTimer(Job& job, std::string_view phase)
    : job_(job), phase_(phase), start_(now_seconds()) {}

PhaseTimer::~PhaseTimer() {
    job_.add_time(phase_, now_seconds() - start_);
}

}  // namespace gischt
