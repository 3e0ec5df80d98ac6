// SPDX-License-Identifier: Apache-2.0
#include "fluid/emitter.h"

#include <cmath>

#include "base/random.h"
#include "math/noise.h"

namespace gischt {

const Table<EmitterNoise>& emitter_noise_table() {
    using P = EmitterNoise;
    static const Table<P> table =
        Table<P>("noise", "Animated noise that multiplies what a source gives")
            .add("amplitude", &P::amplitude, {.help = "Strength; 0 is none", .min = 0})
            .add("scale", &P::scale,
                 {.unit = "m", .help = "Size of the largest features", .min = 0, .min_open = true})
            .add("speed", &P::speed,
                 {.unit = "1/s", .help = "How often the pattern changes entirely", .min = 0})
            .add("octaves", &P::octaves,
                 {.help = "Patterns, each half as large", .min = 1, .max = 12})
            .add("seed", &P::seed, {.help = "Chooses the pattern"});
    return table;
}

const Table<EmitterParams>& emitter_table() {
    using P = EmitterParams;
    static const Table<P> table =
        Table<P>("source", "A place that imposes density, temperature or velocity on the fluid")
            .choice("shape", &P::kind,
                    {{"sphere", EmitterKind::Sphere},
                     {"box", EmitterKind::Box},
                     {"mesh", EmitterKind::Mesh, "what a closed mesh encloses"}},
                    {.help = "What it looks like"})
            .add("position", &P::position, {.unit = "m", .help = "Centre; of a mesh its origin"})
            .add("radius", &P::radius,
                 {.unit = "m", .help = "Radius of a sphere", .min = 0, .min_open = true})
            .add("size", &P::size,
                 {.unit = "m", .help = "Edges of a box", .min = 0, .min_open = true})
            .sub("mesh", &P::mesh, mesh_shape_table(), {.help = "The mesh of a mesh"})
            .add("edge", &P::edge,
                 {.unit = "m", .help = "Width of the soft edge, at least one cell", .min = 0})
            .add("density", &P::density, {.help = "Smoke that it gives", .min = 0})
            .add("temperature", &P::temperature,
                 {.unit = "K", .help = "Of what it gives", .min = 0})
            .add("velocity", &P::velocity, {.unit = "m/s", .help = "Of what it gives"})
            .choice("mode", &P::mode,
                    {{"pull", EmitterMode::Pull, "values approach the source's at a rate"},
                     {"set", EmitterMode::Set, "values are the source's"}},
                    {.help = "How strictly it imposes its values"})
            .add("rate", &P::rate, {.unit = "1/s", .help = "How fast it pulls", .min = 0})
            .sub("noise", &P::noise, emitter_noise_table(), {.help = "Breaks its symmetry"})
            .check([](const P& p, const Fail& fail) {
                if (!p.density && !p.temperature && !p.velocity) {
                    fail("", "gives nothing", "set density, temperature or velocity");
                }
                if (p.kind == EmitterKind::Mesh && p.mesh.file.empty()) {
                    fail("mesh", "has no file", "set mesh = { file = \"...\" }");
                }
            });
    return table;
}

namespace {

// Noise at a point and time in [-1,1]: slices of three-dimensional noise, one after the other,
// blended such that the variance stays.
float animated_noise(const EmitterNoise& noise, const Vec3d& p, double time, int channel) {
    const double t = time * noise.speed, slice = std::floor(t);
    const auto w = static_cast<float>(t - slice);
    const auto value = [&](double s) {
        const std::uint64_t key =
            random_key(static_cast<std::uint64_t>(noise.seed),
                       static_cast<std::uint64_t>(static_cast<std::int64_t>(s)),
                       static_cast<std::uint64_t>(channel));
        return fractal_noise(p / noise.scale, noise.octaves, 0.5f, key);
    };
    const float a = w < 1 ? value(slice) : 0, b = w > 0 ? value(slice + 1) : 0;
    return ((1 - w) * a + w * b) / std::sqrt((1 - w) * (1 - w) + w * w);
}

Shape shape_of(const EmitterParams& p, double time) {
    if (p.kind == EmitterKind::Sphere) return Sphere{p.position.at(time), p.radius.at(time)};
    return SolidBox{p.position.at(time), p.size.at(time), {}};
}

}  // namespace

// One source during one step.
struct Emitters::Active {
    const EmitterParams& params;
    const DistanceLattice& body;  // of a mesh
    Vec3d position;
    Shape shape;
    double time, dt, rate, frame_time, edge;

    Active(const EmitterParams& p, const DistanceLattice& b, double t, double step, double frame,
           double cell)
        : params(p),
          body(b),
          position(p.position.at(t)),
          shape(shape_of(p, t)),
          time(t),
          dt(step),
          rate(p.rate.at(t)),
          frame_time(frame),
          edge(std::max(p.edge, cell)) {}

    bool is_mesh() const { return params.kind == EmitterKind::Mesh; }
    // Metres to its surface, negative inside; for a mesh from half its edge on any larger distance.
    double distance(const Vec3d& p) const {
        return is_mesh() ? body.at(p - position) : signed_distance(shape, p);
    }
    // Cells that it reaches.
    Box3i reach(const Domain& domain) const {
        Box3d box = bounds(shape);
        if (is_mesh())
            box = {params.body->bounds().lo + position, params.body->bounds().hi + position};
        const Vec3d lo = (box.lo - Vec3d(edge) - domain.origin) / domain.h,
                    hi = (box.hi + Vec3d(edge) - domain.origin) / domain.h;
        Box3i cells{floor(lo), floor(hi) + Vec3i(2)};
        if (domain.is_2d()) cells.lo.z = 0, cells.hi.z = 1;
        return cells;
    }
    // How far a value at a point comes towards the source's during the step, in [0,1]. The covered
    // part m of a cell weakens the rate; for Set, -ln(1 - m) per frame lets the inside follow at
    // once.
    float pull(const Vec3d& p) const {
        const double m = std::clamp(0.5 - distance(p) / edge, 0.0, 1.0);
        if (m == 0) return 0;
        if (params.mode == EmitterMode::Pull) {
            return static_cast<float>(-std::expm1(-rate * m * dt));
        }
        return static_cast<float>(1 - std::pow(1 - m, dt / frame_time));
    }
    // 1 + amplitude noise, not below 0.
    float modulation(const Vec3d& p, int channel) const {
        if (params.noise.amplitude == 0) return 1;
        const auto a = static_cast<float>(params.noise.amplitude);
        return std::max(0.0f, 1 + a * animated_noise(params.noise, p, time, channel));
    }
};

Emitters::Emitters(std::vector<EmitterParams> emitters, double ambient, double frame_time,
                   double cell)
    : emitters_(std::move(emitters)), ambient_(ambient), frame_time_(frame_time) {
    const auto bad = [](const char* what) {
        throw Error(ErrorKind::Usage, "source", what, "give a number that is larger than 0");
    };
    for (const EmitterParams& e : emitters_) {
        for (const double r : e.rate.v) {
            if (!(r >= 0)) bad("a rate is negative");
        }
        for (const double r : e.radius.v) {
            if (e.kind == EmitterKind::Sphere && !(r > 0)) bad("a radius is not positive");
        }
        for (const Vec3d& s : e.size.v) {
            if (e.kind == EmitterKind::Box && !(min_component(s) > 0))
                bad("an edge is not positive");
        }
        if (!(e.edge >= 0)) bad("the width of an edge is negative");
        if (e.noise.amplitude != 0 && !(e.noise.scale > 0))
            bad("the scale of noise is not positive");
        DistanceLattice& body = bodies_.emplace_back();
        if (e.kind != EmitterKind::Mesh) continue;
        if (!e.body) bad("a mesh is missing");
        // Half the width of the edge is all that matters, and what lies within it varies by cells.
        body = DistanceLattice(*e.body, cell, std::max(e.edge, cell));
    }
}

void Emitters::apply(const Domain& domain, const BlockMap& blocks, double time, double dt,
                     SparseField& density, SparseField& temperature, FaceField& velocity) const {
    for (std::size_t i = 0; i < emitters_.size(); ++i) {
        const EmitterParams& e = emitters_[i];
        const Active source(e, bodies_[i], time, dt, frame_time_, domain.h);
        const Box3i reach = source.reach(domain);
        const auto pull_scalar = [&](int block, SparseField& field, double target, int channel) {
            for_cells(intersection(reach, blocks.cells(block)), [&](const Vec3i& c) {
                const Vec3d p = domain.center_of(c);
                const float k = source.pull(p);
                if (k == 0) return;
                float& value = field.values.ref(c);
                value += (static_cast<float>(target) * source.modulation(p, channel) - value) * k;
                field.active[static_cast<std::size_t>(block)] = 1;
            });
        };
        parallel_for(blocks.size(), 1, [&](int block) {
            const Box3i cells = blocks.cells(block);
            if (e.density) pull_scalar(block, density, e.density->at(time), 0);
            if (e.temperature) {
                pull_scalar(block, temperature, e.temperature->at(time) - ambient_, 1);
            }
            if (!e.velocity) return;
            const Vec3d target = e.velocity->at(time);
            for (int a = 0; a < domain.axes(); ++a) {
                const Box3i faces = domain.faces_of(cells, a);
                for_cells(intersection(reach, faces), [&](const Vec3i& f) {
                    const Vec3d p = domain.face_center(a, f);
                    const float k = source.pull(p);
                    if (k == 0) return;
                    float& u = velocity.ref(a, f);
                    u += (static_cast<float>(target[a]) * source.modulation(p, 2) - u) * k;
                });
            }
        });
    }
}

double Emitters::top_density(double time) const {
    double top = 0;
    for (const EmitterParams& e : emitters_) {
        if (e.density) top = std::max(top, std::abs(e.density->at(time)) * (1 + e.noise.amplitude));
    }
    return top;
}

double Emitters::top_temperature(double time) const {
    double top = 0;
    for (const EmitterParams& e : emitters_) {
        if (!e.temperature) continue;
        const double difference = std::abs(e.temperature->at(time) - ambient_);
        top = std::max(top, difference * (1 + e.noise.amplitude));
    }
    return top;
}

double Emitters::top_speed(double time) const {
    double top = 0;
    for (const EmitterParams& e : emitters_) {
        if (!e.velocity) continue;
        const double speed = max_component(abs(e.velocity->at(time)));
        top = std::max(top, speed * (1 + e.noise.amplitude));
    }
    return top;
}

}  // namespace gischt
