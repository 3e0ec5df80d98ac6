// SPDX-License-Identifier: Apache-2.0
#include "io/vdb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>

#include "base/parallel.h"
#include "io/vdb_test_files.h"

namespace gischt {

static Frame round_trip(const Frame& frame, const VdbWriteOptions& options,
                        HalfVoxel half_voxel = HalfVoxel::Follow) {
    const TestFolder folder("vdb");
    Job job;
    write_vdb(folder.file("frame.vdb"), frame, options, job);
    return read_vdb(folder.file("frame.vdb"), {.half_voxel = half_voxel}, job);
}

static std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// The largest difference over all cells of both, relative to `scale` or the value itself.
static double largest_error(const Field& a, const Field& b, bool relative) {
    double worst = 0;
    for (std::size_t c = 0; c < a.component.size(); ++c) {
        for (int z = -18; z < 18; ++z) {
            for (int y = -18; y < 18; ++y) {
                for (int x = -18; x < 18; ++x) {
                    const double u = a.component[c].get({x, y, z}, a.background[c]);
                    const double v = b.component[c].get({x, y, z}, b.background[c]);
                    worst = std::max(worst, std::abs(u - v) / (relative ? std::abs(u) + 1e-6 : 1));
                }
            }
        }
    }
    return worst;
}

TEST(Vdb, RoundTripIsExactInFloat) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        Frame frame;
        frame.fields["density"] = random_field(seed, 1);
        frame.fields["temperature"] = random_field(seed + 10, 1, 293.15f);
        frame.fields["velocity"] = random_field(seed + 20, 3, 0.5f);
        const Frame back = round_trip(frame, {.half_scalars = false});
        ASSERT_EQ(back.fields.size(), 3u);
        for (const auto& [name, field] : frame.fields) {
            EXPECT_EQ(largest_error(field, back.fields.at(name), false), 0) << name;
            EXPECT_EQ(back.fields.at(name).background, field.background) << name;
            EXPECT_EQ(back.fields.at(name).map().bounds(), field.map().bounds()) << name;
        }
    }
}

// Half floats have 11 significant bits: relative error 2^-11; below 2^-14 absolute 2^-25.
TEST(Vdb, HalfFloatsAreWithinTheirRounding) {
    Frame frame;
    frame.fields["density"] = random_field(4, 1);
    frame.fields["velocity"] = random_field(5, 3);
    const Frame back = round_trip(frame, {.half_scalars = true, .half_vectors = true});
    EXPECT_LE(largest_error(frame.fields["density"], back.fields.at("density"), true), 0x1p-11);
    EXPECT_LE(largest_error(frame.fields["velocity"], back.fields.at("velocity"), true), 0x1p-11);
    EXPECT_GT(largest_error(frame.fields["density"], back.fields.at("density"), true), 0);
}

TEST(Vdb, ValuesBeyondHalfFloatsAreWrittenInFull) {
    Frame frame;
    frame.fields["pressure"] = random_field(6, 1, 101325);
    const Frame back = round_trip(frame, {});
    EXPECT_EQ(largest_error(frame.fields["pressure"], back.fields.at("pressure"), false), 0);
}

TEST(Vdb, TransformsComeBack) {
    const Transform turned = Transform::rotation(normalize(Vec3d{1, 2, 3}), 0.7);
    Transform stretched = Transform::scale_translate(1, {5, -6, 7});
    stretched.column = {Vec3d{0.1, 0, 0}, Vec3d{0, 0.2, 0}, Vec3d{0, 0, 0.3}};
    for (const Transform& t : {Transform{}, Transform::scale_translate(0.0125, {-3.3, 0.1, 1e4}),
                               turned * Transform::scale_translate(0.25, {1, 2, 3}), stretched}) {
        Frame frame;
        frame.fields["density"] = random_field(7, 1);
        frame.fields["density"].to_world = t;
        for (const bool half_voxel : {true, false}) {
            const Frame back = round_trip(frame, {.half_voxel = half_voxel},
                                          half_voxel ? HalfVoxel::Follow : HalfVoxel::Center);
            const Transform& b = back.fields.at("density").to_world;
            const double scale = length(t.translation) + 1;
            EXPECT_LT(length(b.translation - t.translation), 1e-15 * 8 * scale);
            for (std::size_t a = 0; a < 3; ++a) {
                EXPECT_LT(length(b.column[a] - t.column[a]), 1e-14);
            }
        }
    }
}

// A cell's centre goes into the file as the place of its sample.
TEST(Vdb, SamplesLieAtCellCentres) {
    const TestFolder folder("vdb_place");
    Frame frame;
    frame.fields["density"] = random_field(8, 1);
    frame.fields["density"].to_world = Transform::scale_translate(0.5, {10, 20, 30});
    Job job;
    write_vdb(folder.file("a.vdb"), frame, {}, job);
    const VdbInfo with = list_vdb(folder.file("a.vdb"), job);
    EXPECT_EQ(with.grids[0].origin, (std::array<double, 3>{10.25, 20.25, 30.25}));
    EXPECT_EQ(with.grids[0].voxel_size, (std::array<double, 3>{0.5, 0.5, 0.5}));
    write_vdb(folder.file("b.vdb"), frame, {.half_voxel = false}, job);
    const VdbInfo without = list_vdb(folder.file("b.vdb"), job);
    EXPECT_EQ(without.grids[0].origin, (std::array<double, 3>{10, 20, 30}));
}

TEST(Vdb, FlatFramesStayFlat) {
    const auto map = TileMap::box({70, 40, 1});
    Field field;
    field.component.emplace_back(map);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 70; ++x) {
            field.component[0].ref({x, y, 0}) = static_cast<float>(x * 100 + y) * 0.25f;
        }
    }
    Frame frame;
    frame.fields["density"] = field;
    const Frame back = round_trip(frame, {.half_scalars = false});
    const Field& flat = back.fields.at("density");
    EXPECT_TRUE(flat.map().is_2d());
    EXPECT_EQ(flat.map().size(), map->size());
    EXPECT_EQ(flat.map().bounds(), map->bounds());
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 70; ++x) {
            ASSERT_EQ(flat.component[0].get({x, y, 0}), static_cast<float>(x * 100 + y) * 0.25f);
        }
    }
}

// Boxes whose size is no multiple of 8: what hangs over means nothing and is not written.
TEST(Vdb, OverhangIsNotWritten) {
    Field field;
    field.component.emplace_back(TileMap::box({10, 11, 12}), 1.0f);
    Frame frame;
    frame.fields["density"] = field;
    const TestFolder folder("vdb_overhang");
    Job job;
    write_vdb(folder.file("a.vdb"), frame, {}, job);
    EXPECT_EQ(list_vdb(folder.file("a.vdb"), job).grids[0].active_voxels, 10 * 11 * 12);
}

TEST(Vdb, EmptyFieldsAndFramesAreKept) {
    Frame frame;
    frame.fields["flame"].component.emplace_back(TileMap::sparse({}, {}));
    const Frame back = round_trip(frame, {});
    ASSERT_NE(back.find("flame"), nullptr);
    EXPECT_EQ(back.find("flame")->map().size(), 0);
    EXPECT_TRUE(round_trip(Frame{}, {}).fields.empty());
}

// Inside and outside of a level set are values too, though inactive.
TEST(Vdb, LevelSetsKeepBothSides) {
    Field field;
    field.kind = FieldClass::LevelSet;
    field.background = {3, 0, 0};
    field.component.emplace_back(TileMap::box(Vec3i(40)), 3.0f);
    for (int z = 0; z < 40; ++z) {
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 40; ++x) {
                const double r = length(Vec3d(x + 0.5, y + 0.5, z + 0.5) - Vec3d(20));
                field.component[0].ref({x, y, z}) =
                    std::clamp(static_cast<float>(r - 15), -3.0f, 3.0f);
            }
        }
    }
    Frame frame;
    frame.fields["surface"] = field;
    const Field back = round_trip(frame, {}).fields.at("surface");
    EXPECT_EQ(back.kind, FieldClass::LevelSet);
    for (int x = 0; x < 40; ++x) {
        EXPECT_EQ(back.component[0].get({x, 20, 20}, back.background[0]),
                  field.component[0].get({x, 20, 20}));
    }
    EXPECT_EQ(back.component[0].get({20, 20, 20}, 0), -3);
}

TEST(Vdb, TimeAndMetadataComeBack) {
    Frame frame;
    frame.number = 17;
    frame.time = 0.1 + 0.2;
    frame.dt = 1 / 25.0;
    frame.metadata["scene_hash"] = "0123456789abcdef";
    frame.metadata["density.remark"] = "ours";
    frame.fields["density"] = random_field(9, 1);
    const Frame back = round_trip(frame, {});
    EXPECT_EQ(back.number, 17);
    EXPECT_EQ(back.time, 0.1 + 0.2);
    EXPECT_EQ(back.dt, 1 / 25.0);
    EXPECT_EQ(back.metadata.at("scene_hash"), "0123456789abcdef");
    EXPECT_EQ(back.metadata.at("density.remark"), "ours");
    EXPECT_TRUE(back.metadata.at("creator").starts_with("gischt "));
    EXPECT_EQ(back.metadata.at("fps"), "25");
}

TEST(Vdb, SameFrameSameBytes) {
    const TestFolder folder("vdb_bytes");
    Frame frame;
    frame.fields["density"] = random_field(10, 1);
    frame.fields["velocity"] = random_field(11, 3);
    Job job;
    write_vdb(folder.file("a.vdb"), frame, {}, job);
    {
        const ThreadLimit one(1);
        write_vdb(folder.file("b.vdb"), frame, {}, job);
    }
    const std::string a = bytes_of(folder.file("a.vdb"));
    EXPECT_EQ(a, bytes_of(folder.file("b.vdb")));
    frame.fields["density"].component[0].values()[5] += 1;
    write_vdb(folder.file("b.vdb"), frame, {}, job);
    EXPECT_NE(a.substr(21, 36), bytes_of(folder.file("b.vdb")).substr(21, 36));
}

TEST(Vdb, CancelledWritingLeavesNothing) {
    const TestFolder folder("vdb_cancel");
    Frame frame;
    frame.fields["density"] = random_field(12, 1);
    Job job;
    job.cancel();
    EXPECT_EQ(outcome([&] { write_vdb(folder.file("a.vdb"), frame, {}, job); }), Outcome::Other);
    EXPECT_EQ(folder.count(), 0);
}

}  // namespace gischt
