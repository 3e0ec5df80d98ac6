// SPDX-License-Identifier: Apache-2.0
#include "io/film_file.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

FilmFile sample_film() {
    FilmFile file;
    file.state.film.emplace(7, 5, ReconstructionFilter(FilterKind::Mitchell, 1.75f),
                            std::vector<std::string>{"direct.R", "motion.X"});
    for (std::uint32_t i = 0; i < 35 * 20; ++i) {
        const std::uint64_t key = random_key(1, i);
        const float v = random_uniform(key, 0), extra[] = {1e9f * v, -1e-12f * v};
        file.state.film->add(
            static_cast<int>(i % 7), static_cast<int>(i / 7 % 5),
            {Vec3f(1e9f * v, v, -1e-12f * v), v, 1 / (v - 0.5f), v < 0.1f ? -1.0f : 1.0f}, extra);
    }
    file.state.ranges = {{3, 13}, {20, 30}};
    file.state.tile_goals = {20};
    file.state.has_samples = true;
    file.metadata.set("seed", "17");
    file.metadata.set("empty", "");
    return file;
}

TEST(FilmFile, ComesBackBitByBit) {
    const TestFolder folder("film");
    const FilmFile file = sample_film();
    write_film(folder.file("a.film"), file.state, file.metadata);
    FilmFile back = read_film(folder.file("a.film"));
    EXPECT_EQ(back.state.image(), file.state.image());
    EXPECT_EQ(back.state.ranges, file.state.ranges);
    EXPECT_EQ(back.state.tile_goals, file.state.tile_goals);
    EXPECT_EQ(back.state.film->noise(), file.state.film->noise());
    EXPECT_EQ(back.state.film->filter().radius(), 1.75f);
    EXPECT_EQ(back.metadata, file.metadata);
    EXPECT_FALSE(back.state.has_variance);
    // And what the image does not tell: the file of what came back is the same file.
    write_film(folder.file("b.film"), back.state, back.metadata);
    EXPECT_EQ(read_bytes(folder.file("a.film")), read_bytes(folder.file("b.film")));
}

TEST(FilmFile, RefusesWhatIsCutShortDamagedOrForeign) {
    const TestFolder folder("film_broken");
    const FilmFile file = sample_film();
    const std::string path = folder.file("a.film");
    write_film(path, file.state, file.metadata);
    const std::string whole = read_bytes(path);
    auto reading = [&](const std::string& bytes) {
        put(path, bytes);
        return outcome([&] { read_film(path); });
    };
    EXPECT_EQ(reading(whole), Outcome::Fine);
    for (std::size_t size = 1; size < whole.size(); size += size < 300 ? 1 : 97) {
        EXPECT_EQ(reading(whole.substr(0, size)), Outcome::Input) << size;
    }
    EXPECT_EQ(reading(whole + "x"), Outcome::Input);
    for (std::size_t at = 0; at < whole.size(); at += 61) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        EXPECT_EQ(reading(damaged), Outcome::Input) << at;
    }
    EXPECT_EQ(reading("PNG or so"), Outcome::Input);
    EXPECT_EQ(outcome([&] { read_film(folder.file("none.film")); }), Outcome::Input);
}

// Wrong numbers under a right checksum, as by a hand that means harm: no crash, no huge memory.
TEST(FilmFile, SurvivesForgedContents) {
    const TestFolder folder("film_forged");
    const FilmFile file = sample_film();
    const std::string path = folder.file("a.film");
    write_film(path, file.state, file.metadata);
    const std::string whole = read_bytes(path);
    for (std::size_t at = 12; at < whole.size() - 8; at += at < 250 ? 1 : 41) {
        for (const char value : {'\x00', '\x7f', '\xff'}) {
            std::string forged = whole.substr(0, whole.size() - 8);
            forged[at] = value;
            const std::uint64_t hash = hash_bytes(forged);
            for (int i = 0; i < 8; ++i) forged.push_back(static_cast<char>(hash >> (8 * i) & 0xff));
            put(path, forged);
            const Outcome o = outcome([&] { read_film(path); });
            EXPECT_TRUE(o == Outcome::Fine || o == Outcome::Input) << at;
        }
    }
}

}  // namespace
}  // namespace gischt
