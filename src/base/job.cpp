// SPDX-License-Identifier: Apache-2.0
#include "base/job.h"

#include <chrono>

#include "base/error.h"

namespace gischt {

void Job::progress(double fraction, std::string_view phase) {
    const std::scoped_lock lock(mutex_);
    if (!on_progress) return;
    const std::string name =
        part_name_.empty() ? std::string(phase) : part_name_ + ": " + std::string(phase);
    on_progress(part_begin_ + fraction * (part_end_ - part_begin_), name);
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

JobPart::JobPart(Job& job, double begin, double end, std::string_view name)
    : job_(job), begin_(job.part_begin_), end_(job.part_end_), name_(job.part_name_) {
    const std::scoped_lock lock(job.mutex_);
    job.part_begin_ = begin_ + begin * (end_ - begin_);
    job.part_end_ = begin_ + end * (end_ - begin_);
    if (!name.empty())
        job.part_name_ = name_.empty() ? std::string(name) : name_ + ", " + std::string(name);
}

JobPart::~JobPart() {
    const std::scoped_lock lock(job_.mutex_);
    job_.part_begin_ = begin_;
    job_.part_end_ = end_;
    job_.part_name_ = name_;
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
