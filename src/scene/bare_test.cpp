// SPDX-License-Identifier: Apache-2.0
#include "scene/bare.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "image/color.h"
#include "io/vdb.h"
#include "optics/blackbody.h"
#include "scene/world.h"

namespace gischt {
namespace {

constexpr int cells = 16;

// A ball of radius 0.8 in [-1,1]^3 with an even core, around which the value falls to `rim`.
Field ball(float middle, float rim, float outside = 0) {
    Field f;
    f.component.emplace_back(TileMap::box(Vec3i(cells)), outside);
    f.background[0] = outside;
    f.to_world = Transform::scale_translate(2.0 / cells, Vec3d(-1));
    for (int i = 0; i < cells * cells * cells; ++i) {
        const Vec3i c(i % cells, i / cells % cells, i / cells / cells);
        const double r = length(f.to_world.point(Vec3d(c) + Vec3d(0.5))) / 0.8;
        const double s = std::max(0.0, (r - 0.3) / 0.7);
        if (r < 1) f.component[0].ref(c) = static_cast<float>(middle + (rim - middle) * s);
    }
    return f;
}

class Bare : public testing::Test {
  protected:
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    LoadedScene load(const Frame& frame, const std::string& preset = "") {
        const std::string file = (folder_ / "v.vdb").string();
        write_vdb(file, frame, {}, job_);
        BareRequest request;
        request.file = file;
        request.preset = preset;
        return load_bare(request, job_);
    }
    MediumParams medium(const LoadedScene& s) { return common_of(s.scene.fluids.at(0)).medium; }
    // Kelvin where the field that glows has a value.
    double kelvin(const LoadedScene& s, double value) {
        const Vec2d range = medium(s).temperature_range.value();
        return range.x + (range.y - range.x) * value;
    }

    Job job_;
    std::filesystem::path folder_ = std::filesystem::temp_directory_path() / "gischt_bare_test";
};

TEST_F(Bare, AFlameBurnsFromBlackToYellowWhateverItsScale) {
    for (const float largest : {0.5f, 1.0f, 40.0f}) {
        Frame frame;
        frame.fields["density"] = ball(1, 0.5f);
        frame.fields["flame"] = ball(largest, 0.2f * largest);
        const LoadedScene s = load(frame);
        EXPECT_EQ(medium(s).emission, EmissionKind::Flame);
        EXPECT_EQ(medium(s).emission_field, "flame");
        EXPECT_NEAR(kelvin(s, 0), 800, 1);
        EXPECT_NEAR(kelvin(s, static_cast<double>(largest)), 1900, 40);
    }
}

TEST_F(Bare, TheExposureLeavesColourInTheFire) {
    // The same fire, ten thousand times as bright.
    for (const double bright : {1.0, 1e4}) {
        Frame frame;
        frame.fields["density"] = ball(1, 0.5f);
        frame.fields["flame"] = ball(1, 0.2f);
        const std::string file = (folder_ / "v.vdb").string();
        write_vdb(file, frame, {}, job_);
        BareRequest request;
        request.file = file;
        request.overrides = {"medium.emission_scale=" + std::to_string(bright), "film.width=64",
                             "film.height=48"};
        const LoadedScene s = load_bare(request, job_);
        World world(s.scene);
        const View view = world.view({std::make_shared<const Frame>(std::move(frame))}, 1, job_);
        RenderSettings settings;
        settings.samples_per_pixel = 1;
        const Image image =
            make_method("march", s.scene.render.methods)->render(view, settings, job_).image;
        const auto gain = static_cast<float>(std::exp2(s.scene.film.exposure));
        const std::size_t middle = image.index(32, 24);
        const float red = gain * image.color()[0][middle], blue = gain * image.color()[2][middle];
        EXPECT_GT(red, 0.8f);
        EXPECT_LT(red, 10);  // of the tone curve's 16
        EXPECT_LT(blue, 0.3f * red);
    }
}

TEST_F(Bare, FireNeedsNoFlame) {
    Frame frame;
    frame.fields["density"] = ball(1, 0.5f);
    const LoadedScene soot = load(frame, "fire");
    EXPECT_EQ(medium(soot).emission_field, "density");
    EXPECT_NEAR(kelvin(soot, 1), 1900, 60);

    // Warm air glows as if its warmest place were a flame; its surroundings stay dark.
    frame.fields["temperature"] = ball(500, 320, static_cast<float>(ambient_temperature));
    const LoadedScene warm = load(frame, "fire");
    EXPECT_EQ(medium(warm).emission_field, "temperature");
    EXPECT_NEAR(kelvin(warm, 500), 1900, 80);
    EXPECT_LT(luminance(blackbody_radiance(kelvin(warm, ambient_temperature + 0.1))),
              1e-9f * luminance(blackbody_radiance(1900)));

    // What is really hot glows at its own temperature.
    frame.fields["temperature"] = ball(1600, 600, static_cast<float>(ambient_temperature));
    const LoadedScene hot = load(frame, "fire");
    EXPECT_EQ(medium(hot).emission, EmissionKind::Blackbody);
    EXPECT_FALSE(medium(hot).temperature_range.has_value());
}

TEST_F(Bare, RefusesWhatHasNothingToShow) {
    Frame empty;
    Field nothing;
    nothing.component.emplace_back(TileMap::sparse({}, {{}, Vec3i(8)}));
    empty.fields["density"] = nothing;
    Frame black;
    black.fields["density"] = ball(0, 0);
    for (const Frame& frame : {empty, black}) {
        try {
            load(frame);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            EXPECT_NE(std::string(e.what()).find("density"), std::string::npos) << e.what();
        }
    }
}

}  // namespace
}  // namespace gischt
