// SPDX-License-Identifier: Apache-2.0
#include "render/progressive.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "base/error.h"
#include "base/parallel.h"

namespace gischt {
namespace {

constexpr int width = 75, height = 40;

// Light whose spread grows from left to right: -log(u), of mean 1 and variance 1, to a power. Stops
// the job after a number of samples.
class TestWorker : public PixelWorker {
  public:
    TestWorker(std::atomic<int>* left, Job& job, double seconds)
        : left_(left), job_(job), seconds_(seconds) {}

    void sample(const PixelSample& at, FilmSample& out, std::span<float> extra) override {
        ++rays;
        const float u = at.numbers.two(PixelSampler::stratified_dimensions).x;
        const float share = static_cast<float>(at.x) / width;
        out.radiance = Vec3f(1 - share * (std::log(1 - u) + 1));  // mean 1, variance share^2
        out.depth = u;
        for (float& e : extra) e += u;
        if (left_ && --*left_ == 0) job_.cancel();
        if (seconds_ > 0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds_));
    }

  private:
    std::atomic<int>* left_;
    Job& job_;
    double seconds_;
};

RenderResult make(RenderSettings settings, FilmState* film = nullptr, int stop_after = 0,
                  double seconds = 0) {
    View view;
    view.camera = Camera({}, 0, width, height);
    settings.film = film;
    std::atomic<int> left{stop_after};
    Job job;
    ProgressiveTask task;
    task.method = "test";
    task.layout.channels = {"direct.R"};
    task.layout.variance = task.layout.samples = true;
    task.make_worker = [&] {
        return std::make_unique<TestWorker>(stop_after > 0 ? &left : nullptr, job, seconds);
    };
    return render_progressively(view, settings, task, job);
}

TEST(Progressive, ThreadsSplitsAndInterruptionsGiveTheSameBits) {
    for (const double noise : {0.0, 0.06}) {
        RenderSettings settings;
        settings.samples_per_pixel = 50;
        settings.noise = noise;
        const RenderResult whole = make(settings);
        {
            const ThreadLimit one(1);
            EXPECT_EQ(make(settings).image, whole.image);
        }
        // Stopped in the middle of everything, again and again, and gone on with.
        FilmState film;
        int stops = 0;
        for (int stop : {1, 700, 2999, 3000, 31'007, 50'000}) {
            try {
                make(settings, &film, stop);
            } catch (const Error& e) {
                EXPECT_EQ(e.kind(), ErrorKind::Cancelled);
                ++stops;
            }
        }
        EXPECT_GE(stops, 5);
        EXPECT_EQ(make(settings, &film).image, whole.image) << noise;
        // Done is done.
        const RenderResult again = make(settings, &film);
        EXPECT_EQ(again.image, whole.image);
        EXPECT_EQ(again.statistics.rays, 0);
    }
}

TEST(Progressive, PartsOfTheSamplesMergeToTheSameBits) {
    RenderSettings settings;
    settings.samples_per_pixel = 24;
    FilmState whole, sum;
    make(settings, &whole);
    settings.samples_per_pixel = 8;
    for (const int first : {8, 0, 16}) {
        settings.first_sample = first;
        FilmState part;
        make(settings, &part);
        if (sum.film)
            sum.merge(part);
        else
            sum = std::move(part);
    }
    EXPECT_EQ(sum.ranges, whole.ranges);
    EXPECT_EQ(sum.image(), whole.image());
    // The sum is as good as one run's: it can be gone on with.
    settings = {};
    settings.samples_per_pixel = 30;
    EXPECT_EQ(make(settings, &sum).image, make(settings).image);
    // Half of them later, by another run.
    settings = {};
    settings.samples_per_pixel = 10;
    FilmState grown;
    make(settings, &grown);
    settings.samples_per_pixel = 24;
    make(settings, &grown);
    EXPECT_EQ(grown.image(), whole.image());
}

TEST(Progressive, RefusesAFilmThatItCannotGoOnWith) {
    RenderSettings settings;
    settings.samples_per_pixel = 4;
    FilmState film;
    make(settings, &film);
    RenderSettings fewer = settings, filter = settings, later = settings;
    fewer.samples_per_pixel = 2;
    filter.filter = FilterKind::Box;
    later.first_sample = 2;
    for (const RenderSettings& other : {fewer, filter, later}) {
        EXPECT_THROW(make(other, &film), Error);
    }
}

TEST(Progressive, KeepsItsTimeAndShowsAWholePicture) {
    RenderSettings settings;
    settings.samples_per_pixel = 1 << 20;
    settings.time_limit = 0.4;
    settings.partial_interval = 0.1;
    int partials = 0, checkpoints = 0;
    settings.on_partial = [&](const Image& image) {
        ++partials;
        EXPECT_EQ(image.width, width);
    };
    settings.checkpoint_interval = 0.15;
    FilmState film;
    settings.on_checkpoint = [&] {
        ++checkpoints;
        EXPECT_EQ(film.ranges.size(), 1u);
    };
    const RenderResult result = make(settings, &film, 0, 5e-6);
    EXPECT_LT(result.statistics.wall_seconds, 1.0);
    EXPECT_GE(partials, 2);
    EXPECT_GE(checkpoints, 1);
    for (const float n : result.image.channel("samples.Y")) EXPECT_GE(n, 1);
}

// Before its first pass is over, a picture is coarse but whole.
TEST(Progressive, ShortTimeGivesACoarsePicture) {
    RenderSettings settings;
    settings.samples_per_pixel = 4;
    settings.time_limit = 0.05;
    FilmState film;
    const RenderResult coarse = make(settings, &film, 0, 2e-3);
    EXPECT_LT(coarse.statistics.samples_per_pixel, 0.5);
    EXPECT_GE(coarse.statistics.samples_per_pixel, 1.0 / 64);
    double sum = 0;
    for (const float depth : coarse.image.channel("Z")) {
        EXPECT_GT(depth, 0);  // every pixel shows a sample
        sum += static_cast<double>(depth);
    }
    // Of evenly distributed numbers; at least 50 independent ones.
    EXPECT_NEAR(sum / (width * height), 0.5, 4 * std::sqrt(1.0 / 12 / 50));

    settings.time_limit = 0;
    const RenderResult rest = make(settings, &film);
    FilmState other;
    EXPECT_EQ(rest.image.planes[0].values, make(settings, &other).image.planes[0].values);
}

TEST(Progressive, NoiseStopsWithoutAdaptionToo) {
    RenderSettings settings;
    settings.samples_per_pixel = 4096;
    settings.noise = 0.05;
    settings.adaptive = false;
    const RenderResult result = make(settings);
    EXPECT_LE(result.statistics.noise, 0.05);
    // The mean variance is that of share^2, 1/3: 133 samples, and at most a quarter more.
    EXPECT_GE(result.statistics.samples_per_pixel, 125);
    EXPECT_LE(result.statistics.samples_per_pixel, 170);
}

// Each tile gets samples in proportion to its variance; the picture is as good as asked for, with
// fewer samples than evenly spread ones (a third of the largest variance, here); and its mean stays
// the true one: over 16 seeds at 4 standard errors, where 0.1 % of bias would be seen.
TEST(Progressive, AdaptiveSamplingGoesWhereTheNoiseIs) {
    RenderSettings settings;
    settings.samples_per_pixel = 4096;
    settings.noise = 0.05;
    double sum = 0, squares = 0, weighted = 0;
    const int seeds = 16;
    for (int seed = 0; seed < seeds; ++seed) {
        settings.seed = static_cast<std::uint64_t>(seed);
        const RenderResult result = make(settings);
        EXPECT_LE(result.statistics.noise, settings.noise);
        const auto samples = result.image.channel("samples.Y");
        EXPECT_LT(samples[0], 60);
        EXPECT_GT(samples[width - 1], 250);
        double mean = 0;
        for (const float v : result.image.channel("G")) mean += static_cast<double>(v);
        mean /= width * height;
        sum += mean;
        squares += mean * mean;
        weighted += result.statistics.samples_per_pixel;
    }
    const double mean = sum / seeds;
    const double error = std::sqrt((squares / seeds - mean * mean) / (seeds - 1));
    EXPECT_LT(error, 0.00025);
    EXPECT_NEAR(mean, 1, 4 * error);
    EXPECT_LT(weighted / seeds, 250);
}

}  // namespace
}  // namespace gischt
