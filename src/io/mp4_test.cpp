// SPDX-License-Identifier: Apache-2.0
#include "io/mp4.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

bool has_ffmpeg() {
    return std::system("ffmpeg -version >/dev/null 2>&1 && ffprobe -version >/dev/null 2>&1") == 0;
}

// What a command prints.
std::string output_of(const std::string& command) {
    std::string text;
    std::array<char, 256> buffer;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    while (pipe && std::fgets(buffer.data(), buffer.size(), pipe)) text += buffer.data();
    if (pipe) ::pclose(pipe);
    return text;
}

Mp4Options options() {
    Mp4Options o;
    o.frames_per_second = 25;
    o.display.tone = ToneKind::Linear;
    o.metadata.set("command", "gischt run 'a scene'");
    return o;
}

Image flat(int width, int height, const Vec3f& color) {
    Image image = Image::rgb(width, height);
    for (int c = 0; c < 3; ++c) {
        for (float& v : image.planes[static_cast<std::size_t>(c)].values) v = color[c];
    }
    return image;
}

void write_movie(const std::string& path) {
    Mp4Writer movie(path, 63, 47, options());
    for (int i = 0; i < 10; ++i) movie.add(flat(63, 47, Vec3f(static_cast<float>(i) / 10)));
    movie.finish();
}

TEST(Mp4, WritesTenFramesThatPlayersUnderstand) {
    if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
    const TestFolder folder("mp4");
    const std::string path = folder.file("a movie.mp4");
    write_movie(path);
    EXPECT_EQ(folder.count(), 1);
    const std::string found =
        output_of("ffprobe -v error -count_frames -show_streams -show_format '" + path + "'");
    for (const char* line :
         {"codec_name=h264", "width=64", "height=48", "pix_fmt=yuv420p", "color_space=bt709",
          "color_transfer=bt709", "color_primaries=bt709", "color_range=tv", "nb_read_frames=10",
          "r_frame_rate=25/1", "TAG:command=gischt run 'a scene'"}) {
        EXPECT_NE(found.find(line), std::string::npos) << line << "\n" << found;
    }
    // faststart: the index stands before the frames.
    const std::string bytes = read_bytes(path);
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
    write_movie(folder.file("b.mp4"));
    EXPECT_EQ(read_bytes(folder.file("b.mp4")), bytes);
}

TEST(Mp4, ColorsSurvive) {
    if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
    const TestFolder folder("mp4");
    const std::string path = folder.file("a.mp4");
    const Vec3f color{0.6f, 0.2f, 0.05f};  // sRGB codes 203, 124, 63
    Mp4Writer movie(path, 32, 32, options());
    for (int i = 0; i < 3; ++i) movie.add(flat(32, 32, color));
    movie.finish();
    const std::string rgb = output_of(
        "ffmpeg -v error -i " + path +
        " -frames:v 1 -vf scale=in_color_matrix=bt709:in_range=tv,format=rgb24 -f rawvideo -");
    ASSERT_GE(rgb.size(), 3u);
    const std::array<int, 3> expected{203, 124, 63};
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(static_cast<unsigned char>(rgb[c]), expected[c], 3);
    }
}

TEST(Mp4, LeavesNothingWithoutFinish) {
    if (!has_ffmpeg()) GTEST_SKIP() << "no ffmpeg";
    const TestFolder folder("mp4");
    {
        Mp4Writer movie(folder.file("a.mp4"), 64, 64);
        movie.add(Image::rgb(64, 64));
        EXPECT_EQ(outcome([&] { movie.add(Image::rgb(64, 65)); }), Outcome::Usage);
    }
    EXPECT_EQ(outcome([&] { Mp4Writer(folder.file("a.mp4"), 64, 64).finish(); }), Outcome::Usage);
    EXPECT_EQ(folder.count(), 0);
}

// A program of the same name that fails at once stands for a broken ffmpeg; an empty PATH for none.
TEST(Mp4, ReportsAnFfmpegThatFailsOrIsMissing) {
    const TestFolder folder("mp4");
    std::filesystem::create_directories(folder.file("bin"));
    put(folder.file("bin/ffmpeg"), "#!/bin/sh\necho 'no such encoder' >&2\nexit 7\n");
    std::filesystem::permissions(folder.file("bin/ffmpeg"), std::filesystem::perms::owner_all);
    const std::string before = std::getenv("PATH") ? std::getenv("PATH") : "";
    auto message = [&](const std::string& path) -> std::string {
        ::setenv("PATH", path.c_str(), 1);
        std::string text = "no error";
        try {
            Mp4Writer movie(folder.file("a.mp4"), 512, 512);
            for (int i = 0; i < 20; ++i) movie.add(Image::rgb(512, 512));
            movie.finish();
        } catch (const Error& e) {
            text = e.kind() == ErrorKind::Resource ? e.what() : "another kind";
        }
        ::setenv("PATH", before.c_str(), 1);
        return text;
    };
    EXPECT_NE(message(folder.file("bin")).find("no such encoder"), std::string::npos);
    EXPECT_NE(message(folder.file("nowhere")).find("install the package ffmpeg"),
              std::string::npos);
    EXPECT_EQ(folder.count(), 1);  // the folder bin
}

}  // namespace
}  // namespace gischt
