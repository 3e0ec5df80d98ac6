// SPDX-License-Identifier: Apache-2.0
#include "scene/file_points.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/units.h"
#include "io/ply.h"
#include "scene/file_source.h"

namespace gischt {
namespace {

Particles three_drops() {
    Particles p;
    p.resize(3);
    p.position = {{0, 0, 0}, {1, 0.5, -0.25}, {0.3, 0.3, 0.3}};
    p.velocity = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    p.radius = {0.05f, 0.02f, 0.1f};
    p.id = {4, 5, 6};
    p.life = {2, 2, 2};
    return p;
}

double integral(const Frame& frame) {
    const Field& density = *frame.find("density");
    double sum = 0;
    for (const float v : density.component[0].values()) sum += static_cast<double>(v);
    return sum * std::pow(density.cell_size(), 3);
}

class FilePointsTest : public testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    Job job_;
    std::filesystem::path folder_ = std::filesystem::temp_directory_path() / "gischt_points_test";
};

TEST_F(FilePointsTest, APlyFileIsAFluidOfTheVolumeOfItsDrops) {
    FileParams params;
    params.file = (folder_ / "drops_##.ply").string();
    write_ply_particles((folder_ / "drops_07.ply").string(), three_drops());
    const double drops = (4.0 / 3) * pi * (0.05 * 0.05 * 0.05 + 0.02 * 0.02 * 0.02 + 0.001);
    for (const double cell : {0.0, 0.01, 0.03, 0.5}) {
        params.points.cell_size = cell;
        const Frame frame = read_file_frame(params, 7, job_);
        EXPECT_EQ(frame.particles.at("particles"), three_drops());
        // The radii are floats.
        EXPECT_NEAR(integral(frame) / drops, 1, 1e-5) << cell;
        if (cell > 0) {
            EXPECT_DOUBLE_EQ(frame.find("density")->cell_size(), cell);
        }
    }
    params.points.density = 3;
    EXPECT_NEAR(integral(read_file_frame(params, 7, job_)) / drops, 3, 3e-5);
}

TEST_F(FilePointsTest, AVdbFileKeepsTheFieldsThatItHas) {
    Frame frame;
    frame.particles["drops"] = three_drops();
    FileParams params;
    params.file = (folder_ / "a.vdb").string();
    write_vdb(params.file, frame, {}, job_);
    EXPECT_TRUE(read_file_frame(params, 1, job_).find("density"));  // of the drops

    Field& own = frame.fields["salt"];
    own.component.emplace_back(TileMap::box(Vec3i(8)), 1.0f);
    write_vdb(params.file, frame, {}, job_);
    const Frame back = read_file_frame(params, 1, job_);
    EXPECT_EQ(back.fields.size(), 1u);
    EXPECT_EQ(back.fields.begin()->second.component.size(), 1u);
    EXPECT_EQ(back.particles.at("drops").size(), 3u);
}

TEST_F(FilePointsTest, NoPointsMakeNoFieldsAndOnePointMakesOne) {
    Job job;
    Frame frame;
    frame.particles["drops"];
    splat_file_points({}, frame, job);
    EXPECT_TRUE(frame.fields.empty());
    frame.particles["drops"] = three_drops();
    frame.particles["drops"].resize(1);
    splat_file_points({}, frame, job);
    EXPECT_NEAR(integral(frame) / ((4.0 / 3) * pi * 0.05 * 0.05 * 0.05), 1, 1e-5);
}

TEST_F(FilePointsTest, RefusesWhatHasNoLattice) {
    Frame frame;
    frame.particles["drops"] = three_drops();
    FilePoints tiny;
    tiny.cell_size = 1e-6;
    EXPECT_THROW(splat_file_points(tiny, frame, job_), Error);
    frame.particles["dust"] = three_drops();
    EXPECT_THROW(splat_file_points({}, frame, job_), Error);
    FileParams params;
    params.file = (folder_ / "missing.ply").string();
    EXPECT_THROW(read_file_frame(params, 1, job_), Error);
    std::ofstream(params.file) << "ply\nformat ascii 1.0\nend_header\n";
    EXPECT_THROW(read_file_frame(params, 1, job_), Error);
}

}  // namespace
}  // namespace gischt
