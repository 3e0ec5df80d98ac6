// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

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

// Calls f(i) for i in [0, count) in any order on all threads, `grain` indices at a time.
template <class F>
void parallel_for(int count, int grain, F&& f) {
    tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int i = range.begin(); i != range.end(); ++i) f(i);
                      });
}

// Calls f(begin, end) for parts of [0, count): for loops that keep scratch memory per part.
template <class F>
void parallel_ranges(int count, int grain, F&& f) {
    tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
                      [&](const tbb::blocked_range<int>& range) { f(range.begin(), range.end()); });
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
