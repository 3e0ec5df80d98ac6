// SPDX-License-Identifier: Apache-2.0
#include "render/field/field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "grid/frame.h"
#include "image/display.h"
#include "render/field/legend.h"
#include "render/field/quantity.h"
#include "render/field/slice.h"
#include "render/params.h"

namespace gischt {
namespace {

// A field on a box of cells of edge h, with a value made from the cell's centre in metres.
template <class F>
Field box_field(const Vec3i& cells, double h, int components, F&& value) {
    const auto map = TileMap::box(cells);
    Field field;
    field.to_world = Transform::scale_translate(h, {0, 0, 0});
    for (int c = 0; c < components; ++c) {
        TileField<float> f(map);
        for (int k = 0; k < cells.z; ++k) {
            for (int j = 0; j < cells.y; ++j) {
                for (int i = 0; i < cells.x; ++i) {
                    const Vec3d p = h * Vec3d{i + 0.5, j + 0.5, k + 0.5};
                    f.ref({i, j, k}) = static_cast<float>(value(p)[c]);
                }
            }
        }
        field.component.push_back(std::move(f));
    }
    return field;
}

View view_of(Frame frame, int width, int height) {
    View view;
    CameraParams camera;
    view.camera = Camera(camera, 0, width, height);
    view.frames.push_back(std::make_shared<Frame>(std::move(frame)));
    return view;
}

FieldParams plain(std::string quantity) {
    FieldParams p;
    p.quantity = std::move(quantity);
    p.legend = false;
    return p;
}

Vec3f pixel(const Image& image, int x, int y) {
    const auto c = image.color();
    const std::size_t i = image.index(x, y);
    return {c[0][i], c[1][i], c[2][i]};
}

Image draw(const View& view, const FieldParams& params) {
    Job job;
    return make_field_method(params)->render(view, {}, job).image;
}

TEST(FieldMethod, ColorsAreThoseOfTheMap) {
    // 2-D: density grows from 0 at the left edge to 1 at the right one.
    Frame frame;
    frame.fields["density"] = box_field({64, 32, 1}, 1.0 / 64, 1, [](Vec3d p) { return p; });
    FieldParams params = plain("density");
    params.range = Vec2d{0, 1};
    const Image image = draw(view_of(frame, 320, 160), params);
    for (const int x : {20, 100, 160, 290}) {
        const Vec3f expected =
            colormap(ColormapKind::Viridis, (static_cast<float>(x) + 0.5f) / 320);
        const Vec3f seen = pixel(image, x, 77);
        EXPECT_NEAR(seen.x, expected.x, 2e-3) << x;
        EXPECT_NEAR(seen.y, expected.y, 2e-3) << x;
        EXPECT_NEAR(seen.z, expected.z, 2e-3) << x;
    }
    EXPECT_EQ(image.metadata.get("tone"), "linear");
    EXPECT_EQ(image.metadata.get("display_referred"), "true");
    EXPECT_EQ(image.channel("A")[5], 1);
}

// With the display options that the metadata asks for, a PNG holds the codes of the map.
TEST(FieldMethod, PngShowsTheExactCodes) {
    Frame frame;
    frame.fields["density"] = box_field({8, 8, 1}, 1, 1, [](Vec3d) { return Vec3d(0.25); });
    FieldParams params = plain("density");
    params.range = Vec2d{0, 1};
    const auto codes = to_rgb8(draw(view_of(frame, 16, 16), params),
                               {.tone = ToneKind::Linear, .exposure = 0, .dither = false});
    // viridis at 1/4: (59, 82, 139).
    EXPECT_NEAR(codes[0], 59, 2);
    EXPECT_NEAR(codes[1], 82, 2);
    EXPECT_NEAR(codes[2], 139, 2);
}

TEST(FieldMethod, KeepsTheAspectInTheMiddle) {
    Frame frame;
    frame.fields["density"] = box_field({32, 64, 1}, 0.1, 1, [](Vec3d) { return Vec3d(1); });
    const Image image = draw(view_of(frame, 200, 100), plain("density"));
    const Vec3f paper = pixel(image, 0, 0);
    int width = 0;
    for (int x = 0; x < 200; ++x) width += pixel(image, x, 50) != paper;
    EXPECT_EQ(width, 50);
    EXPECT_EQ(pixel(image, 74, 50), paper);
    EXPECT_NE(pixel(image, 75, 0), paper);
}

TEST(FieldMethod, UpIsUp) {
    Frame frame;
    frame.fields["density"] =
        box_field({16, 8, 16}, 1, 1, [](Vec3d p) { return Vec3d(p.z > 8 ? 1 : 0); });
    // The default camera looks along y: x to the right, z up.
    const Image image = draw(view_of(frame, 64, 64), plain("density"));
    EXPECT_EQ(image.metadata.get("slice"), "y = 4 m");
    const Vec3f top = pixel(image, 32, 5), bottom = pixel(image, 32, 60);
    EXPECT_GT(top.x, bottom.x);  // viridis ends in yellow
}

TEST(FieldMethod, SliceIsLinearAcrossItsNormal) {
    const Field field = box_field({4, 4, 10}, 0.5, 1, [](Vec3d p) { return Vec3d(p.z); });
    const auto value = [&](const Vec3i& c) { return field.component[0].get(c); };
    const SliceAxes axes = slice_axes(field, SliceAxis::Z, {}, {0, 0, 1});
    EXPECT_EQ(axes.normal, 2);
    for (const double z : {0.25, 1.0, 2.6, 4.75}) {
        EXPECT_NEAR(Slice(field, axes, z, value).at(1, 1, FieldInterpolation::Linear), z, 1e-6);
    }
    EXPECT_NEAR(Slice(field, axes, std::nullopt, value).position(), 2.5, 1e-12);
    EXPECT_THROW(Slice(field, axes, 5.1, value), Error);
}

TEST(FieldMethod, InterpolationsMeetTheCentresAndStayInBetween) {
    const Field field = box_field({8, 8, 1}, 1, 1, [](Vec3d p) { return Vec3d(p.x > 4 ? 1 : 0); });
    const Slice slice(field, {}, std::nullopt,
                      [&](const Vec3i& c) { return field.component[0].get(c); });
    for (const auto kind :
         {FieldInterpolation::Nearest, FieldInterpolation::Linear, FieldInterpolation::Cubic}) {
        for (int i = 0; i < 8; ++i) EXPECT_EQ(slice.at(i + 0.5, 3.5, kind), i < 4 ? 0 : 1);
        for (double x = -1; x < 9; x += 0.1) {
            EXPECT_GE(slice.at(x, 2.2, kind), 0);
            EXPECT_LE(slice.at(x, 2.2, kind), 1);
        }
    }
}

// Rigid rotation with angular velocity w: curl u = 2 w, speed = w r.
TEST(Quantity, RigidRotationHasTwiceItsAngularVelocity) {
    Frame frame;
    frame.fields["velocity"] = box_field({16, 16, 1}, 0.25, 3, [](Vec3d p) {
        return Vec3d{-3 * (p.y - 2), 3 * (p.x - 2), 0};
    });
    const Quantity vorticity = find_quantity(frame, "vorticity", 2);
    const Quantity speed = find_quantity(frame, "speed", 2);
    for (const Vec3i& c : {Vec3i{0, 0, 0}, Vec3i{7, 3, 0}, Vec3i{15, 9, 0}}) {
        EXPECT_NEAR(vorticity.at(c), 6, 1e-5);
        const double r = std::hypot(0.25 * (c.x + 0.5) - 2, 0.25 * (c.y + 0.5) - 2);
        EXPECT_NEAR(speed.at(c), 3 * r, 1e-5);
    }
    EXPECT_EQ(vorticity.unit, "1/s");
    EXPECT_TRUE(vorticity.is_signed);
    EXPECT_EQ(find_quantity(frame, "density", 2).field, nullptr);
}

TEST(FieldMethod, SaysWhatThereIsToShow) {
    Frame frame;
    frame.fields["temperature"] = box_field({8, 8, 1}, 1, 1, [](Vec3d p) { return p; });
    try {
        draw(view_of(frame, 16, 16), plain("temprature"));
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Usage);
        EXPECT_NE(e.hint().find("'temperature'"), std::string::npos) << e.hint();
    }
}

TEST(FieldMethod, SurvivesConstantEmptyAndBrokenFields) {
    Frame frame;
    frame.fields["density"] = box_field({8, 8, 1}, 1, 1, [](Vec3d) { return Vec3d(0); });
    FieldParams params;
    params.arrows = true;
    EXPECT_NO_THROW(draw(view_of(frame, 200, 100), params));
    EXPECT_NO_THROW(draw(view_of(frame, 3, 2), params));
    frame.fields["density"].component[0].ref({3, 3, 0}) = std::nanf("");
    EXPECT_NO_THROW(draw(view_of(frame, 200, 100), params));
    Field empty;
    empty.component.emplace_back(TileMap::sparse({}, Box3i{}));
    frame.fields["density"] = empty;
    EXPECT_NO_THROW(draw(view_of(frame, 200, 100), params));
    params.range = Vec2d{1, 0};
    EXPECT_THROW(draw(view_of(frame, 200, 100), params), Error);
}

TEST(Legend, TicksAreRoundAndFew) {
    const Ticks a = make_ticks(0, 1, 6);
    EXPECT_EQ(a.label, (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
    const Ticks b = make_ticks(-0.37, 0.37, 8);
    EXPECT_EQ(b.label,
              (std::vector<std::string>{"-0.3", "-0.2", "-0.1", "0.0", "0.1", "0.2", "0.3"}));
    const Ticks c = make_ticks(293.15, 1410, 5);
    EXPECT_EQ(c.label, (std::vector<std::string>{"500", "1000"}));
    const Ticks d = make_ticks(0, 3.2e-5, 8);
    EXPECT_EQ(d.exponent, -5);
    EXPECT_EQ(d.label.front(), "0.0");
    EXPECT_LE(d.at.size(), 8u);
    EXPECT_EQ(make_ticks(0, 4e7, 6).exponent, 7);
}

TEST(Methods, AreNamedAndMade) {
    EXPECT_EQ(find_method("march").name, "march");
    EXPECT_THROW(find_method("filed"), Error);
    for (const MethodInfo& m : render_methods()) {
        EXPECT_FALSE(m.simulates.empty());
        EXPECT_FALSE(m.leaves_out.empty());
        EXPECT_FALSE(m.cost.empty());
        EXPECT_TRUE(make_method(m.name, RenderParams{}));
    }
    Value table;
    table.set("field", Value()).set("quantity", "speed");
    EXPECT_EQ(read(table, render_params_table()).field.quantity, "speed");
}

}  // namespace
}  // namespace gischt
