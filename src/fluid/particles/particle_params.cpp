// SPDX-License-Identifier: Apache-2.0
#include "fluid/particles/particle_params.h"

namespace gischt {
namespace {

const Table<ParticleDomain>& particle_domain_table() {
    using P = ParticleDomain;
    static const Table<P> table =
        Table<P>("particle_domain", "The box in which particles live and become a density")
            .add("resolution", &P::resolution,
                 {.help = "Cells along the longest edge", .min = 8, .max = 2048})
            .add("min", &P::min, {.unit = "m", .help = "Lower corner; beyond it particles end"})
            .add("max", &P::max, {.unit = "m", .help = "Upper corner"})
            .check([](const P& p, const Fail& fail) {
                if (min_component(p.max - p.min) <= 0)
                    fail("max", "must be above 'min' in every component");
            });
    return table;
}

void check_spout(const SpoutParams& p, const Fail& fail) {
    if (p.kind == SpoutKind::Curve && p.points.size() < 2) {
        fail("points", "must be two at least for a curve");
    }
    if (p.kind == SpoutKind::Mesh && p.file.empty()) fail("file", "must name a mesh");
}

const Table<SpoutParams>& spout_table() {
    using P = SpoutParams;
    static const Table<P> table =
        Table<P>("particle_source", "A place where particles come from")
            .choice("shape", &P::kind,
                    {{"point", SpoutKind::Point},
                     {"disc", SpoutKind::Disc},
                     {"ball", SpoutKind::Ball, "all of its volume"},
                     {"curve", SpoutKind::Curve, "along the lines between points"},
                     {"mesh", SpoutKind::Mesh, "even over the area of a surface"}},
                    {.help = "What it looks like"})
            .add("position", &P::position, {.unit = "m", .help = "Centre; moves curves and meshes"})
            .add("radius", &P::radius,
                 {.unit = "m", .help = "Of a disc, a ball or the tube around a curve", .min = 0})
            .add("points", &P::points, {.unit = "m", .help = "Corners of a curve"})
            .add("file", &P::file, {.help = "Mesh: .obj, .ply, .gltf, .glb"})
            .add("rate", &P::rate, {.unit = "1/s", .help = "Particles per second", .min = 0})
            .add("direction", &P::direction,
                 {.help = "The way that particles go; also the normal of a disc"})
            .add("along_normal", &P::along_normal,
                 {.help = "They go along the surface's normal or the curve's tangent instead"})
            .add("cone_degrees", &P::cone_degrees,
                 {.unit = "degree",
                  .help = "How far they spread around that way; 180 is all around",
                  .min = 0,
                  .max = 180})
            .add("speed", &P::speed, {.unit = "m/s", .help = "At birth"})
            .add("speed_spread", &P::speed_spread,
                 {.help = "Share by which the speed varies to either side", .min = 0})
            .add("inherit", &P::inherit, {.help = "Share of the place's own velocity"})
            .add("life", &P::life,
                 {.unit = "s", .help = "How long a particle lives", .min = 0, .min_open = true})
            .add("life_spread", &P::life_spread,
                 {.help = "Share by which the life varies", .min = 0, .max = 1})
            .add("particle_radius", &P::particle_radius,
                 {.unit = "m", .help = "Radius of a particle", .min = 0, .min_open = true})
            .add("radius_spread", &P::radius_spread,
                 {.help = "Share by which the radius varies", .min = 0, .max = 1, .max_open = true})
            .check(check_spout);
    return table;
}

const Table<EddyParams>& eddy_table() {
    using P = EddyParams;
    static const Table<P> table =
        Table<P>("eddies", "Turbulence of the air: curl noise, free of divergence")
            .add("speed", &P::speed, {.unit = "m/s", .help = "Root mean square", .min = 0})
            .add("scale", &P::scale,
                 {.unit = "m", .help = "Size of the largest eddies", .min = 0, .min_open = true})
            .add("octaves", &P::octaves, {.help = "Eddies, each half as large", .min = 1, .max = 8})
            .add("change", &P::change,
                 {.unit = "1/s", .help = "How often the pattern changes entirely", .min = 0})
            .add("seed", &P::seed, {.help = "Chooses the pattern"});
    return table;
}

const Table<VortexParams>& vortex_table() {
    using P = VortexParams;
    static const Table<P> table =
        Table<P>("vortex", "A vortex line around which the air turns")
            .add("position", &P::position, {.unit = "m", .help = "A point of it; moves its points"})
            .add("axis", &P::axis,
                 {.help = "Of a straight line; the air turns counterclockwise around it"})
            .add("points", &P::points,
                 {.unit = "m", .help = "Corners of a curve; the first again at its end closes it"})
            .add("circulation", &P::circulation,
                 {.unit = "m^2/s", .help = "2 pi r times the speed"})
            .add("core", &P::core,
                 {.unit = "m",
                  .help = "Radius within which the air turns as a whole",
                  .min = 0,
                  .min_open = true});
    return table;
}

const Table<AttractorParams>& attractor_table() {
    using P = AttractorParams;
    static const Table<P> table =
        Table<P>("attractor", "A point that pulls particles, or pushes them")
            .add("position", &P::position, {.unit = "m", .help = "Where it is"})
            .add("strength", &P::strength,
                 {.unit = "m^3/s^2",
                  .help = "Acceleration times the square of the distance; below 0 it pushes"})
            .add("core", &P::core,
                 {.unit = "m",
                  .help = "Radius within which the pull gets weaker again",
                  .min = 0,
                  .min_open = true});
    return table;
}

const Table<FlowParams>& flow_table() {
    using P = FlowParams;
    static const Table<P> table =
        Table<P>("flow", "The motion of another fluid, which carries the particles")
            .add("fluid", &P::fluid, {.help = "Name of a fluid of the scene"})
            .add("file", &P::file, {.help = "Or VDB files; '####' stands for the frame's number"})
            .check([](const P& p, const Fail& fail) {
                if (!p.fluid.empty() && !p.file.empty())
                    fail("file", "must not be given beside 'fluid'");
            });
    return table;
}

const Table<ParticleLook>& particle_look_table() {
    using P = ParticleLook;
    static const Table<P> table =
        Table<P>("over_life", "What particles are by their age: keyframes over age / life, 0 to 1")
            .add("size", &P::size, {.help = "Times the radius", .min = 0})
            .add("opacity", &P::opacity, {.help = "Times the density", .min = 0, .max = 1})
            .add("color", &P::color, {.help = "Linear; makes the field 'color'", .broadcast = true})
            .add("temperature", &P::temperature,
                 {.unit = "K", .help = "Makes the field 'temperature'", .min = 0});
    return table;
}

const Table<ContactParams>& contact_table() {
    using P = ContactParams;
    static const Table<P> table =
        Table<P>("contact", "What happens at solids: ground, sphere, box")
            .choice("kind", &P::kind,
                    {{"bounce", ContactKind::Bounce},
                     {"vanish", ContactKind::Vanish},
                     {"pass", ContactKind::Pass, "solids are not there"}},
                    {.help = "What a particle does"})
            .add("restitution", &P::restitution,
                 {.help = "Speed after over speed before, along the normal", .min = 0, .max = 1})
            .add("friction", &P::friction, {.help = "Coulomb's coefficient", .min = 0});
    return table;
}

const Table<MotionParams>& motion_table() {
    using P = MotionParams;
    static const Table<P> table =
        Table<P>("motion", "What moves particles")
            .choice("motion", &P::kind,
                    {{"inertial", ParticleMotion::Inertial, "gravity, drag in the air, attractors"},
                     {"tracer", ParticleMotion::Tracer, "they go with the air"}},
                    {.help = "What moves them"})
            .add("linear_drag", &P::linear_drag,
                 {.unit = "1/s", .help = "How fast they take on the air's velocity", .min = 0})
            .add("quadratic_drag", &P::quadratic_drag,
                 {.unit = "1/m", .help = "The same per speed against the air: of drops", .min = 0})
            .list("attractor", &P::attractors, attractor_table(), {.help = "Points that pull"})
            .sub("contact", &P::contact, contact_table(), {.help = "What happens at solids"});
    return table;
}

const Table<AirParams>& air_table() {
    using P = AirParams;
    static const Table<P> table =
        Table<P>("air", "The air that carries particles")
            .add("wind", &P::wind, {.unit = "m/s", .help = "Velocity of the air"})
            .sub("turbulence", &P::turbulence, eddy_table(), {.help = "Its eddies"})
            .list("vortex", &P::vortices, vortex_table(), {.help = "Lines that it turns around"});
    return table;
}

}  // namespace

const Table<ParticleParams>& particle_table() {
    using P = ParticleParams;
    static const Table<P> table =
        Table<P>("particles", "A particle system: spray, sparks, dust, snow")
            .sub("domain", &P::domain, particle_domain_table(), {.help = "Where they live"})
            .list("source", &P::sources, spout_table(), {.help = "Where they come from"})
            .flat(&P::motion, motion_table())
            .flat(&P::air, air_table())
            .sub("flow", &P::flow, flow_table(), {.help = "Another fluid as the air"})
            .sub("over_life", &P::look, particle_look_table(), {.help = "What age does to them"})
            .add("gravity_scale", &P::gravity_scale, {.help = "Share of the scene's gravity"})
            .add("density", &P::density,
                 {.help = "Density of the field inside of a particle", .min = 0})
            .add("reference_density", &P::reference_density,
                 {.unit = "kg/m^3", .help = "Of their matter", .min = 0, .min_open = true})
            .add("splat_scale", &P::splat_scale,
                 {.help = "Radius over which a particle is spread, against its own; it is at "
                          "least 1.5 cells",
                  .min = 0,
                  .min_open = true})
            .add("substeps", &P::substeps, {.help = "Steps per frame", .min = 1, .max = 10000})
            .add("most_particles", &P::most_particles,
                 {.help = "More of them at once are an error", .min = 1, .max = 1'000'000'000})
            .add("seed", &P::seed, {.help = "Another seed gives other particles", .min = 0})
            .check([](const P& p, const Fail& fail) {
                if (p.sources.empty()) fail("source", "is missing: nothing gives particles");
            });
    return table;
}

}  // namespace gischt
