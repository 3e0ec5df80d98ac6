// SPDX-License-Identifier: Apache-2.0
#include "fluid/procedural/params.h"

namespace gischt {

const Table<TurbulenceParams>& turbulence_table() {
    using P = TurbulenceParams;
    static const Table<P> table =
        Table<P>("turbulence", "Noise of mean 0 and standard deviation 1")
            .choice("kind", &P::kind,
                    {{"fbm", TurbulenceKind::Fbm, "clouds and haze"},
                     {"billow", TurbulenceKind::Billow, "round heaps with creases between"},
                     {"ridged", TurbulenceKind::Ridged, "filaments and flames"},
                     {"cells", TurbulenceKind::Cells, "packed balls, as cauliflower"},
                     {"walls", TurbulenceKind::Walls, "walls between cells, as foam"}},
                    {.help = "What an octave looks like"})
            .add("scale", &P::scale,
                 {.unit = "m", .help = "Size of the largest features", .min = 0, .min_open = true})
            .add("stretch", &P::stretch,
                 {.help = "Features are so many times as long along each axis",
                  .min = 0,
                  .min_open = true})
            .add("octaves", &P::octaves,
                 {.help = "At most; those finer than two cells are left out", .min = 1, .max = 16})
            .add("lacunarity", &P::lacunarity,
                 {.help = "From octave to octave features are so many times finer",
                  .min = 1,
                  .max = 8,
                  .min_open = true})
            .add("gain", &P::gain,
                 {.help = "From octave to octave, so many times as strong", .min = 0, .max = 1})
            .add("warp", &P::warp, {.unit = "m", .help = "How far noise folds the noise", .min = 0})
            .add("evolution", &P::evolution,
                 {.unit = "1/s",
                  .help = "How often the largest features change entirely; smaller ones do faster"})
            .add("seed", &P::seed, {.help = "Another seed makes another noise", .min = 0});
    return table;
}

const Table<MeshShapeParams>& mesh_shape_table() {
    using P = MeshShapeParams;
    static const Table<P> table =
        Table<P>("mesh_shape", "A closed mesh that a procedural fluid fills")
            .add("file", &P::file, {.help = "Mesh: .obj, .ply, .gltf, .glb"})
            .add("scale", &P::scale,
                 {.help = "Scales it about its origin, at first", .min = 0, .min_open = true})
            .add("rotate_degrees", &P::rotate_degrees,
                 {.unit = "degrees", .help = "Turns it around x, then y, then z"});
    return table;
}

static void add_shape(Table<ProceduralParams>& table) {
    using P = ProceduralParams;
    table
        .add("resolution", &P::resolution,
             {.help = "Cells along the longest edge", .min = 8, .max = 4096})
        .add("min", &P::min, {.unit = "m", .help = "Lower corner of the box that it may fill"})
        .add("max", &P::max, {.unit = "m", .help = "Upper corner"})
        .choice("shape", &P::shape,
                {{"all", ProceduralShape::All, "the whole box"},
                 {"ball", ProceduralShape::Ball},
                 {"box", ProceduralShape::Box},
                 {"slab", ProceduralShape::Slab, "a layer to the sides of the box"},
                 {"blobs", ProceduralShape::Blobs, "balls and hoses that melt together"},
                 {"mesh", ProceduralShape::Mesh, "what a closed mesh encloses"}},
                {.help = "Where there is any"})
        .add("position", &P::position,
             {.unit = "m",
              .help = "Middle of a ball or box, base of a slab; moves blobs and a mesh"})
        .add("radius", &P::radius, {.unit = "m", .help = "Of a ball", .min = 0})
        .add("size", &P::size, {.unit = "m", .help = "Edges of a box", .min = 0})
        .add("thickness", &P::thickness, {.unit = "m", .help = "Of a slab", .min = 0})
        .list("blob", &P::blobs, blob_table(), {.help = "Blobs"})
        .choice("kernel", &P::kernel,
                {{"wyvill", BlobKernel::Wyvill, "sixth degree"},
                 {"blinn", BlobKernel::Blinn, "Gaussian, reaches far"},
                 {"metaball", BlobKernel::Metaball, "piecewise quadratic"},
                 {"murakami", BlobKernel::Murakami, "fourth degree, reaches least"}},
                {.help = "How the field of a blob falls with distance"})
        .add("blobbiness", &P::blobbiness,
             {.help = "Of Blinn's kernel: more keeps blobs apart",
              .min = 0,
              .max = 20,
              .min_open = true})
        .sub("mesh", &P::mesh, mesh_shape_table(), {.help = "The mesh of the shape 'mesh'"});
}

static void add_content(Table<ProceduralParams>& table) {
    using P = ProceduralParams;
    table
        .add("edge", &P::edge,
             {.unit = "m", .help = "Depth over which density rises", .min = 0, .min_open = true})
        .add("displacement", &P::displacement,
             {.unit = "m", .help = "How far the noise moves the surface (standard deviation)"})
        .add("threshold", &P::threshold,
             {.help = "Noise above which there is density, in standard deviations; unset: all"})
        .add("softness", &P::softness,
             {.help = "Noise over which it rises from there, in standard deviations",
              .min = 0,
              .min_open = true})
        .add("base", &P::base,
             {.unit = "m",
              .help = "Height of a flat base below which there is nothing; unset: none"})
        .add("falloff", &P::falloff,
             {.unit = "m",
              .help = "Height above the position over which density falls to 1/e; unset: none",
              .min = 0,
              .min_open = true})
        .add("density", &P::density, {.help = "At most", .min = 0})
        .add("temperature", &P::temperature,
             {.unit = "K", .help = "In the core; unset: no field", .min = 0})
        .add("flame", &P::flame, {.help = "In the core; unset: no field", .min = 0})
        .add("core", &P::core,
             {.unit = "m",
              .help = "Depth over which heat and flame rise",
              .min = 0,
              .min_open = true})
        .add("ambient_temperature", &P::ambient_temperature,
             {.unit = "K", .help = "Of the air around", .min = 0, .min_open = true})
        .add("surface", &P::surface,
             {.help = "Add the field 'surface', the level set of the displaced shape: metres, "
                      "negative inside, within three cells"})
        .add("velocity", &P::velocity,
             {.unit = "m/s", .help = "Wind that carries the noise through the shape"})
        .sub("noise", &P::noise, turbulence_table(), {.help = "What tears it"});
}

const Table<ProceduralParams>& procedural_table() {
    using P = ProceduralParams;
    static const Table<P> table = [] {
        Table<P> t("procedural", "A shape times noise in a wind: clouds, fog banks, flames");
        add_shape(t);
        add_content(t);
        t.check([](const P& p, const Fail& fail) {
            if (min_component(p.max - p.min) <= 0)
                fail("max", "must be above 'min' in every component");
            if (p.shape == ProceduralShape::Blobs && p.blobs.empty())
                fail("shape", "is 'blobs' and there is no blob: add [[fluid.blob]]");
            if (p.shape == ProceduralShape::Mesh && p.mesh.file.empty())
                fail("shape", "is 'mesh' and there is none: give [fluid.mesh] a 'file'");
        });
        return t;
    }();
    return table;
}

}  // namespace gischt
