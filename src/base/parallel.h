// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#if defined(__SANITIZE_THREAD__)
#define GISCHT_TSAN
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define GISCHT_TSAN
#endif
#endif
#ifdef GISCHT_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace gischt {

// Limits the threads of every parallel loop while it lives. 0 means all cores.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Threads that parallel loops use now.
int thread_count();

// What ThreadSanitizer cannot see, as TBB's library is built without it: the parts of a loop come
// after what was before it, and what follows comes after all of them. Nothing in other builds.
class LoopOrder {
#ifdef GISCHT_TSAN
  public:
    LoopOrder() {
        __tsan_release(&before_);
    }
    void begin_part() {
        __tsan_acquire(&before_);
    }
    void end_part() {
        __tsan_release(&after_);
    }
    void end_loop() {
        __tsan_acquire(&after_);
    }

  private:
    char before_ = 0, after_ = 0;
#else
  public:
    void begin_part() {}
    void end_part() {}
    void end_loop() {}
#endif
};

// Calls f(begin, end) for parts of [0, count): for loops that keep scratch memory per part.
template <class F>
void parallel_ranges(int count, int grain, F&& f) {
    LoopOrder order;
    tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
                      [&](const tbb::blocked_range<int>& range) {
                          order.begin_part();
                          f(range.begin(), range.end());
                          order.end_part();
                      });
    order.end_loop();
}

// Calls f(i) for i in [0, count) in any order on all threads, `grain` indices at a time.
template <class F>
void parallel_for(int count, int grain, F&& f) {
    parallel_ranges(count, grain, [&](int begin, int end) {
        for (int i = begin; i != end; ++i) f(i);
    });
}

// Sum over a fixed binary tree: the same bits however the terms came about and on any number of
// threads.
double tree_sum(std::span<const double> terms);

// Sum of f(i), i in [0, count): f's results are stored and added by tree_sum.
template <class F>
double parallel_sum(int count, int grain, F&& f) {
    std::vector<double> terms(static_cast<std::size_t>(count));
    parallel_for(count, grain, [&](int i) { terms[static_cast<std::size_t>(i)] = f(i); });
    return tree_sum(terms);
}

// Largest of f(i), i in [0, count), and of 0.
template <class F>
double parallel_max(int count, int grain, F&& f) {
    std::vector<double> terms(static_cast<std::size_t>(count));
    parallel_for(count, grain, [&](int i) { terms[static_cast<std::size_t>(i)] = f(i); });
    double largest = 0;
    for (const double t : terms) largest = std::max(largest, t);
    return largest;
}

}  // namespace gischt
