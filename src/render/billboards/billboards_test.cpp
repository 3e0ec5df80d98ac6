// SPDX-License-Identifier: Apache-2.0
#include "render/billboards/billboards.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "render/billboards/billboard_drawer.h"
#include "render/billboards/sprite.h"
#include "render/points/points.h"
#include "render/realtime/test_scenes.h"

namespace gischt {
namespace {

struct Dot {
    Vec3d place;
    Vec3f color{1, 1, 1};
    float opacity = 1, radius = 0.1f;
    Vec3f velocity{};
};

Frame frame_of(const std::vector<Dot>& dots) {
    Frame frame;
    Particles& p = frame.particles["dots"];
    p.resize(dots.size());
    p.color.resize(dots.size());
    p.opacity.resize(dots.size());
    for (std::size_t i = 0; i < dots.size(); ++i) {
        p.position[i] = dots[i].place;
        p.color[i] = dots[i].color;
        p.opacity[i] = dots[i].opacity;
        p.radius[i] = dots[i].radius;
        p.velocity[i] = dots[i].velocity;
        p.age[i] = 0;
        p.life[i] = 1;
        p.id[i] = i;
    }
    return frame;
}

// Looks along +y.
View view_of(const std::vector<Dot>& dots) {
    View view;
    view.frames = {std::make_shared<const Frame>(frame_of(dots))};
    view.camera = test_camera({0, -3, 0}, 65, 65, 20);
    view.background = Vec3f(0.25f, 0.5f, 0.75f);
    return view;
}

BillboardsParams plain(BlendPreset preset, SpriteKind sprite = SpriteKind::Disc) {
    BillboardsParams p;
    p.draw.shading.shading = ParticleShading::Plain;
    p.draw.blend.preset = preset;
    p.sprite = sprite;
    p.soft_fade = 0;
    return p;
}

Image picture(const View& view, const BillboardsParams& params) {
    Job job;
    return make_billboards_method(params)->render(view, test_settings(1), job).image;
}

Vec3d middle(const Image& image) {
    const auto rgb = image.color();
    const std::size_t i = image.index(image.width / 2, image.height / 2);
    return {static_cast<double>(rgb[0][i]), static_cast<double>(rgb[1][i]),
            static_cast<double>(rgb[2][i])};
}

double largest_difference(const Image& a, const Image& b) {
    double most = 0;
    for (const std::string_view name : {"R", "G", "B", "A"}) {
        const auto x = a.channel(name), y = b.channel(name);
        for (std::size_t i = 0; i < x.size(); ++i) {
            most = std::max(most, static_cast<double>(std::abs(x[i] - y[i])));
        }
    }
    return most;
}

std::vector<Dot> many(int count) {
    std::vector<Dot> dots;
    for (int i = 0; i < count; ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        const auto u = [&](std::uint32_t d) { return random_uniform(d, n); };
        dots.push_back({Vec3d(Vec3f(u(1) - 0.5f, u(2) - 0.5f, u(3) - 0.5f)),
                        {u(4), u(5), u(6)},
                        0.2f + 0.6f * u(7),
                        0.02f + 0.1f * u(8)});
    }
    return dots;
}

// The same particles in another order. The number of a particle stays with it.
View turned_round(const View& view) {
    Frame frame = *view.frames[0];
    for_all_particle_arrays(frame.particles.at("dots"),
                            [](auto& array) { std::reverse(array.begin(), array.end()); });
    View other = view;
    other.frames = {std::make_shared<const Frame>(frame)};
    return other;
}

// Three discs behind each other: C = (1 - a) C + a c, the farthest first.
TEST(Billboards, CoverWhatLiesBehind) {
    const std::vector<Dot> dots{{{0, 0.5, 0}, {1, 0, 0}, 0.5f},
                                {{0, -0.5, 0}, {0, 0, 2}, 0.25f},
                                {{0, 0, 0}, {0, 1, 0}, 0.8f}};
    Vec3d expected(0.25, 0.5, 0.75);
    for (const std::size_t i : {0u, 2u, 1u}) {
        const auto a = static_cast<double>(dots[i].opacity);
        expected = (1 - a) * expected + a * Vec3d(dots[i].color);
    }
    const View view = view_of(dots);
    const BillboardsParams sorted = plain(BlendPreset::Smoke);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle(picture(view, sorted))[c], expected[c], 1e-5);
    // In the order of the arrays something else comes out.
    BillboardsParams unsorted = sorted;
    unsorted.draw.order = ParticleOrder::Unsorted;
    EXPECT_GT(length(middle(picture(view, unsorted)) - expected), 0.1);
    // Opaque ones hide each other, in any order.
    const BillboardsParams opaque = plain(BlendPreset::Opaque);
    EXPECT_NEAR(length(middle(picture(view, opaque)) - Vec3d(0, 0, 2)), 0, 1e-6);
    EXPECT_NEAR(length(middle(picture(turned_round(view), opaque)) - Vec3d(0, 0, 2)), 0, 1e-6);
    // Light adds up.
    Vec3d sum(0.25, 0.5, 0.75);
    for (const Dot& d : dots) sum += static_cast<double>(d.opacity) * Vec3d(d.color);
    EXPECT_NEAR(length(middle(picture(view, plain(BlendPreset::Additive))) - sum), 0, 1e-5);
}

TEST(Billboards, OrderMattersOnlyWhereItMust) {
    const View view = view_of(many(400)), other = turned_round(view);
    BillboardsParams p = plain(BlendPreset::Additive, SpriteKind::Soft);
    p.draw.order = ParticleOrder::Unsorted;
    EXPECT_LT(largest_difference(picture(view, p), picture(other, p)), 1e-5);
    // Sorted smoke does not depend on the order of the arrays, unsorted smoke does.
    p = plain(BlendPreset::Smoke, SpriteKind::Soft);
    EXPECT_LT(largest_difference(picture(view, p), picture(other, p)), 1e-5);
    p.draw.order = ParticleOrder::Unsorted;
    EXPECT_GT(largest_difference(picture(view, p), picture(other, p)), 0.05);
}

// The edges that the shader finds, read back from a compute shader of the same code.
struct Edges {
    Vec3d x, y;
};
Edges edges_of(const Camera& camera, int facing, const Vec3d& center, const Vec3f& velocity,
               float turn, const Vec3f& normal) {
    GlDevice& device = offscreen_device();
    const GlProgram program(device, "edges",
                            {{GlStageKind::Compute, std::string("layout(local_size_x = 1) in;\n") +
                                                        camera_glsl + billboard_glsl + R"(
layout(std430, binding = 0) buffer Out { vec4 edge[2]; };
uniform vec3 center, velocity;
uniform float turn;
void main() {
    vec3 x, y;
    billboard_edges(center, velocity, turn, x, y);
    edge[0] = vec4(x, 0);
    edge[1] = vec4(y, 0);
}
)"}});
    const GlBuffer out(device, 32);
    GlCamera(camera, {}, 1).set(program);
    program.set("facing", facing);
    program.set("center", Vec3f(center));
    program.set("velocity", velocity);
    program.set("turn", turn);
    program.set("fixed_normal", normal);
    device.bind_storage(0, out.id());
    program.use();
    device.dispatch({1, 1, 1});
    device.barrier();
    const std::vector<float> v = out.read<float>(8);
    return {Vec3d(Vec3f(v[0], v[1], v[2])), Vec3d(Vec3f(v[4], v[5], v[6]))};
}

TEST(Billboards, FaceWhatTheyShould) {
    const Vec3d center(0.1, -0.2, 0.3);
    for (int i = 0; i < 60; ++i) {
        const auto n = static_cast<std::uint32_t>(i);
        const auto u = [&](std::uint32_t d) { return 2 * random_uniform(d, n) - 1; };
        const Camera camera = test_camera(3.0 * normalize(Vec3d(Vec3f(u(1), u(2), u(3)))));
        const Vec3f velocity = 3.0f * Vec3f(u(4), u(5), u(6));
        const Vec3f normal = normalize(Vec3f(u(7), u(8), u(9)));
        for (int facing = 0; facing < 3; ++facing) {
            const Edges e = edges_of(camera, facing, center, velocity, 3 * u(10), normal);
            const Vec3d n_of = cross(e.x, e.y), view = normalize(center - camera.position());
            EXPECT_NEAR(length(e.x), 1, 1e-5);
            EXPECT_NEAR(length(e.y), 1, 1e-5);
            EXPECT_NEAR(dot(e.x, e.y), 0, 1e-5);
            EXPECT_LT(dot(n_of, view), 0);  // their front
            if (facing == 0) {              // eq. 3
                EXPECT_NEAR(length(n_of + camera.forward()), 0, 1e-5);
            } else if (facing == 1) {
                EXPECT_NEAR(length(e.x - normalize(Vec3d(velocity))), 0, 1e-5);
                EXPECT_NEAR(dot(e.y, view), 0, 1e-4);
            } else {
                EXPECT_NEAR(length(cross(n_of, Vec3d(normal))), 0, 1e-5);
            }
        }
    }
}

// A disc of known size covers its share of the picture; one that is fixed at 60 degrees half of it.
TEST(Billboards, HaveTheSizeOfTheirParticles) {
    View view = view_of({{{0, 0, 0}, {1, 1, 1}, 1, 0.3f}});
    CameraParams camera;
    camera.projection = Projection::Orthographic;
    camera.position = Keyed<Vec3d>(Vec3d(0, -3, 0));
    camera.target = Keyed<Vec3d>(Vec3d(0));
    camera.height = Keyed<double>(1.0);
    view.camera = Camera(camera, 0, 200, 200);
    view.background.reset();
    const auto coverage = [&](const BillboardsParams& p) {
        double sum = 0;
        const Image image = picture(view, p);
        for (const float a : image.channel("A")) sum += static_cast<double>(a);
        return sum / 40000;
    };
    BillboardsParams p = plain(BlendPreset::Smoke);
    const double full = coverage(p);
    EXPECT_NEAR(full, pi * 0.09 * 0.95 * 0.95, 0.005);
    p.facing = BillboardFacing::Fixed;
    p.normal = {0, -std::cos(pi / 3), std::sin(pi / 3)};
    EXPECT_NEAR(coverage(p) / full, 0.5, 0.01);
    p.facing = BillboardFacing::Camera;
    p.size = 0.5;
    EXPECT_NEAR(coverage(p) / full, 0.25, 0.01);
    Job job;
    PointsParams points;
    points.draw.shading.shading = ParticleShading::Plain;
    double sum = 0;
    const Image image = make_points_method(points)->render(view, test_settings(1), job).image;
    for (const float a : image.channel("A")) sum += static_cast<double>(a);
    EXPECT_NEAR(sum / 40000, pi * 0.09, 0.005);
    // Its depth is that of the particle.
    EXPECT_NEAR(image.channel("Z")[image.index(100, 100)], 3, 1e-4);
}

// A puff whose light is scattered evenly radiates W / (4 pi) times its colour.
TEST(Billboards, ScatterTheLightThatReachesThem) {
    View view = view_of({{{0, 0, 0}, {0.5f, 1, 0.25f}, 1, 0.3f}});
    view.lights = {test_sun({1, -1, 1}, {4, 4, 4}),
                   std::make_shared<PointLight>(Vec3d(0, -2, 0), Vec3f(8)),
                   std::make_shared<ConstantLight>(Vec3f(0.1f))};
    BillboardsParams p = plain(BlendPreset::Smoke);
    p.draw.shading.shading = ParticleShading::Lit;
    p.draw.shading.brightness = 2;
    const double radiance = 2 * ((4 + 8.0 / 4) / (4 * pi) + 0.1);
    EXPECT_NEAR(length(middle(picture(view, p)) - radiance * Vec3d(0.5, 1, 0.25)), 0, 1e-4);
    // A ball between it and the sun, which the camera does not see.
    SphereSurface ball;
    ball.center = Keyed<Vec3d>(Vec3d(2, -2, 2));
    ball.radius = Keyed<double>(0.5);
    ball.material.camera_visible = false;
    view.surfaces = SurfaceSet({ball}, 0);
    EXPECT_NEAR(middle(picture(view, p)).y, 2 * (2 / (4 * pi) + 0.1), 1e-4);
}

// Before a wall the opacity falls linearly with the distance, behind it nothing is seen.
TEST(Billboards, FadeBeforeSurfaces) {
    BoxSurface wall;
    wall.center = Keyed<Vec3d>(Vec3d(0, 1, 0));
    wall.size = {4, 1, 4};
    wall.material.albedo = Vec3d(0);
    for (const auto& [y, expected] :
         {std::pair{0.3, 1.0}, std::pair{0.4, 0.5}, std::pair{0.46, 0.2}, std::pair{0.7, 0.0}}) {
        View view = view_of({{{0, y, 0}, {1, 1, 1}, 1, 0.1f}});
        view.surfaces = SurfaceSet({wall}, 0);
        BillboardsParams p = plain(BlendPreset::Smoke);
        p.soft_fade = 2;
        EXPECT_NEAR(middle(picture(view, p)).x, expected, 2e-3) << y;
        p.soft_fade = 0;
        EXPECT_NEAR(middle(picture(view, p)).x, y < 0.5 ? 1 : 0, 1e-4) << y;
    }
}

// A sheet of 2 x 1 pictures, red and blue, over the life of a particle.
TEST(Billboards, ShowsSheets) {
    auto sheet = std::make_shared<Image>(Image::rgba(8, 4));
    const auto rgb = sheet->color();
    for (std::size_t i = 0; i < rgb[0].size(); ++i) {
        rgb[i % 8 < 4 ? 0 : 2][i] = 1;
        sheet->channel("A")[i] = 1;
    }
    View view = view_of({{{0, 0, 0}}});
    Frame frame = *view.frames[0];
    frame.particles["dots"].age[0] = 0.25f;
    view.frames = {std::make_shared<const Frame>(frame)};
    BillboardsParams p = plain(BlendPreset::Smoke);
    p.picture = sheet;
    p.sheet = {2, 1};
    EXPECT_NEAR(length(middle(picture(view, p)) - Vec3d(0.75, 0, 0.25)), 0, 1e-5);
    p.play = FlipbookPlay::Random;
    const Vec3d one = middle(picture(view, p));
    EXPECT_NEAR(std::max(one.x, one.z), 1, 1e-5);
    EXPECT_NEAR(std::min(one.x, one.z), 0, 1e-5);
    p.sheet = {3, 1};
    EXPECT_THROW(picture(view, p), Error);
    p.picture.reset();
    p.file = "nowhere.png";
    EXPECT_THROW(picture(view, p), Error);
}

TEST(Billboards, SaysWhatIsMissing) {
    View view = test_view({});
    EXPECT_THROW(picture(view, {}), Error);  // no particles at all
    view = view_of({{{0, 0, 0}}});
    BillboardsParams p;
    p.draw.shading.shading = ParticleShading::Glow;
    EXPECT_THROW(picture(view, p), Error);  // no temperature
    view = view_of({});
    const Image empty = picture(view, {});
    for (const float v : empty.channel("G")) ASSERT_EQ(v, 0.5f);
}

}  // namespace
}  // namespace gischt
