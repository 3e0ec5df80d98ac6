// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/parallel.h"
#include "io/file_bytes.h"
#include "io/test_files.h"
#include "io/vdb.h"

namespace gischt {
namespace {

// Ids ascend, as the reader has them.
Particles drops(std::size_t count, bool has_looks) {
    Particles p;
    if (has_looks) {
        p.color.resize(1);
        p.opacity.resize(1);
        p.temperature.resize(1);
    }
    p.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t key = random_key(6, i);
        const auto u = [&](std::uint32_t d) { return random_uniform(key, d); };
        p.position[i] = 3.0 * Vec3d(u(0), u(1), u(2)) - Vec3d(1);
        p.velocity[i] = {u(3), -u(4), 5 * u(5)};
        p.age[i] = u(6);
        p.life[i] = 1 + u(7);
        p.radius[i] = u(8) / 100;
        p.id[i] = (std::uint64_t{3} << 40) + 2 * i;
        if (!has_looks) continue;
        p.color[i] = {u(9), u(10), u(11)};
        p.opacity[i] = u(12);
        p.temperature[i] = 1000 * u(13);
    }
    return p;
}

Frame frame_of(std::size_t count, bool has_looks) {
    Frame frame;
    Field& field = frame.fields["density"];
    field.component.emplace_back(TileMap::box(Vec3i(8)), 1.0f);
    field.to_world = Transform::scale_translate(0.25, {});
    frame.particles["particles"] = drops(count, has_looks);
    return frame;
}

TEST(VdbPoints, KeepAllButTheLastBitsOfPositions) {
    const TestFolder folder("vdb_points");
    Job job;
    for (const bool has_looks : {false, true}) {
        const Frame frame = frame_of(5000, has_looks);
        write_vdb(folder.file("a.vdb"), frame, {}, job);
        const Frame back = read_vdb(folder.file("a.vdb"), {}, job);
        EXPECT_EQ(back.fields.size(), 1u);
        ASSERT_EQ(back.particles.size(), 1u);
        Particles got = back.particles.at("particles");
        const Particles& given = frame.particles.at("particles");
        ASSERT_EQ(got.size(), given.size());
        for (std::size_t i = 0; i < got.size(); ++i) {
            // Half a voxel in 32-bit floats.
            EXPECT_LT(length(got.position[i] - given.position[i]), 0.25 * 1e-7);
        }
        got.position = given.position;
        EXPECT_EQ(got, given);
    }
}

TEST(VdbPoints, SameBytesOnAnyNumberOfThreadsAndNoneAtAll) {
    const TestFolder folder("vdb_points_bytes");
    Job job;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        write_vdb(folder.file(std::to_string(threads)), frame_of(20000, true), {}, job);
    }
    EXPECT_EQ(read_bytes(folder.file("1")), read_bytes(folder.file("2")));
    write_vdb(folder.file("none.vdb"), frame_of(0, false), {}, job);
    EXPECT_TRUE(read_vdb(folder.file("none.vdb"), {}, job).particles.at("particles").is_empty());
}

TEST(VdbPoints, AreListedWithTheirAttributes) {
    const TestFolder folder("vdb_points_listed");
    Job job;
    write_vdb(folder.file("a.vdb"), frame_of(321, true), {}, job);
    const VdbInfo info = list_vdb(folder.file("a.vdb"), job);
    const auto found = std::ranges::find(info.grids, "particles", &VdbGridInfo::name);
    ASSERT_NE(found, info.grids.end());
    EXPECT_EQ(found->points, 321);
    EXPECT_TRUE(found->is_readable);
    const std::vector<std::string> names{"Alpha", "Cd",     "age",         "id",
                                         "life",  "pscale", "temperature", "v"};
    EXPECT_EQ(found->attributes, names);
}

// Another program's file, as far as a reader can tell: the same content under a UUID of its own.
TEST(VdbPoints, OfOthersAreReadWhereThatIsAsked) {
    const TestFolder folder("vdb_points_foreign");
    Job job;
    const std::string path = folder.file("a.vdb");
    write_vdb(path, frame_of(500, true), {}, job);
    VdbReadOptions options;
    const Particles own = read_vdb(path, options, job).particles.at("particles");
    std::string bytes = read_bytes(path);
    bytes.replace(21, 8, bytes.substr(21, 8) == "00000000" ? "11111111" : "00000000");
    put(path, bytes);
    EXPECT_TRUE(read_vdb(path, options, job).particles.empty());
    EXPECT_EQ(list_vdb(path, job).grids.back().points, -1);
    options.foreign_points = true;
    EXPECT_EQ(read_vdb(path, options, job).particles.at("particles"), own);
}

// What somebody changed is not given to the library: left out with a warning, or refused.
TEST(VdbPoints, AreNotReadFromAlteredFiles) {
    const TestFolder folder("vdb_points_altered");
    Job job;
    const std::string path = folder.file("a.vdb");
    write_vdb(path, frame_of(300, true), {}, job);
    const std::string bytes = read_bytes(path);
    for_broken_files(path, bytes, [&](const std::string& file, bool must_fail) {
        Frame frame;
        const Outcome o = outcome([&] { frame = read_vdb(file, {}, job); });
        EXPECT_TRUE(o == Outcome::Input || (o == Outcome::Fine && !must_fail));
        const bool is_altered =
            std::filesystem::file_size(file) != bytes.size() || read_bytes(file) != bytes;
        EXPECT_EQ(frame.particles.empty(), is_altered || o != Outcome::Fine);
    });
}

}  // namespace
}  // namespace gischt
