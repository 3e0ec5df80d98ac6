// SPDX-License-Identifier: Apache-2.0
#include "studio/ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "io/image_file.h"

namespace gischt {
namespace {
namespace fs = std::filesystem;

std::vector<std::string> labels(const std::vector<LadderRung>& rungs) {
    std::vector<std::string> out;
    for (const LadderRung& r : rungs) out.push_back(r.label);
    return out;
}

TEST(Ladder, HasTheMarchAtItsDepths) {
    EXPECT_EQ(labels(ladder_rungs({"march", "path"}, 2)),
              (std::vector<std::string>{"march, depth 1", "march, depth 2", "path"}));
    EXPECT_EQ(labels(ladder_rungs({"march"}, 100)).back(), "march, depth 8");
    for (const LadderRung& r : ladder_rungs({}, 3)) EXPECT_NE(r.method, "field");
    EXPECT_THROW(ladder_rungs({"field"}, 3), Error);
    EXPECT_THROW(ladder_rungs({"marsh"}, 3), Error);
}

TEST(Ladder, ComparesWritesAndTellsWhatWasRefused) {
    const fs::path folder = fs::temp_directory_path() / "gischt_ladder_test";
    fs::remove_all(folder);
    const LoadedScene scene =
        load_scene("cloud", "",
                   {"fluid.resolution=24", "film.width=48", "film.height=27", "render.spp=4",
                    "render.depth=2", "fluid.medium.multiple_scattering.octaves=0"});
    LadderOrder order;
    order.frames = {1, 1, 1};
    order.methods = {"points", "march", "path"};
    order.reference_samples = 32;
    order.folder = folder;
    RunStatistics run;
    Job job;
    const Ladder ladder = render_ladder(scene, order, run, job);
    ASSERT_EQ(ladder.steps.size(), 4u);
    EXPECT_FALSE(ladder.steps[0].refusal.empty());  // there are no particles
    const Comparison &once = ladder.steps[1].difference, &twice = ladder.steps[2].difference,
                     &path = ladder.steps[3].difference;
    // Light that is scattered twice is missing from the first march, and noise alone from the rest.
    EXPECT_LT(once.ratio, 0.99);
    EXPECT_NEAR(twice.ratio, 1, 0.03);
    EXPECT_NEAR(path.ratio, 1, 0.03);

    const auto written = write_ladder(scene, order, ladder, run);
    for (const std::string& file : written) EXPECT_TRUE(fs::exists(file)) << file;
    EXPECT_EQ(run.images.size(), 3u);
    // Files hold half floats.
    const Image read = read_image((folder / "path.exr").string());
    EXPECT_LT(compare(read, ladder.steps[3].image).rmse, 1e-3 * path.mean_b);
    std::ifstream in(folder / "ladder.md");
    const std::string table{std::istreambuf_iterator<char>(in), {}};
    for (const char* part : {"| march, depth 2 | 4 |", "- `points`: ", "32 samples per pixel"})
        EXPECT_NE(table.find(part), std::string::npos) << part;
    // A reference that was rendered before, and one of another size.
    order.methods = {"path"};
    order.reference = (folder / "reference.exr").string();
    const Ladder again = render_ladder(scene, order, run, job);
    EXPECT_NEAR(again.steps[0].difference.rmse, path.rmse, 1e-6);
    order.reference = (folder / "ladder.png").string();
    EXPECT_THROW(render_ladder(scene, order, run, job), Error);
    fs::remove_all(folder);
}

// The signs of the colours: too dark is blue, too bright red, equal is grey.
TEST(Ladder, DifferencesHaveTheirColours) {
    Image a = Image::rgb(3, 1), b = a;
    for (const auto plane : b.color()) std::ranges::fill(plane, 1.0f);
    const float values[] = {0, 1, 2};
    for (const auto plane : a.color()) std::ranges::copy(values, plane.begin());
    const Image d = difference_image(a, b);
    const auto c = d.color();
    EXPECT_GT(c[2][0], 2 * c[0][0]);
    EXPECT_NEAR(c[2][1], c[0][1], 0.02);
    EXPECT_GT(c[0][2], 2 * c[2][2]);
}

}  // namespace
}  // namespace gischt
