// SPDX-License-Identifier: Apache-2.0
#include "io/png.h"

#include <gtest/gtest.h>
#include <png.h>

#include "image/color.h"
#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

const DisplayOptions plain{
    .tone = ToneKind::Linear, .exposure = 0, .dither = false, .alpha = false};

// Largest difference in sRGB codes, 1 being full scale.
double encoded_difference(const Image& a, const Image& b) {
    double largest = 0;
    for (const char* name : {"R", "G", "B"}) {
        const auto va = a.channel(name), vb = b.channel(name);
        for (std::size_t i = 0; i < va.size(); ++i) {
            const double d = srgb_encode(va[i]) - srgb_encode(vb[i]);
            largest = std::max(largest, std::abs(d));
        }
    }
    return largest;
}

TEST(Png, RoundTripIsWithinHalfACode) {
    const TestFolder folder("png");
    const Image image = random_image(31, 17);
    for (const auto& [bits, codes] : {std::pair(8, 255.0), std::pair(16, 65535.0)}) {
        write_png(folder.file("a.png"), to_display(image, plain, bits));
        const Image back = read_png(folder.file("a.png"));
        EXPECT_EQ(back.planes.size(), 3u);
        EXPECT_LT(encoded_difference(image, back), 0.51 / codes);
    }
    EXPECT_EQ(folder.count(), 1);
}

TEST(Png, DitherStaysWithinACodeAndARereadPictureIsItself) {
    const TestFolder folder("png");
    const Image image = random_image(64, 64);
    const DisplayOptions options{
        .tone = ToneKind::Linear, .exposure = 0, .dither = true, .alpha = false};
    write_png(folder.file("a.png"), to_display(image, options));
    const Image once = read_png(folder.file("a.png"));
    EXPECT_LT(encoded_difference(image, once), 1.01 / 255);
    write_png(folder.file("b.png"), to_display(once, options));
    EXPECT_EQ(read_png(folder.file("b.png")), once);
}

TEST(Png, AlphaIsStraightInTheFileAndPremultipliedInTheImage) {
    const TestFolder folder("png");
    Image image = Image::rgba(2, 1);
    for (int c = 0; c < 3; ++c) image.planes[static_cast<std::size_t>(c)].values[0] = 0.25f;
    image.channel("A")[0] = 0.5f;
    DisplayOptions options = plain;
    options.alpha = true;
    write_png(folder.file("a.png"), to_display(image, options, 16));
    const Image back = read_png(folder.file("a.png"));
    EXPECT_NEAR(back.channel("R")[0], 0.25, 1e-4);
    EXPECT_NEAR(back.channel("A")[0], 0.5, 1e-4);
    EXPECT_EQ(back.channel("A")[1], 0);
}

TEST(Png, MetadataRoundTripInOrder) {
    const TestFolder folder("png");
    Metadata metadata;
    metadata.set("version", "0.1.0");
    metadata.set("command", "gischt render --set name=\xc3\xa4 -o a.png");
    metadata.set("a note", "");
    write_png(folder.file("a.png"), to_display(Image::rgb(2, 2), plain), metadata);
    EXPECT_EQ(read_png(folder.file("a.png")).metadata, metadata);
    metadata.set(std::string(80, 'k'), "");
    EXPECT_EQ(outcome([&] {
                  write_png(folder.file("b.png"), to_display(Image::rgb(2, 2), plain), metadata);
              }),
              Outcome::Usage);
    EXPECT_EQ(folder.count(), 1);
}

// A palette, with a transparent color, by libpng's simplified interface.
TEST(Png, ReadsPalettes) {
    const TestFolder folder("png");
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = 2;
    png.height = 1;
    png.format = PNG_FORMAT_RGBA_COLORMAP;
    png.colormap_entries = 2;
    const std::array<unsigned char, 8> colors{255, 0, 0, 255, 0, 255, 0, 0};
    const std::array<unsigned char, 2> pixels{0, 1};
    ASSERT_TRUE(png_image_write_to_file(&png, folder.file("a.png").c_str(), 0, pixels.data(), 0,
                                        colors.data()));
    const Image image = read_png(folder.file("a.png"));
    EXPECT_EQ(image.channel("R")[0], 1);
    EXPECT_EQ(image.channel("A")[0], 1);
    EXPECT_EQ(image.channel("G")[1], 0);  // premultiplied
    EXPECT_EQ(image.channel("A")[1], 0);
}

TEST(Png, RefusesBrokenFiles) {
    const TestFolder folder("png");
    EXPECT_TRUE(refuses_what_is_no_file(folder, read_png));
    const std::string path = folder.file("a.png");
    write_png(path, to_display(random_image(20, 40), plain));
    for_broken_files(path, read_bytes(path), [](const std::string& file, bool must_fail) {
        const Outcome result = outcome([&] { read_png(file); });
        if (must_fail) {
            EXPECT_EQ(result, Outcome::Input);
        } else {
            EXPECT_TRUE(result == Outcome::Fine || result == Outcome::Input);
        }
    });
}

// Data must come back from any reader as it is: nothing may tell it to decode a curve.
TEST(Png, MarksColorsAsSrgbAndDataAsNothing) {
    const TestFolder folder("png_data");
    DisplayImage image = to_display(random_image(4, 4), {});
    for (const bool is_srgb : {true, false}) {
        image.is_srgb = is_srgb;
        write_png(folder.file("a.png"), image);
        std::ifstream in(folder.file("a.png"), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        for (const char* chunk : {"sRGB", "gAMA"}) {
            EXPECT_EQ(bytes.find(chunk) != std::string::npos, is_srgb) << chunk;
        }
    }
}

}  // namespace
}  // namespace gischt
