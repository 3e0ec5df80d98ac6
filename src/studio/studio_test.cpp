// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "studio/estimate.h"
#include "studio/production.h"

namespace gischt {
namespace {
namespace fs = std::filesystem;

// A folder of its own for each test.
class Studio : public testing::Test {
  protected:
    Studio()
        : folder(fs::temp_directory_path() /
                 ("gischt_" +
                  std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
        fs::remove_all(folder);
    }
    ~Studio() override { fs::remove_all(folder); }

    static LoadedScene plume() { return load_scene("plume", "", {"domain.resolution=24"}); }
    std::string bytes(const std::string& name) const {
        std::ifstream in(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    Order order(int last) const {
        Order o;
        o.frames = {1, last, 1};
        o.cache = folder;
        return o;
    }

    fs::path folder;
};

TEST(FrameRange, ReadsItsFormsAndNothingElse) {
    EXPECT_EQ(parse_frame_range("3"), (FrameRange{3, 3, 1}));
    EXPECT_EQ(parse_frame_range("3-9"), (FrameRange{3, 9, 1}));
    EXPECT_EQ(parse_frame_range("3-9x2"), (FrameRange{3, 9, 2}));
    EXPECT_EQ(parse_frame_range("3-9x2").count(), 4);
    EXPECT_EQ(parse_frame_range("3-8x2").count(), 3);
    for (const char* bad :
         {"", "a", "3-", "9-3", "3-9x0", "3-9x", "3 ", "-3", "99999999999", "0-2147483647"}) {
        EXPECT_THROW(parse_frame_range(bad), Error) << bad;
    }
    EXPECT_EQ(frame_path("a/b.png", 12), fs::path("a/b_0012.png"));
}

TEST_F(Studio, CacheIsUsedAndBelongsToItsMotion) {
    Job job;
    RunStatistics run;
    const LoadedScene scene = plume();
    simulate(scene, order(2), run, job);
    EXPECT_EQ(run.frames.size(), 2u);
    EXPECT_TRUE(is_cache(folder));
    EXPECT_EQ(cache_name(folder), "plume");
    simulate(scene, order(3), run, job);
    EXPECT_EQ(run.frames.size(), 3u);
    const LoadedScene other = load_scene("plume", "", {"domain.resolution=32"});
    EXPECT_THROW(simulate(other, order(1), run, job), Error);
    Order restart = order(1);
    restart.restart = true;
    simulate(other, restart, run, job);
    EXPECT_FALSE(fs::exists(folder / "smoke_0002.vdb"));
}

TEST_F(Studio, AFrameThatWasRemovedComesAgainWithTheSameBytes) {
    Job job;
    RunStatistics run;
    const LoadedScene scene = plume();
    simulate(scene, order(4), run, job);
    const std::string before = bytes("smoke_0002.vdb");
    fs::remove(folder / "smoke_0002.vdb");
    simulate(scene, order(4), run, job);
    EXPECT_EQ(bytes("smoke_0002.vdb"), before);
}

TEST_F(Studio, ASimulationGoesOnFromItsState) {
    Job job;
    RunStatistics run;
    simulate(plume(), order(3), run, job);
    ASSERT_TRUE(fs::exists(folder / "smoke.state"));
    simulate(plume(), order(5), run, job);
    EXPECT_EQ(run.frames.size(), 5u) << "frames 4 and 5 only";
    const std::string resumed = bytes("smoke_0005.vdb");
    Order again = order(5);
    again.restart = true;
    simulate(plume(), again, run, job);
    EXPECT_EQ(bytes("smoke_0005.vdb"), resumed);
}

TEST_F(Studio, RenderRefusesFormatsItDoesNotKnowBeforeTheWork) {
    Job job;
    RunStatistics run;
    Order o = order(1);
    o.outputs = {"x.jpg"};
    EXPECT_THROW(render(plume(), o, run, job), Error);
    EXPECT_TRUE(run.frames.empty());
}

TEST(Estimate, GrowsWithTheCells) {
    const auto small = estimate_fluids(load_scene("plume", "", {"domain.resolution=64"}).scene);
    const auto large = estimate_fluids(load_scene("plume", "", {"domain.resolution=128"}).scene);
    EXPECT_EQ(small[0].cells, Vec3i(40, 40, 64));
    EXPECT_NEAR(large[0].memory / small[0].memory, 8, 0.01);
    // A field for density, three for the wind.
    const auto fog = estimate_fluids(load_scene("fogbank", "", {}).scene);
    EXPECT_EQ(fog.at(0).cells, Vec3i(197, 210, 24));
    EXPECT_DOUBLE_EQ(fog.at(0).memory, 4.0 * 4 * 197 * 210 * 24);
    EXPECT_THROW(estimate_fluids(load_scene("cloud", "", {"fluid.file=/nowhere.vdb"}).scene),
                 Error);
}

}  // namespace
}  // namespace gischt
