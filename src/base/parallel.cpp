// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

namespace gischt {

struct ThreadLimit::Impl {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
    const int n = threads > 0 ? threads : tbb::info::default_concurrency();
    impl_.reset(new Impl{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                             static_cast<std::size_t>(n))});
}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

double tree_sum(std::span<const double> terms) {
    if (terms.empty()) return 0;
    if (terms.size() <= 8) {
        double sum = terms[0];
        for (std::size_t i = 1; i < terms.size(); ++i) sum += terms[i];
        return sum;
    }
    const std::size_t half = terms.size() / 2;
    return tree_sum(terms.first(half)) + tree_sum(terms.subspan(half));
}

}  // namespace gischt
