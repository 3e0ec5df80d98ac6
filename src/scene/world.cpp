// SPDX-License-Identifier: Apache-2.0
#include "scene/world.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>

#include "base/units.h"
#include "fluid/particles/particle_source.h"
#include "fluid/procedural/procedural.h"
#include "fluid/smoke_source.h"
#include "io/image_file.h"
#include "io/mesh_file.h"
#include "optics/medium.h"
#include "optics/moving_media.h"
#include "optics/surface_content.h"

namespace gischt {
namespace {

// A fluid that needs no memory of earlier frames.
class StatelessSource : public FluidSource {
  public:
    using Make = std::function<Frame(int number, Job& job)>;
    explicit StatelessSource(Make make) : make_(std::move(make)) {}

    Frame frame(int number, Job& job) override {
        const double start = now_seconds();
        Frame frame = make_(number, job);
        figures_ = {};
        figures_.frame = number;
        figures_.time = frame.time;
        for (const auto& [name, field] : frame.fields) {
            figures_.active_tiles = std::max(figures_.active_tiles, field.map().size());
        }
        figures_.wall_seconds = now_seconds() - start;
        bounds_ = frame.world_bounds();
        last_ = number;
        return frame;
    }
    FrameStatistics statistics() const override { return figures_; }
    bool is_sequential() const override { return false; }
    void save_state(const std::filesystem::path&) const override {}
    void load_state(const std::filesystem::path&) override {}
    int last_frame() const override { return last_; }
    Box3d bounds() const override { return bounds_; }

  private:
    Make make_;
    FrameStatistics figures_;
    Box3d bounds_ = Box3d::empty();
    int last_ = 0;
};

// The rotation around x, then y, then z as axis times angle in degrees.
Vec3d axis_angle_degrees(const Vec3d& euler) {
    Transform r;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d e;
        e[axis] = 1;
        r = Transform::rotation(e, radians(euler[axis])) * r;
    }
    const auto& c = r.column;
    const Vec3d twist{c[1].z - c[2].y, c[2].x - c[0].z, c[0].y - c[1].x};
    const double angle = std::atan2(length(twist), c[0].x + c[1].y + c[2].z - 1);
    if (angle < 1e-9) return {};
    if (length(twist) > 1e-6) return (angle * 180 / pi / length(twist)) * twist;
    // Half a turn: the axis is the direction that stays, a column of R + 1.
    Vec3d best;
    for (int a = 0; a < 3; ++a) {
        Vec3d column = c[static_cast<std::size_t>(a)];
        column[a] += 1;
        if (dot(column, column) > dot(best, best)) best = column;
    }
    return 180.0 * normalize(best);
}

bool has_inside(const Mesh& mesh) {
    Mesh sound = mesh;
    const MeshFaults faults = remove_faults(sound);
    return faults.not_finite + faults.no_point == 0 && !sound.triangles.empty() && is_closed(mesh);
}

struct SolidOf {
    Vec3d up;

    std::optional<SolidParams> operator()(const SphereSurface& s) const {
        SolidParams p;
        p.kind = SolidKind::Sphere;
        p.position = s.center;
        p.radius = s.radius;
        return p;
    }
    std::optional<SolidParams> operator()(const BoxSurface& s) const {
        SolidParams p;
        p.kind = SolidKind::Box;
        p.position = s.center;
        p.size = s.size;
        p.rotation = s.rotation_degrees;
        for (Vec3d& v : p.rotation.v) v = axis_angle_degrees(v);
        return p;
    }
    std::optional<SolidParams> operator()(const GroundSurface& s) const {
        SolidParams p;
        p.kind = SolidKind::Plane;
        p.position = s.point;
        p.normal = s.normal ? normalize(*s.normal) : up;
        return p;
    }
    std::optional<SolidParams> operator()(const SheetPlace&) const { return std::nullopt; }
    std::optional<SolidParams> operator()(const MeshSurface& s) const {
        Job unheard;  // what is said of a mesh is about its colours
        Mesh mesh = read_mesh(s.file, unheard).mesh;
        // One without an inside is reported by report_unmet_solids().
        if (!has_inside(mesh)) return std::nullopt;
        MeshSurface still;
        still.up = s.up;
        SolidParams p;
        p.kind = SolidKind::Mesh;
        p.mesh = std::make_shared<MeshDistance>(
            transformed(std::move(mesh), mesh_placement(still, 0, up)));
        p.position = s.translate;
        p.scale = s.scale;
        p.rotation = s.rotate_degrees;
        for (Vec3d& v : p.rotation.v) v = axis_angle_degrees(v);
        return p;
    }
};

// A boundary without a surface is not there, and what a fluid fills does not keep it out.
bool is_in_the_way(const SurfaceParams& s, const std::string& fluid) {
    const Material& m = material_of(s);
    const bool is_filled = !m.interior.empty() && m.interior == fluid;
    return m.kind != MaterialKind::None && !is_filled;
}

// What stands in the way of a simulated fluid. Sheets have no inside that could.
std::optional<SolidParams> solid_of(const SurfaceParams& s, const std::string& fluid,
                                    const Vec3d& up) {
    if (!is_in_the_way(s, fluid)) return std::nullopt;
    std::optional<SolidParams> solid = std::visit(SolidOf{up}, s);
    if (solid) solid->name = std::visit([](const auto& p) { return p.name; }, s);
    return solid;
}

// Gives solids the temperatures that a fluid's parameters ask for.
void heat_solids(std::vector<SolidParams>& solids, const std::vector<SolidHeat>& heats) {
    for (const SolidHeat& heat : heats) {
        const auto named = [&](const SolidParams& s) { return s.name == heat.solid; };
        const auto found = std::ranges::find_if(solids, named);
        if (found == solids.end()) {
            std::vector<std::string> names;
            for (const SolidParams& s : solids) names.push_back(s.name);
            throw Error(ErrorKind::Usage, "solid_heat",
                        "no solid '" + heat.solid + "' that the smoke meets",
                        hint_for(heat.solid, names));
        }
        found->temperature = heat.temperature;
    }
}

// The vectors of a field under a linear map.
static void map_vectors(Field& field, const Transform& map) {
    auto &x = field.component[0], &y = field.component[1], &z = field.component[2];
    for (std::size_t i = 0; i < x.values().size(); ++i) {
        const Vec3d v = map.vector({x.values()[i], y.values()[i], z.values()[i]});
        x.values()[i] = static_cast<float>(v.x);
        y.values()[i] = static_cast<float>(v.y);
        z.values()[i] = static_cast<float>(v.z);
    }
    const auto& b = field.background;
    const Vec3f background(map.vector({b[0], b[1], b[2]}));
    field.background = {background.x, background.y, background.z};
}

// A fluid's frame where the scene puts it: lengths grow with it, and what points somewhere turns.
// Other vectors (colours, say) stay as they are.
static std::shared_ptr<const Frame> placed(const std::shared_ptr<const Frame>& frame,
                                           const Transform& placement) {
    if (placement == Transform{}) return frame;
    auto out = std::make_shared<Frame>(*frame);
    const double scale = std::cbrt(placement.determinant());
    Transform rotation = placement;
    for (Vec3d& c : rotation.column) c = c / scale;
    for (auto& [name, particles] : out->particles) {
        for (Vec3d& p : particles.position) p = placement.point(p);
        for (Vec3f& v : particles.velocity) v = Vec3f(placement.vector(Vec3d(v)));
        for (float& r : particles.radius) r *= static_cast<float>(scale);
    }
    for (auto& [name, field] : out->fields) {
        field.to_world = placement * field.to_world;
        if (field.is_vector() && name == "velocity") map_vectors(field, placement);
        if (field.is_vector() && name == "vorticity") map_vectors(field, rotation);
        if (field.kind == FieldClass::LevelSet && !field.is_vector() && scale != 1) {
            for (float& d : field.component[0].values()) d *= static_cast<float>(scale);
            field.background[0] *= static_cast<float>(scale);
        }
    }
    return out;
}

struct SourceOf {
    const Scene& scene;

    // The scene as a fluid of that name meets it; particles meet no meshes.
    FluidWorld world_of(const std::string& name, bool meets_meshes) const {
        FluidWorld world;
        world.fps = scene.fps;
        world.gravity = scene.gravity_vector();
        for (const SurfaceParams& s : scene.solids) {
            if (!meets_meshes && std::holds_alternative<MeshSurface>(s)) continue;
            if (const auto solid = solid_of(s, name, scene.up_vector())) {
                world.solids.push_back(*solid);
            }
        }
        return world;
    }
    std::unique_ptr<FluidSource> operator()(const FluidOf<SmokeParams>& f) const {
        SmokeParams params = f.source;
        for (EmitterParams& e : params.sources) {
            if (e.kind == EmitterKind::Mesh) e.body = body_of(e.mesh);
        }
        FluidWorld world = world_of(f.common.name, true);
        heat_solids(world.solids, params.solid_heat);
        return std::make_unique<SmokeSource>(params, world);
    }
    std::unique_ptr<FluidSource> operator()(const FluidOf<ParticleParams>& f) const {
        ParticleInputs inputs;
        for (const SpoutParams& s : f.source.sources) {
            Job unheard;  // what is said of a mesh is about its colours
            inputs.meshes.push_back(s.kind == SpoutKind::Mesh ? read_mesh(s.file, unheard).mesh
                                                              : Mesh{});
        }
        inputs.flow = flow_for(f.source.flow);
        return std::make_unique<ParticleSource>(f.source, world_of(f.common.name, false),
                                                std::move(inputs));
    }
    // Frames of the fluid that carries particles, where the scene puts it. A fluid of the scene is
    // computed again for them. Files that begin with frame 1 move as that from frame 0 on.
    std::function<std::shared_ptr<const Frame>(int, Job&)> flow_for(const FlowParams& flow) const {
        if (!flow.file.empty()) {
            FileParams files;
            files.file = flow.file;
            return [files](int number, Job& job) {
                const bool begins_later =
                    number == 0 && !std::filesystem::exists(file_of_frame(files, 0));
                return std::make_shared<const Frame>(
                    read_file_frame(files, begins_later ? 1 : number, job));
            };
        }
        if (flow.fluid.empty()) return {};
        std::vector<std::string> names;
        for (const FluidSection& other : scene.fluids) {
            if (std::holds_alternative<FluidOf<ParticleParams>>(other)) continue;
            names.push_back(common_of(other).name);
            if (names.back() != flow.fluid) continue;
            return [source = std::shared_ptr<FluidSource>(std::visit(*this, other)),
                    placement = common_of(other).placement()](int number, Job& job) {
                return placed(std::make_shared<const Frame>(source->frame(number, job)), placement);
            };
        }
        throw Error(ErrorKind::Usage, "flow", "no fluid '" + flow.fluid + "' that could carry",
                    hint_for(flow.fluid, names));
    }
    std::unique_ptr<FluidSource> operator()(const FluidOf<FileParams>& f) const {
        return std::make_unique<StatelessSource>([params = f.source](int number, Job& job) {
            return read_file_frame(params, number, job);
        });
    }
    std::unique_ptr<FluidSource> operator()(const FluidOf<CloudParams>& f) const {
        return made_by(make_cloud, f.source);
    }
    std::unique_ptr<FluidSource> operator()(const FluidOf<ProceduralParams>& f) const {
        std::shared_ptr<const MeshDistance> mesh;
        if (f.source.shape == ProceduralShape::Mesh) mesh = body_of(f.source.mesh);
        const auto make = [mesh](const ProceduralParams& p, const Vec3d& up, double t, Job& job) {
            return make_procedural(p, up, t, job, mesh.get());
        };
        return made_by(make, f.source);
    }

  private:
    static std::shared_ptr<const MeshDistance> body_of(const MeshShapeParams& mesh) {
        Job unheard;  // what is said of a mesh is about its colours
        return std::make_shared<MeshDistance>(
            filled_mesh(mesh, read_mesh(mesh.file, unheard).mesh));
    }
    // From a function of the parameters, the direction up and the time.
    template <class Make, class P>
    std::unique_ptr<FluidSource> made_by(const Make& make, const P& source) const {
        return std::make_unique<StatelessSource>(
            [make, params = source, up = scene.up_vector(), fps = scene.fps](int number, Job& job) {
                Frame frame = make(params, up, number / fps, job);
                frame.number = number;
                frame.dt = 1 / fps;
                return frame;
            });
    }
};

}  // namespace

std::unique_ptr<FluidSource> make_source(const Scene& scene, const FluidSection& fluid) {
    return std::visit(SourceOf{scene}, fluid);
}

bool is_computed(const FluidSection& fluid) {
    return !std::holds_alternative<FluidOf<FileParams>>(fluid);
}

void report_unmet_solids(const Scene& scene, const FluidSection& fluid, Job& job) {
    const bool is_smoke = std::holds_alternative<FluidOf<SmokeParams>>(fluid);
    if (!is_smoke && !std::holds_alternative<FluidOf<ParticleParams>>(fluid)) return;
    for (const SurfaceParams& s : scene.solids) {
        const auto* mesh = std::get_if<MeshSurface>(&s);
        if (!mesh || !is_in_the_way(s, common_of(fluid).name)) continue;
        if (!is_smoke) {
            job.warn("solid '" + mesh->name +
                     "' is a mesh: seen, but the particles pass through it");
            continue;
        }
        Job unheard;
        if (has_inside(read_mesh(mesh->file, unheard).mesh)) continue;
        job.warn("solid '" + mesh->name +
                 "' is a mesh that is not closed: seen, but the smoke passes through it");
    }
}

static SurfaceRig::ColoredMesh read_colored_mesh(const std::string& file, Job& job) {
    MeshFile f = read_mesh(file, job);
    return {std::move(f.mesh), f.base_color, std::move(f.base_color_file)};
}

World::World(const Scene& scene, Job& job)
    : scene_(scene),
      lights_(scene.lights, scene.up_vector(), read_image),
      surfaces_(scene.solids, scene.lights, scene.up_vector(), read_colored_mesh, read_image, job) {
}

// Aims a camera that sees the whole box at what the media really show, and narrows its field to
// that.
static void close_in(CameraParams& params, const View& view, const Framing& framing) {
    constexpr int columns = 160;
    const int rows = std::max(1, static_cast<int>(columns / framing.aspect));
    const Camera camera(params, view.time, columns, rows, framing.up);
    int left = columns, right = -1, top = rows, bottom = -1;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const Ray ray = camera.ray(x + 0.5, y + 0.5);
            double depth = 0;
            for (const auto& m : view.media) {
                if (!m->has_lattice()) continue;
                SegmentWalk walk = m->segments(ray);
                for (MediumSegment s; walk.next(s);) depth += s.mean * (s.t1 - s.t0);
            }
            if (depth < 0.02) continue;  // too thin to be seen
            left = std::min(left, x);
            right = std::max(right, x);
            top = std::min(top, y);
            bottom = std::max(bottom, y);
        }
    }
    if (right < left) return;
    const double distance = length(params.target.at(0) - params.position.at(0));
    const Ray middle = camera.ray(0.5 * (left + right + 1), 0.5 * (top + bottom + 1));
    const double share = std::max((right - left + 3.0) / columns, (bottom - top + 3.0) / rows);
    const double half =
        std::tan(radians(0.5 * params.fov_degrees.at(0))) * share / (1 - 2 * framing.margin);
    params.target = middle.at(distance);
    params.fov_degrees = std::min(params.fov_degrees.at(0), 2 * std::atan(half) * 180 / pi);
}

CameraParams World::camera(const View& view) const {
    if (scene_.camera) return *scene_.camera;
    Box3d box = Box3d::empty();
    for (const auto& m : view.media) {
        if (m->has_lattice() && !m->bounds().is_empty()) box.extend(m->bounds());
    }
    if (box.is_empty()) return {};
    Framing framing;
    framing.aspect = static_cast<double>(scene_.film.width) / scene_.film.height;
    framing.up = scene_.up_vector();
    framing.elevation_degrees = -16;  // from below, so that the sky lies behind
    CameraParams params = fit_camera(box, framing);
    close_in(params, view, framing);
    return params;
}

// The fluids' media while the film is exposed. One that needs fewer moments than another keeps each
// for as many more: both are powers of three.
void World::blur(View& view, Job& job) const {
    if (!(view.shutter > 0) || scene_.render.method != "path") return;
    std::vector<std::vector<std::shared_ptr<const Medium>>> by_fluid;
    std::size_t parts = 1;
    for (std::size_t i = 0; i < view.frames.size(); ++i) {
        // What a procedure makes from nothing does not move, unless it says how.
        const bool is_at_rest =
            std::holds_alternative<FluidOf<CloudParams>>(scene_.fluids[i]) ||
            (std::holds_alternative<FluidOf<ProceduralParams>>(scene_.fluids[i]) &&
             !view.frames[i]->find("velocity"));
        const FluidCommon& common = common_of(scene_.fluids[i]);
        const Exposure exposure{view.time, view.shutter, is_at_rest ? 1 : common.blur_moments};
        by_fluid.push_back(
            media_while_exposed(*view.frames[i], view.media[i], common.medium, exposure, job));
        parts = std::max(parts, by_fluid.back().size());
    }
    if (parts == 1) return;
    view.moving_media.assign(parts, view.media);
    for (std::size_t part = 0; part < parts; ++part) {
        for (std::size_t i = 0; i < by_fluid.size(); ++i) {
            view.moving_media[part][i] = by_fluid[i][part * by_fluid[i].size() / parts];
        }
    }
}

View World::view(const std::vector<std::shared_ptr<const Frame>>& frames, int frame, Job& job) {
    View view;
    view.frame = frame;
    view.time = scene_.time_of(frame);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FluidCommon& common = common_of(scene_.fluids[i]);
        view.frames.push_back(placed(frames[i], common.placement()));
        // A colour map shows the fields as they are, whatever they do to light.
        if (scene_.render.method == "field") continue;
        view.media.push_back(
            std::make_shared<Medium>(*view.frames[i], common.medium, view.time, job));
    }
    for (const PlacedMediumParams& m : scene_.media) {
        if (scene_.render.method == "field") break;
        for (auto& medium : place_media(m, view.time, scene_.up_vector())) {
            view.media.push_back(std::move(medium));
        }
    }
    view.lights = lights_.at(view.time);
    view.shutter = scene_.film.shutter / scene_.fps;
    blur(view, job);
    const auto camera_at = [&, params = camera(view)](double time, double shutter) {
        return Camera(params, time, scene_.film.width, scene_.film.height, scene_.up_vector(),
                      shutter);
    };
    view.camera = camera_at(view.time, view.shutter);
    const double half = 0.5 / scene_.fps;
    view.around = {camera_at(view.time - half, 0), camera_at(view.time + half, 0), 2 * half};
    // A colour map has frames and no media: nothing fills a surface then.
    SurfaceRig::Media media;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string& name = common_of(scene_.fluids[i]).name;
        if (!name.empty()) media[name] = i < view.media.size() ? view.media[i] : nullptr;
    }
    view.surfaces = surfaces_.at(view.time, view.shutter, media);
    return view;
}

}  // namespace gischt
