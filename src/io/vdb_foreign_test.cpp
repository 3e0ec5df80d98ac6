// SPDX-License-Identifier: Apache-2.0
// Files as other programs write them, made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/vdb.h"
#include "io/vdb_test_files.h"

namespace gischt {

namespace {

Frame read_text(const std::string& bytes, Listener& listener, const VdbReadOptions& options = {}) {
    const TestFolder folder("vdb_foreign");
    put(folder.file("smoke_0042.vdb"), bytes);
    return read_vdb(folder.file("smoke_0042.vdb"), options, listener.job);
}

template <class T>
float cell_number(int i, int j, int k) {
    return static_cast<float>(static_cast<T>(i + 10 * j + 100 * k));
}

// One leaf whose cell (i,j,k) holds i + 10 j + 100 k.
template <class T>
std::string counting_tree() {
    TreeText<T> tree;
    tree.leafs[{8, 16, 24}] =
        leaf_of<T>([](int i, int j, int k) { return static_cast<T>(i + 10 * j + 100 * k); });
    return tree.bytes();
}

std::string constant_tree(float value) {
    TreeText<float> tree;
    tree.leafs[{0, 0, 0}] = leaf_of<float>([&](int, int, int) { return value; });
    return tree.bytes();
}

GridText scalar(const std::string& name, float value) {
    return {.name = name, .type = "float", .tree = constant_tree(value)};
}

template <class T>
void expect_counting(const char* type) {
    Listener listener;
    const Frame frame = read_text(
        vdb_file({{.name = "count", .type = type, .tree = counting_tree<T>()}}), listener);
    const TileField<float>& values = frame.fields.at("count").component[0];
    EXPECT_EQ(values.map().size(), 1) << type;
    for (const Vec3i c : {Vec3i(0, 0, 0), Vec3i(7, 0, 0), Vec3i(0, 7, 0), Vec3i(1, 2, 7)}) {
        EXPECT_EQ(values.get(c + Vec3i(8, 16, 24)), cell_number<T>(c.x, c.y, c.z)) << type;
    }
}

std::string points_grid() {
    return std::string(100, 'x');
}

}  // namespace

TEST(VdbForeign, ValueTypes) {
    expect_counting<float>("float");
    expect_counting<double>("double");
    expect_counting<std::int32_t>("int32");
    expect_counting<std::int64_t>("int64");
    expect_counting<bool>("bool");
}

TEST(VdbForeign, VectorTypes) {
    TreeText<std::array<double, 3>> tree;
    tree.leafs[{0, 0, 0}] = leaf_of<std::array<double, 3>>([](int i, int j, int k) {
        return std::array<double, 3>{i + 0.5, j + 0.25, k + 0.125};
    });
    Listener listener;
    const Frame frame =
        read_text(vdb_file({{.name = "v", .type = "vec3d", .tree = tree.bytes()}}), listener);
    const Field& v = frame.fields.at("velocity");
    ASSERT_TRUE(v.is_vector());
    EXPECT_EQ(v.component[0].get({1, 2, 3}), 1.5f);
    EXPECT_EQ(v.component[1].get({1, 2, 3}), 2.25f);
    EXPECT_EQ(v.component[2].get({1, 2, 3}), 3.125f);
}

// Component a of a staggered vector lies on the lower face: u = 2 i there is 2 i + 1 at the centre.
TEST(VdbForeign, StaggeredVectorsAreAveraged) {
    using V = std::array<float, 3>;
    TreeText<V> tree;
    for (int n = 0; n < 8; ++n) {
        const std::array<int, 3> o{8 * (n & 1), 8 * (n >> 1 & 1), 8 * (n >> 2)};
        tree.leafs[o] = leaf_of<V>([&](int i, int j, int k) {
            return V{2.0f * static_cast<float>(o[0] + i), static_cast<float>(o[1] + j),
                     -static_cast<float>(o[2] + k)};
        });
    }
    Listener listener;
    const Frame frame = read_text(vdb_file({{.name = "velocity",
                                             .type = "vec3s",
                                             .tree = tree.bytes(),
                                             .metadata = {{"class", "staggered"}}}}),
                                  listener);
    const Field& v = frame.fields.at("velocity");
    for (int n = 0; n < 15; ++n) {
        EXPECT_EQ(v.component[0].get({n, 3, 3}), static_cast<float>(2 * n + 1));
        EXPECT_EQ(v.component[1].get({3, n, 3}), static_cast<float>(n) + 0.5f);
        EXPECT_EQ(v.component[2].get({3, 3, n}), -static_cast<float>(n) - 0.5f);
    }
    // The upper face of the last cell is not in the file: half of the background.
    EXPECT_EQ(v.component[0].get({15, 3, 3}), 15);
}

TEST(VdbForeign, ComponentsBecomeOneVelocity) {
    const double h = 0.5;
    for (const bool faces : {false, true}) {
        std::vector<GridText> grids{scalar("vel.x", 1), scalar("vel.y", 2), scalar("vel.z", 3)};
        for (int a = 0; a < 3; ++a) {
            grids[static_cast<std::size_t>(a)].h = h;
            if (faces) grids[static_cast<std::size_t>(a)].at[a] = -0.5 * h;
        }
        Listener listener;
        const Frame frame = read_text(vdb_file(grids), listener);
        ASSERT_EQ(frame.fields.size(), 1u);
        const Field& v = frame.fields.at("velocity");
        EXPECT_EQ(v.component[0].get({3, 3, 3}), 1);
        EXPECT_EQ(v.component[2].get({3, 3, 3}), 3);
        EXPECT_EQ(v.component[0].get({7, 3, 3}), faces ? 0.5f : 1);
        EXPECT_NEAR(length(v.to_world.translation - Vec3d(-0.25)), 0, 1e-12);
    }
}

TEST(VdbForeign, ComponentsApartStayApart) {
    std::vector<GridText> grids{scalar("vel_x", 1), scalar("vel_y", 2), scalar("vel_z", 3)};
    grids[1].at = {3, 0, 0};
    Listener listener;
    const Frame frame = read_text(vdb_file(grids), listener);
    EXPECT_EQ(frame.fields.size(), 3u);
    EXPECT_EQ(listener.warnings.size(), 1u);
}

TEST(VdbForeign, Aliases) {
    Listener listener;
    const Frame frame =
        read_text(vdb_file({scalar("Density", 1), scalar("flames", 2), scalar("heat", 3),
                            scalar("fuel", 4), scalar("fire", 5), scalar("fuel", 6)}),
                  listener);
    EXPECT_EQ(frame.fields.at("density").component[0].get({1, 1, 1}), 1);
    EXPECT_EQ(frame.fields.at("flame").component[0].get({1, 1, 1}), 2);
    EXPECT_EQ(frame.fields.at("temperature").component[0].get({1, 1, 1}), 3);
    EXPECT_EQ(frame.fields.at("fuel").component[0].get({1, 1, 1}), 4);
    EXPECT_EQ(frame.fields.at("fire").component[0].get({1, 1, 1}), 5);
    EXPECT_EQ(frame.fields.at("fuel_2").component[0].get({1, 1, 1}), 6);
    EXPECT_EQ(frame.number, 42);
}

TEST(VdbForeign, OwnNamesWithoutCustom) {
    Listener listener;
    const Frame frame = read_text(vdb_file({scalar("heat", 3)}), listener, {.customary = false});
    EXPECT_TRUE(frame.fields.contains("heat"));
}

// Houdini's heat is how freshly something burns.
TEST(VdbForeign, HoudinisHeatIsFlame) {
    Listener listener;
    const Frame frame = read_text(
        vdb_file({scalar("heat", 1), scalar("temperature", 2)}, {{"creator", "Houdini/x"}}),
        listener);
    EXPECT_TRUE(frame.fields.contains("flame"));
    EXPECT_EQ(frame.metadata.at("temperature_unit"), "relative");
}

TEST(VdbForeign, TemperatureUnits) {
    const auto read = [](float value, const std::string& unit) {
        Listener listener;
        GridText grid = scalar("temperature", value);
        if (!unit.empty()) grid.metadata["unit"] = unit;
        Frame frame = read_text(vdb_file({grid}), listener);
        EXPECT_EQ(listener.infos.size(), 1u);
        return std::pair(frame.metadata.at("temperature_unit"),
                         frame.fields.at("temperature").component[0].get({1, 1, 1}));
    };
    EXPECT_EQ(read(1.5f, ""), std::pair(std::string("relative"), 1.5f));
    EXPECT_EQ(read(900, ""), std::pair(std::string("K"), 900.0f));
    EXPECT_EQ(read(20, "C"), std::pair(std::string("K"), 293.15f));
    EXPECT_EQ(read(77, "K"), std::pair(std::string("K"), 77.0f));
}

// Mantaflow: cells per time unit, 2.5 units to the second; no half voxel in the transform.
TEST(VdbForeign, MantaflowsVelocityAndPlace) {
    using V = std::array<float, 3>;
    TreeText<V> tree;
    tree.leafs[{0, 0, 0}] = leaf_of<V>([](int, int, int) { return V{4, 0, 0}; });
    GridText grid{.name = "velocity", .type = "vec3s", .tree = tree.bytes()};
    grid.metadata["file_base_resolution"] = "64 64 64";
    grid.metadata["file_voxel_size"] = "0.1";
    grid.h = 0.1;
    Listener listener;
    const Field follow = read_text(vdb_file({grid}), listener).fields.at("velocity");
    EXPECT_FLOAT_EQ(follow.component[0].get({1, 1, 1}), 1);
    EXPECT_NEAR(follow.to_world.translation.x, -0.05, 1e-15);
    for (const HalfVoxel placed : {HalfVoxel::Auto, HalfVoxel::Center}) {
        const Frame frame = read_text(vdb_file({grid}), listener, {.half_voxel = placed});
        EXPECT_NEAR(frame.fields.at("velocity").to_world.translation.x, 0, 1e-15);
    }
}

TEST(VdbForeign, UniformTilesAreSpelledOutUpToTheLimit) {
    TreeText<float> small;
    small.small_tiles[{16, 0, 0}] = 2;
    small.leafs[{0, 0, 0}] = leaf_of<float>([](int, int, int) { return 1.0f; });
    Listener listener;
    const Frame frame = read_text(
        vdb_file({{.name = "density", .type = "float", .tree = small.bytes()}}), listener);
    const TileField<float>& values = frame.fields.at("density").component[0];
    EXPECT_EQ(values.map().size(), 2);
    EXPECT_EQ(values.get({23, 7, 7}), 2);
    EXPECT_EQ(values.map().bounds(), (Box3i{{0, 0, 0}, {24, 8, 8}}));

    TreeText<float> huge;
    huge.tiles[{0, 0, 0}] = 1;  // 4096^3 cells: 256 GiB
    const std::string bytes = vdb_file({{.name = "d", .type = "float", .tree = huge.bytes()}});
    EXPECT_EQ(outcome([&] { read_text(bytes, listener); }), Outcome::Resource);
    const TestFolder folder("vdb_huge");
    put(folder.file("huge.vdb"), bytes);
    EXPECT_EQ(list_vdb(folder.file("huge.vdb"), listener.job).grids[0].active_voxels,
              std::int64_t{1} << 36);
}

TEST(VdbForeign, NumbersThatAreNoneBecomeBackground) {
    TreeText<float> tree;
    tree.background = 0.5f;
    tree.leafs[{0, 0, 0}] = leaf_of<float>([](int i, int, int) {
        return i == 1 ? NAN : i == 2 ? std::numeric_limits<float>::infinity() : 1.0f;
    });
    Listener listener;
    const Frame frame =
        read_text(vdb_file({{.name = "density", .type = "float", .tree = tree.bytes()}}), listener);
    const TileField<float>& values = frame.fields.at("density").component[0];
    EXPECT_EQ(values.get({1, 3, 3}), 0.5f);
    EXPECT_EQ(values.get({2, 3, 3}), 0.5f);
    EXPECT_EQ(values.get({3, 3, 3}), 1);
    ASSERT_EQ(listener.warnings.size(), 1u);
    EXPECT_NE(listener.warnings[0].find("128 values"), std::string::npos);
}

TEST(VdbForeign, UnknownTypesAndTransformsAreLeftOutByName) {
    GridText points{.name = "particles", .type = "ptdataidx32", .tree = points_grid()};
    GridText frustum = scalar("seen", 1);
    frustum.transform = VdbText().text("NonlinearFrustumMap").bytes + std::string(300, '\0');
    Listener listener;
    const Frame frame = read_text(vdb_file({points, scalar("density", 1), frustum}), listener);
    EXPECT_EQ(frame.fields.size(), 1u);
    ASSERT_EQ(listener.warnings.size(), 2u);
    EXPECT_NE((listener.warnings[0] + listener.warnings[1]).find("'particles'"), std::string::npos);
    EXPECT_NE((listener.warnings[0] + listener.warnings[1]).find("'seen'"), std::string::npos);
}

TEST(VdbForeign, GridsHaveTransformsOfTheirOwn) {
    GridText coarse = scalar("temperature", 500);
    coarse.h = 2;
    coarse.at = {1, 1, 1};
    Listener listener;
    const Frame frame = read_text(vdb_file({scalar("density", 1), coarse}), listener);
    EXPECT_EQ(frame.fields.at("density").cell_size(), 1);
    EXPECT_EQ(frame.fields.at("temperature").cell_size(), 2);
    EXPECT_NEAR(length(frame.fields.at("temperature").to_world.translation), 0, 1e-12);
    EXPECT_EQ(frame.fields.at("density").sample({4, 4, 4}), 1);
    EXPECT_EQ(frame.fields.at("temperature").sample({4, 4, 4}), 500);
}

TEST(VdbForeign, OnlyTheGridsAskedFor) {
    const std::string bytes = vdb_file({scalar("density", 1), scalar("heat", 2), scalar("x", 3)});
    Listener listener;
    EXPECT_EQ(read_text(bytes, listener, {.grids = {"temperature"}}).fields.size(), 1u);
    EXPECT_EQ(read_text(bytes, listener, {.grids = {"x", "density"}}).fields.size(), 2u);
    EXPECT_EQ(read_text(bytes, listener, {.grids = {"nothing"}}).fields.size(), 0u);
}

}  // namespace gischt
