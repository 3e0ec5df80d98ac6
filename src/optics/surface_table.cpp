// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_params.h"

namespace gischt {
namespace {

const Table<TextureParams>& texture_table() {
    static const Table<TextureParams> table =
        Table<TextureParams>("texture", "A picture on a surface")
            .add("file", &TextureParams::file,
                 {.help = "PNG (8-bit codes are decoded by the sRGB curve), EXR or HDR",
                  .required = true})
            .add("repeat", &TextureParams::repeat,
                 {.help = "How often it lies in one unit of the surface's coordinates: around and "
                          "from pole to pole of a sphere, a face of a box, a metre of the ground"});
    return table;
}

void check_material(const Material& m, const Fail& fail) {
    const bool has_interior = m.kind == MaterialKind::Dielectric || m.kind == MaterialKind::None;
    if (m.metal && m.kind != MaterialKind::Conductor) {
        fail("metal", "is for material 'conductor'");
    }
    if (m.metal && m.color) fail("color", "stands in place of 'metal'; give one of them");
    if (m.color && m.kind != MaterialKind::Conductor && m.kind != MaterialKind::Dielectric) {
        fail("color", "is for conductors and dielectrics", "others have 'albedo'");
    }
    if (!m.interior.empty() && !has_interior) {
        fail("interior", "is for material 'dielectric' or 'none'");
    }
    if (m.medium && !has_interior) fail("medium", "is for material 'dielectric' or 'none'");
    if (m.medium && !m.interior.empty()) {
        fail("medium", "stands in place of 'interior'; give one of them");
    }
    if (m.holdout && m.shadow_catcher) fail("holdout", "cannot be a shadow catcher too");
}

}  // namespace

const Table<Material>& material_table() {
    static const Table<Material> table =
        Table<Material>("material", "What a surface does to light")
            .choice(
                "material", &Material::kind,
                {{"lambert", MaterialKind::Lambert, "scatters light evenly"},
                 {"conductor", MaterialKind::Conductor, "a metal, smooth or rough"},
                 {"dielectric", MaterialKind::Dielectric, "glass or water: reflects and refracts"},
                 {"plastic", MaterialKind::Plastic, "a clear coat over an even colour"},
                 {"none", MaterialKind::None, "not seen at all: only bounds what fills it"}},
                {.help = "What happens to light at the surface"})
            .add("albedo", &Material::albedo,
                 {.help = "Share of the light that is reflected; of plastic, by what lies below "
                          "the coat; without it what the file of a mesh says, else 0.5",
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
                  .broadcast = true})
            .sub("texture", &Material::texture, texture_table(),
                 {.help = "A picture that multiplies albedo or color; without it that of the file "
                          "of a mesh, where albedo is not given either"})
            .add("roughness", &Material::roughness,
                 {.help = "Of conductor, dielectric and plastic: below 0.01 smooth, 1 very rough; "
                          "the width of the microfacets' slopes is its square",
                  .min = 0,
                  .max = 1})
            .add("ior", &Material::ior,
                 {.help = "Index of refraction inside a dielectric or of a plastic's coat: water "
                          "1.33, glass 1.5, diamond 2.42",
                  .min = 1,
                  .max = 4})
            .choice("metal", &Material::metal,
                    {{"gold", Metal::Gold},
                     {"copper", Metal::Copper},
                     {"aluminium", Metal::Aluminium},
                     {"silver", Metal::Silver},
                     {"iron", Metal::Iron},
                     {"chrome", Metal::Chrome}},
                    {.help = "Which metal a conductor is; without it, it has 'color'"})
            .add("color", &Material::color,
                 {.help = "Of a conductor: share of light reflected at normal incidence (0.9); of "
                          "a dielectric: share that passes at each crossing (1)",
                  .min = 0,
                  .max = 1,
                  .broadcast = true})
            .add("interior", &Material::interior,
                 {.help = "Name of the fluid that fills a dielectric, or what material 'none' "
                          "bounds; it is then nowhere else"})
            .sub("medium", &Material::medium, medium_table(),
                 {.help = "A homogeneous medium (density 1) that fills it, in place of a fluid"})
            .add("priority", &Material::priority,
                 {.help = "Where the insides of dielectrics overlap, the highest counts"})
            .add("holdout", &Material::holdout,
                 {.help = "The camera sees a hole in the picture in its place"})
            .add("shadow_catcher", &Material::shadow_catcher,
                 {.help = "The camera sees only the shadows that fall on it"})
            .add("camera_visible", &Material::camera_visible,
                 {.help = "Whether the camera sees it; light does in any case"})
            .check(check_material);
    return table;
}

namespace {

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

const Table<SheetPlace>& sheet_table() {
    static const Table<SheetPlace> table =
        Table<SheetPlace>("sheet", "What thin sheets have; they are no obstacle to fluids")
            .add("name", &SheetPlace::name, {.help = "For messages and --set"})
            .add("center", &SheetPlace::center, {.unit = "m", .help = "The middle"})
            .add("normal", &SheetPlace::normal, {.help = "Direction that the front faces"})
            .add("target", &SheetPlace::target,
                 {.unit = "m", .help = "A point that the front faces, in place of normal"})
            .add("two_sided", &SheetPlace::two_sided,
                 {.help = "Whether its emission goes to its back too"})
            .flat(&SheetPlace::material, material_table());
    return table;
}

const Table<RectSurface>& rect_table() {
    static const Table<RectSurface> table =
        Table<RectSurface>("rect", "A rectangle without thickness")
            .add("size", &RectSurface::size,
                 {.unit = "m",
                  .help = "Lengths of the horizontal edge and of the other",
                  .min = 0,
                  .min_open = true})
            .add("roll_degrees", &RectSurface::roll_degrees,
                 {.unit = "degrees", .help = "Turned around the normal"})
            .base(sheet_table());
    return table;
}

const Table<DiscSurface>& disc_table() {
    static const Table<DiscSurface> table =
        Table<DiscSurface>("disc", "A disc without thickness")
            .add("radius", &DiscSurface::radius,
                 {.unit = "m", .help = "The radius", .min = 0, .min_open = true})
            .base(sheet_table());
    return table;
}

const Table<MeshSurface>& mesh_table() {
    static const Table<MeshSurface> table =
        Table<MeshSurface>("mesh", "Triangles from a file; smoke meets closed ones")
            .add("name", &MeshSurface::name, {.help = "For messages and --set"})
            .add("file", &MeshSurface::file,
                 {.help = "OBJ, PLY, or glTF 2 as .gltf or .glb", .required = true})
            .choice("up", &MeshSurface::up, {{"y", FileUp::Y}, {"z", FileUp::Z}},
                    {.help = "The axis that points up in the file; it is turned to the scene's"})
            .add("translate", &MeshSurface::translate, {.unit = "m", .help = "Moves it, at last"})
            .add("rotate_degrees", &MeshSurface::rotate_degrees,
                 {.unit = "degrees", .help = "Turns it about its origin: around x, then y, then z"})
            .add("scale", &MeshSurface::scale,
                 {.help = "Scales it about its origin, at first", .min = 0, .min_open = true})
            .add("smooth_degrees", &MeshSurface::smooth_degrees,
                 {.unit = "degrees",
                  .help = "Edges at which faces meet at less than this look smooth; 0 for flat "
                          "faces, without it the normals of the file",
                  .min = 0,
                  .max = 180})
            .flat(&MeshSurface::material, material_table());
    return table;
}

}  // namespace

const Variants<SurfaceParams>& surface_variants() {
    static const Variants<SurfaceParams> variants =
        Variants<SurfaceParams>("surface",
                                "A solid: its shape, what it does to light and what fills it")
            .add("sphere", sphere_table())
            .add("box", box_table())
            .add("ground", ground_table())
            .add("rect", rect_table())
            .add("disc", disc_table())
            .add("mesh", mesh_table());
    return variants;
}

}  // namespace gischt
