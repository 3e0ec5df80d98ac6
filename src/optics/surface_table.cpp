// SPDX-License-Identifier: Apache-2.0
#include "optics/surface.h"

namespace gischt {
namespace {

const Table<Material>& material_table() {
    static const Table<Material> table =
        Table<Material>("material", "An opaque surface that scatters light evenly (Lambert)")
            .add("albedo", &Material::albedo,
                 {.help = "Share of the light that is reflected",
                  .min = 0,
                  .max = 1,
                  .broadcast = true})
            .add("checker", &Material::checker,
                 {.help = "Albedo of every other field of a checker board",
                  .min = 0,
                  .max = 1,
                  .broadcast = true})
            .add("checker_size", &Material::checker_size,
                 {.unit = "m", .help = "Edge of a field; 0 for no checker board", .min = 0})
            .add("emission", &Material::emission,
                 {.unit = "W/(m^2 sr)",
                  .help = "Radiance that the surface gives off by itself",
                  .min = 0,
                  .broadcast = true});
    return table;
}

const Table<SphereSurface>& sphere_table() {
    static const Table<SphereSurface> table =
        Table<SphereSurface>("sphere", "A ball")
            .add("name", &SphereSurface::name, {.help = "For messages and --set"})
            .add("center", &SphereSurface::center, {.unit = "m", .help = "The middle"})
            .add("radius", &SphereSurface::radius,
                 {.unit = "m", .help = "The radius", .min = 0, .min_open = true})
            .flat(&SphereSurface::material, material_table());
    return table;
}

const Table<BoxSurface>& box_table() {
    static const Table<BoxSurface> table =
        Table<BoxSurface>("box", "A box")
            .add("name", &BoxSurface::name, {.help = "For messages and --set"})
            .add("center", &BoxSurface::center, {.unit = "m", .help = "The middle"})
            .add("size", &BoxSurface::size,
                 {.unit = "m", .help = "Lengths of the edges", .min = 0, .min_open = true})
            .add("rotation_degrees", &BoxSurface::rotation_degrees,
                 {.unit = "degrees", .help = "Turned around x, then y, then z"})
            .flat(&BoxSurface::material, material_table());
    return table;
}

const Table<GroundSurface>& ground_table() {
    static const Table<GroundSurface> table =
        Table<GroundSurface>("ground", "A plane without end")
            .add("name", &GroundSurface::name, {.help = "For messages and --set"})
            .add("point", &GroundSurface::point, {.unit = "m", .help = "A point of the plane"})
            .add("normal", &GroundSurface::normal,
                 {.help = "Which way is out; the scene's up axis when not given"})
            .flat(&GroundSurface::material, material_table());
    return table;
}

}  // namespace

const Variants<SurfaceParams>& surface_variants() {
    static const Variants<SurfaceParams> variants =
        Variants<SurfaceParams>("surface", "An opaque solid that casts and receives shadow")
            .add("sphere", sphere_table())
            .add("box", box_table())
            .add("ground", ground_table());
    return variants;
}

}  // namespace gischt
