// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "base/error.h"
#include "base/hash.h"
#include "base/job.h"
#include "base/parallel.h"
#include "base/random.h"

namespace gischt {
namespace {

TEST(Error, NamesPlaceFactAndMend) {
    const Error e(ErrorKind::Usage, "a.toml:3:1", "unknown key 'x'", "did you mean 'y'?");
    EXPECT_STREQ(e.what(), "a.toml:3:1: unknown key 'x'; did you mean 'y'?");
}

TEST(NearestWord, FindsSlipsOfTheFingerAndNothingElse) {
    const std::vector<std::string> words{"buoyancy", "vorticity", "gravity"};
    EXPECT_EQ(nearest_word("bouyancy", words), "buoyancy");
    EXPECT_EQ(nearest_word("gravty", words), "gravity");
    EXPECT_EQ(nearest_word("zzz", words), "");
}

TEST(TreeSum, DoesNotDependOnThreads) {
    auto sum = [](int threads) {
        const ThreadLimit limit(threads);
        return parallel_sum(100003, 7, [](int i) { return 1.0 / (1.0 + i); });
    };
    EXPECT_EQ(sum(1), sum(2));
}

TEST(Job, CancelStopsAtTheNextCheck) {
    Job job;
    job.check();
    job.cancel();
    EXPECT_THROW(job.check(), Error);
}

TEST(JobPart, MapsTheProgressOfAPartIntoTheWhole) {
    Job job;
    double last = -1;
    std::string name;
    job.on_progress = [&](double f, std::string_view phase) { last = f, name = phase; };
    {
        const JobPart outer(job, 0.5, 1, "frame 2");
        const JobPart inner(job, 0, 0.5, "");
        job.progress(0.5, "render");
    }
    EXPECT_DOUBLE_EQ(last, 0.625);
    EXPECT_EQ(name, "frame 2: render");
    job.progress(0.5, "x");
    EXPECT_DOUBLE_EQ(last, 0.5);
}

// Chi-squared over 64 bins of 2^16 numbers: 63 degrees of freedom, 99.99 % quantile 113.
TEST(Random, IsUniformAlongKeysAndDimensions) {
    for (const bool by_key : {true, false}) {
        std::vector<int> bins(64);
        for (std::uint32_t i = 0; i < 65536; ++i) {
            const float u =
                by_key ? random_uniform(random_key(1, i), 0) : random_uniform(random_key(1), i);
            ASSERT_TRUE(u >= 0 && u < 1);
            ++bins[static_cast<std::size_t>(u * 64)];
        }
        double chi2 = 0;
        for (const int n : bins) chi2 += (n - 1024.0) * (n - 1024.0) / 1024.0;
        EXPECT_LT(chi2, 113);
    }
}

TEST(Hash, MeetsThePublishedFnvVector) {
    EXPECT_EQ(hex(hash_bytes("a")), "af63dc4c8601ec8c");
}

}  // namespace
}  // namespace gischt
