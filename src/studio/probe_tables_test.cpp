// SPDX-License-Identifier: Apache-2.0
#include "studio/probe_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "schema/toml.h"
#include "studio/production.h"

namespace gischt {
namespace {
namespace fs = std::filesystem;

constexpr const char* small_plume = R"(
gravity = [0, -9.8, 0]
fps = 20
frames = [1, 6]
[fluid]
name = "smoke"
type = "smoke"
min_substeps = 2
[fluid.domain]
resolution = 24
max = [1, 1, 0]
y_min = "free_slip"
[[fluid.source]]
position = [0.5, 0.2, 0]
radius = 0.1
density = 1
temperature = 500
)";
constexpr const char* probes = R"(
[[probe]]
name = "energy"
type = "energy"
every = "step"
[[probe]]
name = "row"
type = "line"
from = [0.1, 0.5, 0]
to = [0.9, 0.5, 0]
count = 7
start = 0.1
mean = true
[[probe]]
name = "top"
type = "front"
direction = [0, 1, 0]
threshold = 0.3
)";

LoadedScene scene_of(const std::string& text) {
    return load_scene_tree("small", parse_toml(text, "small.toml"), "", {});
}

class ProbeFiles : public testing::Test {
  protected:
    ProbeFiles()
        : folder(fs::temp_directory_path() /
                 ("gischt_probe_" +
                  std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
        fs::remove_all(folder);
        job.on_message = [this](Job::Level, std::string_view text) { messages.emplace_back(text); };
    }
    ~ProbeFiles() override { fs::remove_all(folder); }

    void run(const LoadedScene& scene, int first, int last, const char* cache,
             bool restart = false) {
        Order order;
        order.frames = {first, last, 1};
        order.cache = folder / cache;
        order.restart = restart;
        RunStatistics statistics;
        simulate(scene, order, statistics, job);
    }
    std::string table(const char* cache, const char* name) const {
        std::ifstream in(folder / cache / "probes" / (std::string(name) + ".csv"));
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void expect_same(const char* a, const char* b) const {
        for (const char* name : {"energy", "row", "row_mean", "top"}) {
            EXPECT_FALSE(table(a, name).empty());
            EXPECT_EQ(table(a, name), table(b, name)) << name;
        }
    }

    fs::path folder;
    Job job;
    std::vector<std::string> messages;
};

TEST(Csv, KeepsEveryBit) {
    const std::vector<std::string> columns{"time [s]", "x [m]"};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<ProbeRow> rows{{0, 0.1}, {1.0 / 3, -1e-300}, {0.5, nan}, {2e9, 1.0 / 7}};
    const std::string text = to_csv(columns, rows);
    EXPECT_EQ(text.substr(0, text.find('\n')), "time [s],x [m]");
    const auto back = rows_of_csv(text, columns, "x.csv");
    ASSERT_EQ(back.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(back[i][0], rows[i][0]);
        EXPECT_TRUE(back[i][1] == rows[i][1] || std::isnan(rows[i][1]));
    }
    EXPECT_EQ(to_csv(columns, back), text);
    for (const char* bad :
         {"", "time [s]\n0\n", "time [s],x [m]\n1\n", "time [s],x [m]\n1,2,3\n",
          "time [s],x [m]\n1,a\n", "time [s],x [m]\n1,2x\n", "time [s],x [m]\n1,\n",
          "time [s],x [m]\n2,0\n1,0\n", "time [s],x [m]\n\n"}) {
        EXPECT_THROW(rows_of_csv(bad, columns, "x.csv"), Error) << bad;
    }
}

TEST(Csv, MeansAreIntegralsOverTime) {
    // t^2 and 3 t at uneven times, in two places.
    std::vector<ProbeRow> rows;
    for (const double t : {1.0, 1.5, 1.75, 3.0}) {
        rows.push_back({t, 0.0, 3 * t});
        rows.push_back({t, 1.0, 5.0});
    }
    const auto mean = mean_over_time(rows);
    ASSERT_EQ(mean.size(), 2u);
    EXPECT_EQ(mean[0][0], 3);
    EXPECT_NEAR(mean[0][2], 6, 1e-12) << "the trapezoidal rule is exact for lines";
    EXPECT_NEAR(mean[1][1], 1, 1e-12);
    EXPECT_NEAR(mean[1][2], 5, 1e-12);
    EXPECT_EQ(mean_over_time({{2, 7}}), (std::vector<ProbeRow>{{2, 7}}));
    EXPECT_TRUE(mean_over_time({}).empty());
}

TEST_F(ProbeFiles, ResumedTablesHaveTheBytesOfOneRun) {
    const LoadedScene scene = scene_of(std::string(small_plume) + probes);
    run(scene, 1, 6, "whole");
    run(scene, 1, 2, "parts");
    run(scene, 3, 6, "parts");
    expect_same("whole", "parts");
    // A state that lies behind the tables, as after a crash, and a frame that was removed.
    run(scene, 1, 3, "behind");
    const fs::path state = folder / "behind/smoke.state", kept = folder / "kept.state";
    fs::copy_file(state, kept);
    run(scene, 4, 6, "behind");
    fs::remove(state);
    fs::copy_file(kept, state);
    for (const char* name : {"smoke_0004.vdb", "smoke_0005.vdb", "smoke_0006.vdb"}) {
        fs::remove(folder / "behind" / name);
    }
    run(scene, 1, 6, "behind");
    expect_same("whole", "behind");
    fs::remove(folder / "behind/smoke_0002.vdb");
    run(scene, 1, 6, "behind");
    expect_same("whole", "behind");
    EXPECT_TRUE(messages.empty()) << messages.front();
    // 1 + 6 x 2 steps; the front is not there in the beginning.
    const std::string energy = table("whole", "energy"), top = table("whole", "top");
    EXPECT_EQ(std::count(energy.begin(), energy.end(), '\n'), 1 + 13);
    EXPECT_NE(top.find("0,nan\n"), std::string::npos);
}

TEST_F(ProbeFiles, FramesOfTheCacheAreNotMeasuredLater) {
    const LoadedScene bare = scene_of(small_plume),
                      probed = scene_of(std::string(small_plume) + probes);
    EXPECT_EQ(bare.motion_hash, probed.motion_hash) << "probes change no frame";
    EXPECT_EQ(bare.picture_hash, probed.picture_hash);
    run(bare, 1, 3, "cache");
    run(probed, 1, 5, "cache");
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("energy, top"), std::string::npos) << messages[0];
    const std::string energy = table("cache", "energy");
    EXPECT_EQ(std::count(energy.begin(), energy.end(), '\n'), 1 + 4) << "frames 4 and 5";
    run(probed, 1, 5, "cache", true);
    run(probed, 1, 5, "whole");
    expect_same("cache", "whole");
}

TEST_F(ProbeFiles, TablesOfAnotherProbeAreDropped) {
    const std::string scene = std::string(small_plume) + probes;
    run(scene_of(scene), 1, 2, "cache");
    std::string other = scene;
    other.replace(other.find("threshold = 0.3"), 15, "threshold = 0.6");
    run(scene_of(other), 1, 3, "cache");
    const std::string top = table("cache", "top"), energy = table("cache", "energy");
    EXPECT_EQ(std::count(top.begin(), top.end(), '\n'), 1 + 1) << "frame 3 only";
    EXPECT_EQ(std::count(energy.begin(), energy.end(), '\n'), 1 + 7) << "kept";
    EXPECT_EQ(messages.size(), 1u);
    std::ofstream(folder / "cache/probes/top.csv") << "nonsense\n";
    EXPECT_THROW(run(scene_of(other), 1, 4, "cache"), Error);
}

TEST(ProbeScene, IsRefusedWithAReason) {
    const auto with = [](const std::string& probe) {
        return scene_of(std::string(small_plume) + "[[probe]]\n" + probe);
    };
    EXPECT_NO_THROW(with("name = \"a\"\ntype = \"mass\"\n"));
    for (const char* bad : {
             "type = \"mass\"\n",
             "name = \"a/b\"\ntype = \"mass\"\n",
             "name = \"a\"\ntype = \"masse\"\n",
             "name = \"a\"\ntype = \"mass\"\nfluid = \"b\"\n",
             "name = \"a\"\ntype = \"point\"\npoints = [[0.5, 1.2, 0]]\n",
             "name = \"a\"\ntype = \"point\"\npoints = []\n",
             "name = \"a\"\ntype = \"force\"\nsolid = \"ball\"\n",
             "name = \"a\"\ntype = \"mass\"\nstart = 2\nstop = 1\n",
             "name = \"a\"\ntype = \"mass\"\nmin = [0, 0, 0]\n",
             "name = \"a\"\ntype = \"mass\"\nmean = true\n[[probe]]\nname = \"a_mean\"\ntype = "
             "\"mass\"\n",
             "name = \"a\"\ntype = \"mass\"\n[[probe]]\nname = \"a\"\ntype = \"mass\"\n",
             "name = \"a\"\ntype = \"heat_flux\"\nlength = 1\n",
         }) {
        EXPECT_THROW(with(bad), Error) << bad;
    }
    EXPECT_THROW(scene_of("[fluid]\ntype = \"cloud\"\n[[probe]]\nname = \"a\"\ntype = \"mass\"\n"),
                 Error);
}

}  // namespace
}  // namespace gischt
