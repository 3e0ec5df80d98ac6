// SPDX-License-Identifier: Apache-2.0
#include "studio/flipbook.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/color.h"
#include "io/image_file.h"
#include "schema/toml.h"
#include "studio/flipbook_codes.h"
#include "studio/flipbook_view.h"

namespace gischt {
namespace {
namespace fs = std::filesystem;

LoadedScene scene_of(const std::string& text) {
    return load_scene_tree("test", parse_toml(text, "t"), "", {});
}

// An orthographic camera of 2 m height from the front: x to the right, z up, y away from it.
constexpr const char* from_front = R"(
[camera]
type = "orthographic"
height = 2
position = [0, -5, 0]
target = [0, 0, 0]
[render]
method = "march"
spp = 4
[render.march]
step_depth = 0.05
light_cache = false
[film]
filter = "box"
)";
std::string ball(const std::string& keys) {
    return "fps = 10\nframes = [1, 1]\n[[medium]]\ntype = \"sphere\"\n" + keys + from_front;
}

FlipbookOrder order_of(int frames, Vec2i cell) {
    FlipbookOrder order;
    order.frames = {1, frames, 1};
    order.cell = cell;
    return order;
}

Flipbook book_of(const LoadedScene& scene, const FlipbookOrder& order) {
    Job job;
    RunStatistics run;
    return render_flipbook(scene, order, run, job);
}

float at(const Image& image, const char* channel, int x, int y) {
    return image.channel(channel)[image.index(x, y)];
}

// Light that comes from the camera's right is brightest on the right; light from the left is its
// mirror image, light from below that of the light from above.
TEST(LightMaps, ComeFromWhereTheirNameSays) {
    const LoadedScene scene = scene_of(ball("radius = 0.8\nextinction = 12\nalbedo = 1\n"));
    FlipbookOrder order = order_of(1, {32, 32});
    order.layers = {false, false, false, false, true};
    const Flipbook book = book_of(scene, order);
    const Image& light = *book.light;
    constexpr int near = 7, middle = 16, far = 24;
    EXPECT_GT(at(light, "right", far, middle), 5 * at(light, "right", near, middle));
    EXPECT_GT(at(light, "left", near, middle), 5 * at(light, "left", far, middle));
    EXPECT_GT(at(light, "top", middle, near), 5 * at(light, "top", middle, far));
    EXPECT_GT(at(light, "bottom", middle, far), 5 * at(light, "bottom", middle, near));
    EXPECT_GT(at(light, "front", middle, middle), 20 * at(light, "back", middle, middle));
    double difference = 0, sum = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const auto right = double(at(light, "right", x, y));
            const auto left = double(at(light, "left", 31 - x, y));
            difference += std::abs(right - left);
            sum += right + left;
            difference += std::abs(double(at(light, "top", x, y) - at(light, "bottom", x, 31 - y)));
            sum += double(at(light, "top", x, y) + at(light, "bottom", x, 31 - y));
        }
    }
    EXPECT_GT(sum, 10);
    EXPECT_LT(difference / sum, 0.02);  // four samples per pixel at its edge
}

// Single scattering in a wall of optical depth 4, isotropic, albedo w, under 1 W/m^2. From the
// front w / (4 pi) integral e^(-2 t) dt, from the back w / (4 pi) 4 e^-4; the maps hold pi times
// that: w (1 - e^-8) / 8 and w e^-4.
TEST(LightMaps, AreNormalizedToAWhiteWall) {
    const LoadedScene scene = scene_of(
        "frames = [1, 1]\n[[medium]]\ntype = \"box\"\nsize = [9, 0.5, 9]\nextinction = 8\n"
        "albedo = 0.6\n" +
        std::string(from_front));
    FlipbookOrder order = order_of(1, {8, 8});
    order.layers = {false, false, false, false, true};
    const Flipbook book = book_of(scene, order);
    // The sun is half a degree wide and the march steps by an optical depth of 0.05.
    EXPECT_NEAR(at(*book.light, "front", 4, 4), 0.6 * (1 - std::exp(-8.0)) / 8, 0.005 * 0.075);
    EXPECT_NEAR(at(*book.light, "back", 4, 4), 0.6 * std::exp(-4.0), 0.005 * 0.6 * std::exp(-4.0));
    EXPECT_NEAR(at(*book.light, "A", 4, 4), 1 - std::exp(-4.0), 2e-3);
}

// What scatters all light, under a tracer that follows it long, sends back about as much as the
// white wall: between it and the 1.057 of a half space (H(1)^2 / 8, Chandrasekhar 1950).
TEST(LightMaps, AThickWhiteCloudIsAboutAsBrightAsTheWall) {
    const LoadedScene scene = scene_of(
        "frames = [1, 1]\n[[medium]]\ntype = \"box\"\nsize = [400, 40, 400]\nextinction = 1\n"
        "albedo = 1\n" +
        std::string(R"(
[camera]
type = "orthographic"
height = 2
position = [0, -50, 0]
target = [0, 0, 0]
[render]
method = "path"
spp = 64
depth = 300
)"));
    FlipbookOrder order = order_of(1, {4, 4});
    order.layers = {false, false, false, false, true};
    const Flipbook book = book_of(scene, order);
    double mean = 0;
    for (const float v : book.light->channel("front")) mean += double(v) / 16;
    EXPECT_NEAR(mean, 1.0, 0.1);
}

TEST(Flipbook, HasNoBackgroundNoSolidsAndOneCamera) {
    const LoadedScene scene =
        scene_of(ball("radius = { t = [0, 0.3], v = [0.4, 0.7] }\nextinction = 50\n") +
                 "[[light]]\ntype = \"constant\"\nradiance = 1\n[[light]]\ntype = \"sun\"\n"
                 "[[solid]]\ntype = \"ground\"\n[[medium]]\ntype = \"height_fog\"\n");
    FlipbookOrder order = order_of(3, {32, 32});
    order.layers = flipbook_layers({"color"});
    const Flipbook book = book_of(scene, order);
    ASSERT_EQ(book.layout.columns, 2);
    ASSERT_EQ(book.layout.rows, 2);
    double covered[4] = {};
    for (int cell = 0; cell < 4; ++cell) {
        const Vec2i c = book.layout.corner(cell);
        EXPECT_EQ(at(*book.color, "A", c.x, c.y), 0);
        EXPECT_EQ(at(*book.color, "R", c.x, c.y), 0);
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x)
                covered[cell] += double(at(*book.color, "A", c.x + x, c.y + y));
        }
    }
    // Balls of 0.5, 0.6 and 0.7 m in cells of 2 m: their discs, but for thin edges.
    for (int cell = 0; cell < 3; ++cell) {
        const double radius = 16 * (0.5 + 0.1 * cell);
        EXPECT_NEAR(covered[cell] / (3.14159 * radius * radius), 1, 0.06) << cell;
    }
    EXPECT_EQ(covered[3], 0) << "a cell without frame is clear";
    EXPECT_FALSE(book.glow);
}

TEST(Flipbook, FitsAllFrames) {
    // It goes from (-2, 0, 0) to (4, 0, 3) m; the picture is 7 x 4 m and its margins.
    LoadedScene scene = scene_of(
        "fps = 1\nframes = [1, 2]\n[[medium]]\ntype = \"sphere\"\nradius = 0.5\nextinction = 100\n"
        "center = { t = [1, 2], v = [[-2, 0, 0], [4, 0, 3]] }\n[render]\nmethod = \"march\"\n");
    FlipbookOrder order = order_of(2, {48, 48});
    order.layers = flipbook_layers({"color"});
    const Flipbook book = book_of(scene, order);
    EXPECT_EQ(book.camera.projection, Projection::Orthographic);
    EXPECT_NEAR(book.camera.height.at(0), 7 / 0.94, 0.1);
    EXPECT_NEAR(book.camera.target.at(0).x, 1, 0.05);
    EXPECT_NEAR(book.camera.target.at(0).z, 1.5, 0.05);
    for (const int cell : {0, 1}) {
        const Vec2i c = book.layout.corner(cell);
        for (int i = 0; i < 48; ++i) {
            EXPECT_EQ(at(*book.color, "A", c.x + i, c.y), 0);
            EXPECT_EQ(at(*book.color, "A", c.x + i, c.y + 47), 0);
            EXPECT_EQ(at(*book.color, "A", c.x, c.y + i), 0);
            EXPECT_EQ(at(*book.color, "A", c.x + 47, c.y + i), 0);
        }
    }
}

// Root of the mean square of the differences of two cells.
double step_between(const Flipbook& book, int a, int b) {
    const Vec2i p = book.layout.corner(a), q = book.layout.corner(b);
    double sum = 0;
    for (int y = 0; y < book.layout.cell_height; ++y) {
        for (int x = 0; x < book.layout.cell_width; ++x) {
            const auto d = double(at(*book.color, "A", p.x + x, p.y + y) -
                                  at(*book.color, "A", q.x + x, q.y + y));
            sum += d * d;
        }
    }
    return std::sqrt(sum / (book.layout.cell_width * book.layout.cell_height));
}

TEST(Flipbook, TheLastCellLeadsToTheFirst) {
    const LoadedScene scene =
        scene_of(ball("radius = 0.3\nextinction = 30\n"
                      "center = { t = [0.1, 1.2], v = [[-0.5, 0, 0], [0.5, 0, 0]] }\n"));
    FlipbookOrder order = order_of(12, {32, 32});
    order.layers = flipbook_layers({"color"});
    const Flipbook cut = book_of(scene, order);
    double usual = 0;
    for (int c = 0; c < 11; ++c) usual = std::max(usual, step_between(cut, c, c + 1));
    EXPECT_GT(step_between(cut, 11, 0), 2 * usual);

    order.loop = 5;
    const Flipbook loop = book_of(scene, order);
    ASSERT_EQ(loop.cells, 7);
    usual = 0;
    for (int c = 0; c < 6; ++c) usual = std::max(usual, step_between(loop, c, c + 1));
    EXPECT_LE(step_between(loop, 6, 0), 1.02 * usual);
}

// A cube of 4 m that moves at (1, 2, 3) m/s before an orthographic camera of 8 m and 32 pixels
// with a pixel of 0.25 m, at 10 frames/s, every second of which is taken: (0.8, -2.4) pixels.
TEST(Flipbook, MotionIsTheVelocityInPixelsPerCell) {
    const LoadedScene scene = scene_of(
        "fps = 10\n[fluid]\ntype = \"file\"\nfile = \"a.vdb\"\n[fluid.medium]\nextinction = 2\n"
        "[camera]\ntype = \"orthographic\"\nheight = 8\nposition = [0, -9, 0]\n"
        "target = [0, 0, 0]\n");
    auto frame = std::make_shared<Frame>();
    const auto field = [](const std::vector<float>& values, int cells) {
        Field f;
        for (const float v : values) f.component.emplace_back(TileMap::box(Vec3i(cells)), v);
        f.to_world = Transform::scale_translate(0.5, Vec3d(-0.25 * cells));
        return f;
    };
    frame->fields["density"] = field({1}, 8);
    frame->fields["velocity"] = field({1, 2, 3}, 16);
    Job job;
    const Scene sprite = sprite_scene(scene.scene, {32, 32});
    const View view = World(sprite, job).view({frame}, 1, job);
    const Image traced = trace_motion(view, 2, job);
    const float a = at(traced, "A", 16, 16);
    EXPECT_GT(a, 0.99f);
    EXPECT_NEAR(at(traced, "motion.X", 16, 16) / a, 0.8f, 1e-3f);
    EXPECT_NEAR(at(traced, "motion.Y", 16, 16) / a, -2.4f, 3e-3f);
    // The mean depth of opacity behind the face at 7 m, the extinction being 2/m.
    EXPECT_NEAR(at(traced, "Z", 16, 16) / a, 7.5f, 0.06f);
    EXPECT_EQ(at(traced, "A", 1, 1), 0);
}

TEST(Flipbook, RefusesBadOrdersBeforeTheWork) {
    const LoadedScene scene = scene_of(ball("radius = 1\n"));
    const auto refuses = [&](auto&& change) {
        FlipbookOrder order = order_of(8, {16, 16});
        change(order);
        Job job;
        RunStatistics run;
        try {
            render_flipbook(scene, order, run, job);
        } catch (const Error& e) {
            return e.kind() == ErrorKind::Usage && !e.hint().empty();
        }
        return false;
    };
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.outputs = {"x.jpg"}; }));
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.outputs = {"x"}; }));
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.grid = Vec2i{2, 3}; }));
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.grid = Vec2i{0, 3}; }));
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.cell = {16385, 1}; }));
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.loop = 5; }));
    EXPECT_TRUE(refuses([](FlipbookOrder& o) { o.emission_asked = true; }));
    EXPECT_THROW(flipbook_layers({"colour"}), Error);
    EXPECT_THROW(
        book_of(scene_of("[[medium]]\ntype = \"sphere\"\nextinction = 0\n"), order_of(1, {16, 16})),
        Error)
        << "nothing to see";
}

class FlipbookFiles : public testing::Test {
  protected:
    FlipbookFiles() : folder(fs::temp_directory_path() / "gischt_flipbook_files") {
        fs::remove_all(folder);
    }
    ~FlipbookFiles() override { fs::remove_all(folder); }

    nlohmann::json write(const LoadedScene& scene, FlipbookOrder order) {
        order.outputs = {(folder / "ball.png").string(), (folder / "ball.exr").string()};
        Job job;
        RunStatistics run;
        written = write_flipbook(scene, order, render_flipbook(scene, order, run, job), run, job);
        std::ifstream in(folder / "ball.json");
        return nlohmann::json::parse(in);
    }

    fs::path folder;
    std::vector<std::string> written;
};

TEST_F(FlipbookFiles, AreDescribedByTheirJson) {
    const LoadedScene scene = scene_of(
        ball("radius = 0.7\nextinction = 3\nemission = \"blackbody\"\ntemperature = 1600\n"));
    FlipbookOrder order = order_of(5, {16, 8});
    order.frames.step = 2;
    order.grid = Vec2i{2, 3};
    const auto json = write(scene, order);
    EXPECT_EQ(written.size(), 6u * 2 + 1);
    EXPECT_EQ(json["sheet"]["width"], 32);
    EXPECT_EQ(json["sheet"]["height"], 24);
    EXPECT_EQ(json["grid"]["columns"], 2);
    EXPECT_EQ(json["grid"]["rows"], 3);
    EXPECT_EQ(json["cells"], 3);
    EXPECT_EQ(json["cells_per_second"], 5);
    EXPECT_EQ(json["frames"]["last"], 5);
    EXPECT_EQ(json["alpha"], "straight");
    EXPECT_EQ(json["camera"]["projection"], "orthographic");
    EXPECT_EQ(json["layers"]["light_a"]["R"], "right");
    EXPECT_EQ(json["layers"]["light_b"]["A"], "emissive");
    for (const char* layer : {"color", "emission", "depth", "motion", "light_a", "light_b"}) {
        for (const char* format : {"png", "exr"}) {
            const std::string file = json["layers"][layer][format]["file"];
            EXPECT_EQ(file, std::string("ball_") + layer + "." + format);
            const Image image = read_image((folder / file).string());
            EXPECT_EQ(image.width, 32);
            EXPECT_EQ(image.height, 24);
        }
    }
    // What PNG and EXR say of the depth is the same, within the half of a code.
    const auto& depth = json["layers"]["depth"]["png"];
    const double near = depth["near"], far = depth["far"];
    const Image coded = read_image((folder / "ball_depth.png").string());
    const Image metres = read_image((folder / "ball_depth.exr").string());
    EXPECT_GE(near, 4.29);
    EXPECT_LT(far, 5.01);
    const double code = double(srgb_encode(at(coded, "R", 8, 4)));
    EXPECT_NEAR(near + code * (far - near), double(at(metres, "Z", 8, 4)),
                0.51 / 255 * (far - near));
    EXPECT_EQ(at(coded, "R", 0, 0), 1);
    EXPECT_TRUE(std::isinf(at(metres, "Z", 0, 0)));
    // Emission too, at the precision of sRGB codes.
    const double scale = json["layers"]["emission"]["png"]["scale"];
    const Image shown = read_image((folder / "ball_emission.png").string());
    const Image radiance = read_image((folder / "ball_emission.exr").string());
    EXPECT_GT(at(radiance, "R", 8, 4), 0);
    EXPECT_NEAR(double(at(shown, "R", 8, 4)) * scale / double(at(radiance, "R", 8, 4)), 1, 0.01);
}

TEST_F(FlipbookFiles, StraightTimesCoverageIsPremultiplied) {
    const LoadedScene scene = scene_of(ball("radius = 0.7\nextinction = 2\n") +
                                       "[[light]]\ntype = \"sun\"\nazimuth_degrees = 70\n");
    FlipbookOrder order = order_of(1, {24, 24});
    order.layers = flipbook_layers({"color"});
    write(scene, order);
    const Image straight = read_exr((folder / "ball_color.exr").string());
    order.premultiplied = true;
    EXPECT_EQ(write(scene, order)["alpha"], "premultiplied");
    const Image product = read_exr((folder / "ball_color.exr").string());
    for (std::size_t i = 0; i < straight.pixel_count(); ++i) {
        const float a = product.channel("A")[i];
        EXPECT_EQ(straight.channel("A")[i], a);
        EXPECT_NEAR(straight.channel("R")[i] * (a < least_coverage ? 0 : a),
                    product.channel("R")[i], 2e-3f);
    }
}

// A white of 1 under the linear curve: half of it shows, and half of the light is there.
TEST(SheetCodes, TheToneCurveSeesTheLightNotTheCoverage) {
    Image image = Image::rgba(1, 1);
    const std::array<float, 4> half{0.25f, 0.5f, 0, 0.5f};
    for (std::size_t c = 0; c < 4; ++c) image.planes[c].values[0] = half[c];
    using Codes = std::vector<std::uint16_t>;
    EXPECT_EQ(color_codes(image, ToneKind::Linear, 0, true).codes, (Codes{137, 188, 0, 128}));
    EXPECT_EQ(color_codes(image, ToneKind::Linear, 1, false).codes, (Codes{188, 255, 0, 128}));
    const auto premultiplied = color_codes(image, ToneKind::Filmic, 0, true).codes;
    for (std::size_t c = 0; c < 3; ++c) image.planes[c].values[0] /= 0.5f;
    const auto straight = color_codes(image, ToneKind::Filmic, 0, false).codes;
    for (std::size_t c = 0; c < 3; ++c) {
        const float shown = 0.5f * srgb_decode(float(straight[c]) / 255);
        EXPECT_NEAR(255 * srgb_encode(shown), premultiplied[c], 1);
    }
    EXPECT_EQ(data_codes(image, {"R", "A", "B"}).codes, (Codes{128, 128, 0}));
    EXPECT_EQ(light_codes(image, 2).codes, (Codes{137, 188, 0}));
}

}  // namespace
}  // namespace gischt
