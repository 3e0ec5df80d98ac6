// SPDX-License-Identifier: Apache-2.0
#include "io/hdr.h"

#include <gtest/gtest.h>

#include <array>

#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

// The format's promise: half a mantissa step of the largest channel, 1/256 of it at most.
void expect_close(const Image& a, const Image& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    const auto ca = a.color(), cb = b.color();
    for (std::size_t i = 0; i < a.pixel_count(); ++i) {
        const float largest = std::max({ca[0][i], ca[1][i], ca[2][i]});
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(ca[c][i], cb[c][i], largest / 255.9f);
    }
}

TEST(Hdr, RoundTripOverManySizesAndMagnitudes) {
    const TestFolder folder("hdr");
    for (const int width : {1, 7, 8, 300}) {
        for (const float largest : {1e-6f, 1.0f, 1e20f}) {
            const Image image = random_image(width, 5, largest);
            write_hdr(folder.file("a.hdr"), image);
            expect_close(image, read_hdr(folder.file("a.hdr")));
        }
    }
    EXPECT_EQ(folder.count(), 1);
}

TEST(Hdr, CodesRunsAndPowersOfTwoExactly) {
    const TestFolder folder("hdr");
    Image image = Image::rgb(1000, 2);
    for (int x = 0; x < 1000; ++x) {
        const float v = x < 400 ? 0.5f : x % 7 == 0 ? 2.0f : 1.0f;
        for (const char* name : {"R", "G", "B"}) image.channel(name)[image.index(x, 1)] = v;
    }
    image.metadata.set("note", "two\nlines");
    write_hdr(folder.file("a.hdr"), image);
    const std::string bytes = read_bytes(folder.file("a.hdr"));
    EXPECT_LT(bytes.size(), 3500u);
    const Image back = read_hdr(folder.file("a.hdr"));
    EXPECT_EQ(back.planes, image.planes);
}

TEST(Hdr, ReadsFlatPixelsOldRunsExposureAndUpwardRows) {
    const TestFolder folder("hdr");
    std::string bytes = "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n+Y 2 +X 3\n";
    // Mantissa 128 with exponent 129 is 1; a run repeats it twice. Then the upper row, black.
    bytes += std::string("\x80\x40\x00\x81", 4) + std::string("\x01\x01\x01\x02", 4);
    bytes += std::string(12, '\0');
    put(folder.file("a.hdr"), bytes);
    const Image image = read_hdr(folder.file("a.hdr"));
    for (int x = 0; x < 3; ++x) {
        EXPECT_EQ(image.channel("R")[image.index(x, 1)], 0.5f);
        EXPECT_EQ(image.channel("G")[image.index(x, 1)], 0.25f);
        EXPECT_EQ(image.channel("R")[image.index(x, 0)], 0);
    }
}

TEST(Hdr, RefusesBrokenFiles) {
    const TestFolder folder("hdr");
    EXPECT_TRUE(refuses_what_is_no_file(folder, read_hdr));
    const std::string path = folder.file("a.hdr");
    write_hdr(path, random_image(20, 40));
    for_broken_files(path, read_bytes(path), [](const std::string& file, bool must_fail) {
        const Outcome result = outcome([&] { read_hdr(file); });
        if (must_fail) {
            EXPECT_EQ(result, Outcome::Input);
        } else {
            EXPECT_TRUE(result == Outcome::Fine || result == Outcome::Input);
        }
    });
    put(path, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n1234");
    EXPECT_EQ(outcome([&] { read_hdr(path); }), Outcome::Input);
    put(path, "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234");
    EXPECT_EQ(outcome([&] { read_hdr(path); }), Outcome::Input);
}

TEST(Hdr, ReadsAnEnvironmentMap) {
    const std::string path =
        std::string(GISCHT_SOURCE_DIR) + "/../shared/data/environment/studio_small_08_1k.hdr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no environment map";
    const Image image = read_hdr(path);
    EXPECT_EQ(image.width, 1024);
    EXPECT_EQ(image.height, 512);
    float largest = 0;
    for (const float v : image.channel("G")) largest = std::max(largest, v);
    EXPECT_GT(largest, 1);
}

}  // namespace
}  // namespace gischt
