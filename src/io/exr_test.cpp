// SPDX-License-Identifier: Apache-2.0
#include "io/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <limits>

#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

void write_one_channel(Imf::Header header, const std::string& path, bool tiled,
                       const std::vector<float>& values) {
    const Imath::Box2i box = header.dataWindow();
    const int width = box.max.x - box.min.x + 1, height = box.max.y - box.min.y + 1;
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.channels().insert("G", Imf::Channel(Imf::FLOAT));
    header.channels().insert("B", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer frame;
    for (const char* name : {"R", "G", "B"}) {
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), box.min, width, height));
    }
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(8, 8));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    }
}

TEST(Exr, FloatRoundTripIsExact) {
    const TestFolder folder("exr");
    Image image = random_image(37, 23, 1000);
    image.planes[0].values[3] = std::numeric_limits<float>::infinity();
    image.planes[1].values[4] = -1e-40f;
    image.metadata.set("command", "gischt render --set a=\"\xc3\xa4\"");
    image.metadata.set("scene_hash", "0123");
    write_exr(folder.file("a.exr"), image, {.half = false});
    EXPECT_EQ(read_exr(folder.file("a.exr")), image);
    EXPECT_EQ(folder.count(), 1);
}

TEST(Exr, HalfRoundTripIsWithinHalfAUnitInTheLastPlace) {
    const TestFolder folder("exr");
    const Image image = random_image(64, 33, 100);
    write_exr(folder.file("a.exr"), image);
    const Image back = read_exr(folder.file("a.exr"));
    const auto a = image.channel("R"), b = back.channel("R");
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i], b[i], std::max(a[i] * 0x1p-11f, 0x1p-25f));
    }
    const auto z = back.channel("Z");
    EXPECT_TRUE(std::equal(z.begin(), z.end(), image.channel("Z").begin()));
}

TEST(Exr, ChannelsThatHalfWouldSpoilAreWrittenAsFloat) {
    const TestFolder folder("exr");
    for (const float largest : {1e-4f, 1e6f}) {
        const Image image = random_image(9, 9, largest);
        write_exr(folder.file("a.exr"), image);
        EXPECT_EQ(read_exr(folder.file("a.exr")), image);
    }
}

TEST(Exr, ReadsTilesAndPlacesTheDataWindow) {
    const TestFolder folder("exr");
    // Data cover x 2..12, y -1..8 of a display window 10 x 6.
    std::vector<float> values(11 * 10);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i + 1);
    for (const bool tiled : {false, true}) {
        Imf::Header header(Imath::Box2i({0, 0}, {9, 5}), Imath::Box2i({2, -1}, {12, 8}));
        write_one_channel(header, folder.file("a.exr"), tiled, values);
        const Image image = read_exr(folder.file("a.exr"));
        EXPECT_EQ(image.width, 10);
        EXPECT_EQ(image.height, 6);
        const auto r = image.channel("R");
        EXPECT_EQ(r[image.index(1, 3)], 0);
        EXPECT_EQ(r[image.index(2, 0)], values[11]);
        EXPECT_EQ(r[image.index(9, 5)], values[6 * 11 + 7]);
    }
}

TEST(Exr, ConvertsOtherPrimariesAndKeepsWhite) {
    const TestFolder folder("exr");
    Imf::Header header(2, 2);  // ACES AP0 with its white
    Imf::addChromaticities(header, Imf::Chromaticities({0.7347f, 0.2653f}, {0, 1},
                                                       {0.0001f, -0.077f}, {0.32168f, 0.33767f}));
    write_one_channel(header, folder.file("a.exr"), false, {1, 1, 1, 1});
    Imf::Header ap1(2, 2);
    Imf::addChromaticities(ap1, Imf::Chromaticities({0.713f, 0.293f}, {0.165f, 0.830f},
                                                    {0.128f, 0.044f}, {0.32168f, 0.33767f}));
    write_one_channel(ap1, folder.file("b.exr"), false, {1, 1, 1, 1});
    for (const char* name : {"a.exr", "b.exr"}) {
        const Image image = read_exr(folder.file(name));
        for (const auto& plane : image.planes) EXPECT_NEAR(plane.values[0], 1, 1e-5) << name;
    }
}

TEST(Exr, RefusesBrokenFiles) {
    const TestFolder folder("exr");
    EXPECT_TRUE(refuses_what_is_no_file(folder, read_exr));
    const std::string path = folder.file("a.exr");
    Image image = random_image(20, 40);
    image.metadata.set("command", "gischt");
    write_exr(path, image);
    for_broken_files(path, read_bytes(path), [](const std::string& file, bool must_fail) {
        const Outcome result = outcome([&] { read_exr(file); });
        if (must_fail) {
            EXPECT_EQ(result, Outcome::Input);
        } else {
            EXPECT_TRUE(result == Outcome::Fine || result == Outcome::Input);
        }
    });
}

TEST(Exr, RefusesSizesThatTheBytesCannotHold) {
    const TestFolder folder("exr");
    const std::string path = folder.file("a.exr");
    write_exr(path, random_image(20, 40));
    std::string bytes = read_bytes(path);
    // Both windows end at (19, 39): make them 60000 wide and high.
    for (const char* name : {"dataWindow", "displayWindow"}) {
        const std::size_t at = bytes.find(name) + std::string(name).size() + 1 + 6 + 4 + 8;
        const std::array<std::int32_t, 2> end{59999, 59999};
        bytes.replace(at, 8, reinterpret_cast<const char*>(end.data()), 8);
    }
    put(path, bytes);
    EXPECT_EQ(outcome([&] { read_exr(path); }), Outcome::Input);
}

TEST(Exr, RefusesReservedMetadataAndLeavesNothing) {
    const TestFolder folder("exr");
    Image image = random_image(4, 4);
    image.metadata.set("channels", "all");
    EXPECT_EQ(outcome([&] { write_exr(folder.file("a.exr"), image); }), Outcome::Usage);
    EXPECT_EQ(folder.count(), 0);
}

TEST(Exr, ReadsAFileOfAnotherRenderer) {
    const std::string path = std::string(GISCHT_SOURCE_DIR) +
                             "/../shared/data/images/ref_smoke128_cycles_b32_g0_256spp.exr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference image";
    const Image image = read_exr(path);
    const auto color = image.color();
    double sum = 0;
    for (const auto& plane : color) {
        for (const float v : plane) sum += v;
    }
    // The mean that the image's makers state.
    EXPECT_NEAR(sum / (3.0 * static_cast<double>(color[0].size())), 0.103569, 2e-4);
}

}  // namespace
}  // namespace gischt
