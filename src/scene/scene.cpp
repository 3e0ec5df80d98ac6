// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include "base/units.h"
#include "fluid/probes/probe.h"
#include "render/aov.h"
#include "schema/doc.h"

namespace gischt {
namespace {

const Table<FluidCommon>& common_table() {
    using P = FluidCommon;
    static const Table<P> table =
        Table<P>("fluid", "What every fluid has")
            .add("name", &P::name, {.help = "Names the fluid in --set and in file names"})
            .sub("medium", &P::medium, medium_table(), {.help = "What the fluid does to light"})
            .add("translate", &P::translate,
                 {.unit = "m", .help = "Moves the fluid when it is looked at"})
            .add("rotate_degrees", &P::rotate_degrees,
                 {.unit = "degrees",
                  .help = "Turns the fluid about the origin: around x, then y, then z"})
            .add("scale", &P::scale,
                 {.help = "Scales the fluid about the origin", .min = 0, .min_open = true})
            .add(
                "blur_moments", &P::blur_moments,
                {.help = "Motion blur by the field velocity (method path): most moments at which "
                         "the fluid is taken while the film is exposed, 3, 9 or 27 as half a voxel "
                         "between them takes; 1: it stands still",
                 .min = 1,
                 .max = 255});
    return table;
}

// The keys of a source and those of every fluid, in one table.
template <class P>
const Table<FluidOf<P>>& fluid_table(const Table<P>& source) {
    static const Table<FluidOf<P>> table = Table<FluidOf<P>>(source.name, source.help)
                                               .flat(&FluidOf<P>::common, common_table())
                                               .flat(&FluidOf<P>::source, source);
    return table;
}

const Variants<FluidSection>& fluid_variants() {
    static const Variants<FluidSection> variants =
        Variants<FluidSection>("fluid",
                               "A fluid: where its motion comes from and what it does to light")
            .add("smoke", fluid_table(smoke_table()))
            .add("file", fluid_table(file_table()))
            .add("cloud", fluid_table(cloud_table()))
            .add("particles", fluid_table(particle_table()))
            .add("procedural", fluid_table(procedural_table()));
    return variants;
}

const Table<FilmParams>& film_table() {
    using P = FilmParams;
    static const Table<P> table =
        Table<P>("film", "The picture: its size and how radiance becomes a PNG or a movie")
            .add("width", &P::width, {.unit = "pixels", .help = "Width", .min = 1, .max = 65536})
            .add("height", &P::height, {.unit = "pixels", .help = "Height", .min = 1, .max = 65536})
            .add("exposure", &P::exposure,
                 {.unit = "stops", .help = "Brightness of PNG and MP4; EXR holds radiance"})
            .choice("tone", &P::tone,
                    {{"filmic", ToneKind::Filmic, "soft highlights"},
                     {"linear", ToneKind::Linear, "clips at 1"}},
                    {.help = "Tone curve of PNG and MP4"})
            .choice("filter", &P::filter,
                    {{"box", FilterKind::Box},
                     {"gaussian", FilterKind::Gaussian},
                     {"mitchell", FilterKind::Mitchell},
                     {"blackman_harris", FilterKind::BlackmanHarris}},
                    {.help = "Reconstruction filter"})
            .add("filter_radius", &P::filter_radius,
                 {.unit = "pixels",
                  .help = "Radius of the filter; 0 takes the filter's own",
                  .min = 0,
                  .max = 16})
            .add("shutter", &P::shutter,
                 {.unit = "frames",
                  .help = "How long the film is exposed, centred on the frame's moment: 0.5 is "
                          "common in film; 0 makes no motion blur",
                  .min = 0,
                  .max = 16})
            .add("aovs", &P::aovs,
                 {.help = "Further layers of an EXR: direct, indirect, emission, albedo, normal, "
                          "motion, transmittance, variance, samples; \"all\" for those that the "
                          "method has"})
            .add("denoise", &P::denoise,
                 {.help = "Take the noise out of finished pictures; an EXR keeps the noisy one in "
                          "the layer noisy. For methods that know the variance: path, march"});
    return table;
}

const Table<RenderSection>& render_table() {
    using P = RenderSection;
    static const Table<P> table =
        Table<P>("render", "How the picture is made; each method has a table of its own below")
            .add("method", &P::method, {.help = "One of the names that `gischt methods` lists"})
            .add("spp", &P::spp, {.help = "Samples per pixel", .min = 1, .max = 1 << 24})
            .add("depth", &P::depth,
                 {.help = "Most scattering events of a light path", .min = 1, .max = 1 << 20})
            .flat(&P::methods, render_params_table());
    return table;
}

// Particles may go with any fluid that is no particles.
void check_flows(const Scene& s, const Fail& fail) {
    std::vector<std::string> carriers;
    for (const FluidSection& fluid : s.fluids) {
        if (!std::holds_alternative<FluidOf<ParticleParams>>(fluid))
            carriers.push_back(common_of(fluid).name);
    }
    for (const FluidSection& fluid : s.fluids) {
        const auto* particles = std::get_if<FluidOf<ParticleParams>>(&fluid);
        if (!particles || particles->source.flow.fluid.empty()) continue;
        const std::string& name = particles->source.flow.fluid;
        if (std::ranges::find(carriers, name) == carriers.end()) {
            fail("fluid", "has a 'flow' with no fluid '" + name + "' that could carry particles",
                 hint_for(name, carriers));
        }
    }
}

// The fluid that a probe measures: the one that it names, or the only one.
std::optional<std::size_t> fluid_of(const Scene& s, const ProbeCommon& probe) {
    if (probe.fluid.empty() && s.fluids.size() == 1) return 0;
    for (std::size_t i = 0; i < s.fluids.size(); ++i) {
        if (!probe.fluid.empty() && common_of(s.fluids[i]).name == probe.fluid) return i;
    }
    return std::nullopt;
}

void check_solid_of(const Scene& s, const ForceProbe& probe, const Fail& fail) {
    std::vector<std::string> names;
    for (const SurfaceParams& solid : s.solids) {
        names.push_back(std::visit([](const auto& p) { return p.name; }, solid));
    }
    if (std::ranges::find(names, probe.solid) != names.end()) return;
    fail("probe", "'" + probe.name + "': there is no solid '" + probe.solid + "'",
         names.empty() ? "" : hint_for(probe.solid, names));
}

// Probes belong to simulated smoke, and lie in it.
void check_probes(const Scene& s, const Fail& fail) {
    std::vector<std::string> names;
    for (const FluidSection& fluid : s.fluids) names.push_back(common_of(fluid).name);
    for (const ProbeParams& probe : s.probes) {
        const ProbeCommon& common = probe_common(probe);
        const auto fluid = fluid_of(s, common);
        if (!fluid && common.fluid.empty()) {
            fail("probe", "'" + common.name + "' must name its fluid, as there is not just one");
        } else if (!fluid) {
            fail("probe", "'" + common.name + "': there is no fluid '" + common.fluid + "'",
                 hint_for(common.fluid, names));
        }
        const auto* smoke = std::get_if<FluidOf<SmokeParams>>(&s.fluids[*fluid]);
        if (!smoke) {
            fail("probe", "'" + common.name + "': its fluid is not simulated smoke",
                 "only a simulation can be probed: take the probe out");
        }
        check_probe(probe, smoke->source.domain, s.gravity_vector());
        for (const ProbeParams& other : s.probes) {
            if (common.mean && probe_common(other).name == common.name + "_mean") {
                fail("probe", "'" + common.name + "_mean' has the name of the mean of '" +
                                  common.name + "'");
            }
        }
        if (const auto* force = std::get_if<ForceProbe>(&probe)) check_solid_of(s, *force, fail);
    }
}

void check_scene(const Scene& s, const Fail& fail) {
    check_flows(s, fail);
    check_probes(s, fail);
    if (s.frames.x > s.frames.y) fail("frames", "must be [first, last] with first at most last");
    if (s.frames.x < 0) fail("frames", "must not start below 0");
    const auto methods = render_methods();
    std::vector<std::string> names;
    for (const MethodInfo& m : methods) names.emplace_back(m.name);
    if (std::ranges::find(names, s.render.method) == names.end()) {
        fail("render", "has no method '" + s.render.method + "'", hint_for(s.render.method, names));
    }
    std::vector<std::string> layers{"all"};
    for (const AovInfo& info : aov_table()) layers.emplace_back(info.name);
    for (const std::string& name : s.film.aovs) {
        if (std::ranges::find(layers, name) == layers.end())
            fail("film.aovs", "has no layer '" + name + "'", hint_for(name, layers));
    }
}

}  // namespace

Transform FluidCommon::placement() const {
    Transform t = Transform::scale_translate(scale, {});
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d e;
        e[axis] = 1;
        t = Transform::rotation(e, radians(rotate_degrees[axis])) * t;
    }
    t.translation = translate;
    return t;
}

FluidCommon& common_of(FluidSection& fluid) {
    return std::visit([](auto& f) -> FluidCommon& { return f.common; }, fluid);
}

const FluidCommon& common_of(const FluidSection& fluid) {
    return std::visit([](const auto& f) -> const FluidCommon& { return f.common; }, fluid);
}

std::vector<ProbeParams> probes_of(const Scene& scene, std::size_t fluid) {
    std::vector<ProbeParams> probes;
    for (const ProbeParams& probe : scene.probes) {
        if (fluid_of(scene, probe_common(probe)) == fluid) probes.push_back(probe);
    }
    return probes;
}

const Table<Scene>& scene_table() {
    using P = Scene;
    static const Table<P> table =
        Table<P>("scene", "A world to simulate and look at: the top level of a scene file")
            .add("description", &P::description, {.help = "One line for `gischt scenes`"})
            .choice("up", &P::up, {{"z", UpAxis::Z}, {"y", UpAxis::Y}},
                    {.help = "The axis that points up"})
            .add("fps", &P::fps,
                 {.unit = "1/s", .help = "Frames per second", .min = 0, .min_open = true})
            .add("frames", &P::frames, {.help = "First and last frame"})
            .add("seed", &P::seed, {.help = "Another seed gives other random numbers", .min = 0})
            .add("gravity", &P::gravity,
                 {.unit = "m/s^2", .help = "Acceleration of gravity; by default 9.80665 downwards"})
            .list("fluid", &P::fluids, fluid_variants(), {.help = "The fluids"})
            .list("medium", &P::media, placed_media_variants(),
                  {.help = "Media that stand still: fog, air, a box of smoke"})
            .list("solid", &P::solids, surface_variants(),
                  {.help = "Solids: seen by the camera, casting shadows, and in the way of "
                           "simulated fluids"})
            .list("probe", &P::probes, probe_variants(),
                  {.help = "Measures simulated smoke: tables of numbers over time"})
            .list("light", &P::lights, light_variants(), {.help = "The lights"})
            .sub("camera", &P::camera, camera_table(),
                 {.help = "The camera; without it the fluids are framed"})
            .sub("film", &P::film, film_table(), {.help = "The picture"})
            .sub("render", &P::render, render_table(), {.help = "How the picture is made"})
            .check(check_scene);
    return table;
}

}  // namespace gischt
