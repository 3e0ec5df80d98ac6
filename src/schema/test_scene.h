// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "schema/table.h"
#include "schema/toml.h"

// A small scene with one of every kind of parameter, for the tests of this room.
namespace gischt::test {

enum class Advection { SemiLagrangian, MacCormack };

struct Domain {
    int resolution = 64;
    Vec3d size{1, 1, 2};
    bool operator==(const Domain&) const = default;
};

struct Medium {
    Keyed<Vec3d> extinction = Vec3d(0.0);
    double g = 0;
    bool operator==(const Medium&) const = default;
};

struct Common {
    std::string name;
    double start = 0;
    bool operator==(const Common&) const = default;
};

struct Fluid : Common {
    std::string file;
    Keyed<double> buoyancy = 1.0;
    Advection advection = Advection::MacCormack;
    std::optional<double> time_step;
    std::vector<double> levels{0.5, 0.25};
    bool sparse = true;
    Domain domain;
    std::optional<Medium> medium;
    bool operator==(const Fluid&) const = default;
};

struct Sun {
    Vec3d radiance{1, 1, 1};
    double angle = 0.53;
    bool operator==(const Sun&) const = default;
};
struct Point {
    Vec3d position;
    bool operator==(const Point&) const = default;
};
using Light = std::variant<Sun, Point>;

struct Camera {
    Vec3d position;
    float fov_degrees = 0.1f;
    bool operator==(const Camera&) const = default;
};

struct Scene {
    std::vector<Fluid> fluids;
    std::vector<Light> lights;
    Light ambient = Point{};
    Camera camera;
    std::int64_t seed = 1;
    bool operator==(const Scene&) const = default;
};

inline const Table<Domain>& domain_table() {
    static const Table<Domain> table =
        Table<Domain>("domain", "The box of cells")
            .add("resolution", &Domain::resolution,
                 {.help = "Cells along the longest edge", .min = 1, .max = 4096})
            .add("size", &Domain::size, {.unit = "m", .help = "Edges", .min = 0, .min_open = true})
            .check([](const Domain& d, const Fail& fail) {
                if (d.size.x > 100 * d.size.z) fail("size", "must not be as flat");
            });
    return table;
}

inline const Table<Medium>& medium_table() {
    static const Table<Medium> table =
        Table<Medium>("medium", "What the fluid does to light")
            .add("extinction", &Medium::extinction,
                 {.unit = "1/m", .help = "At density 1", .min = 0, .broadcast = true})
            .add("g", &Medium::g,
                 {.help = "Mean cosine | of scattering",
                  .min = -1,
                  .max = 1,
                  .min_open = true,
                  .max_open = true});
    return table;
}

inline const Table<Common>& common_table() {
    static const Table<Common> table = Table<Common>("common", "")
                                           .add("name", &Common::name)
                                           .add("start", &Common::start, {.unit = "s"});
    return table;
}

inline const Table<Fluid>& fluid_table() {
    static const Table<Fluid> table =
        Table<Fluid>("fluid", "A named fluid")
            .base(common_table())
            .add("file", &Fluid::file)
            .add("buoyancy", &Fluid::buoyancy, {.unit = "m/s^2", .min = -100, .max = 100})
            .choice("advection", &Fluid::advection,
                    {{"semi_lagrangian", Advection::SemiLagrangian, "smooth"},
                     {"maccormack", Advection::MacCormack, "sharp"}})
            .add("time_step", &Fluid::time_step, {.unit = "s", .min = 0, .min_open = true})
            .add("levels", &Fluid::levels, {.max = 1})
            .add("sparse", &Fluid::sparse)
            .sub("domain", &Fluid::domain, domain_table())
            .sub("medium", &Fluid::medium, medium_table())
            .check([](const Fluid& f, const Fail& fail) {
                if (f.time_step && *f.time_step > 1) fail("time_step", "must be below a frame");
                if (f.levels.empty()) fail("", "needs a level", "add levels = [0.5]");
            });
    return table;
}

inline const Variants<Light>& light_table() {
    static const Table<Sun> sun =
        Table<Sun>("sun", "A distant disc")
            .add("radiance", &Sun::radiance, {.min = 0, .broadcast = true})
            .add("angle", &Sun::angle);
    static const Table<Point> point =
        Table<Point>("point", "A small bulb").add("position", &Point::position, {.unit = "m"});
    static const Variants<Light> lights =
        Variants<Light>("light", "What shines").add("sun", sun).add("point", point);
    return lights;
}

inline const Table<Scene>& scene_table() {
    static const Table<Camera> camera =
        Table<Camera>("camera", "The eye")
            .add("position", &Camera::position, {.unit = "m", .required = true})
            .add("fov_degrees", &Camera::fov_degrees);
    static const Table<Scene> table = Table<Scene>("scene", "A world")
                                          .list("fluid", &Scene::fluids, fluid_table())
                                          .list("light", &Scene::lights, light_table())
                                          .sub("ambient", &Scene::ambient, light_table())
                                          .sub("camera", &Scene::camera, camera)
                                          .add("seed", &Scene::seed, {.min = 0});
    return table;
}

inline Scene read_scene(const std::string& text) {
    return read(parse_toml(text, "plume.toml"), scene_table(), "");
}

// The message of the Error{Usage} that f throws; empty when it throws none.
inline std::string message_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Usage);
        return e.what();
    }
    return "";
}

inline std::string scene_error(const std::string& text) {
    return message_of([&] { read_scene(text); });
}

}  // namespace gischt::test
