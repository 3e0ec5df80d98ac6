// SPDX-License-Identifier: Apache-2.0
#include "optics/surface_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/units.h"
#include "image/color.h"
#include "optics/surface_content.h"
#include "shape/solid_angle.h"

namespace gischt {
namespace {

// Below this solid angle in sr a flat light is drawn by area: the angles of spherical geometry
// lose their digits, and the density varies by less than a thousandth over the light.
constexpr double least_solid_angle = 1e-6;

// A sample ends this share before the light, and further by its rounding.
constexpr double shortening = 1e-9;

LightSample towards(const Vec3d& from, const Vec3d& to, const Vec3f& emission, double pdf) {
    const Vec3d d = to - from;
    const double r = length(d);
    if (!(r > 0) || !(pdf > 0) || !std::isfinite(pdf)) return {{0, 0, 1}, 0, {}, 0};
    return {d / r, r * (1 - shortening), emission * static_cast<float>(1 / pdf),
            static_cast<float>(pdf)};
}

constexpr double over_sphere = 0.25 / pi;

// What rounding may put a drawn point off its shape, with room for that of a ray that leaves it.
double drawn_offset(const Vec3d& point, double size) {
    constexpr double ulps = 64 * std::numeric_limits<double>::epsilon();
    return ulps * (max_component(abs(point)) + size) + std::numeric_limits<double>::min();
}

// ---- A ball: directions in the cone that it fills, from inside all.
class SphereLight : public SurfaceLight {
  public:
    SphereLight(const Sphere& sphere, int surface, const Vec3f& emission) : sphere_(sphere) {
        surface_ = surface;
        emission_ = emission;
    }

    LightSample sample(const Vec3d& point, Vec2f u) const override {
        const Vec3d axis = sphere_.center - point;
        const double drop_max = one_minus_cos(axis);
        const double drop = static_cast<double>(u.x) * drop_max,
                     turn = 2 * pi * static_cast<double>(u.y);
        const double sine = std::sqrt(drop * (2 - drop));
        Vec3d s, t, n{0, 0, 1};
        if (length(axis) > 0) n = normalize(axis);
        orthonormal_frame(n, s, t);
        const Vec3d d = (1 - drop) * n + sine * (std::cos(turn) * s + std::sin(turn) * t);
        // At the rim rounding may miss the ball: its nearest point then.
        const auto hit = intersect(Shape(sphere_), {point, d});
        const double r = hit ? hit->t : std::max(0.0, dot(axis, d));
        const double pdf = 1 / (2 * pi * drop_max);
        return {d, r * (1 - shortening), emission_ * static_cast<float>(1 / pdf),
                static_cast<float>(pdf)};
    }
    float pdf(const Vec3d& point, const Vec3d& direction) const override {
        return intersect(Shape(sphere_), {point, direction}) ? cone_pdf(point) : 0;
    }
    float pdf_of_hit(const Vec3d& from, const SurfaceHit&) const override { return cone_pdf(from); }
    Vec3f mean_radiance(const Vec3d& point) const override {
        return emission_ * static_cast<float>(0.5 * one_minus_cos(sphere_.center - point));
    }
    std::optional<LightPlace> place() const override {
        return LightPlace{sphere_.center, sphere_.radius};
    }
    double power() const override {
        return pi * area() * static_cast<double>(luminance(emission_));
    }
    AreaPoint area_point(Vec2f u) const override {
        const double z = 1 - 2 * static_cast<double>(u.x), turn = 2 * pi * static_cast<double>(u.y);
        const double sine = std::sqrt(std::max(0.0, 1 - z * z));
        const Vec3d n{sine * std::cos(turn), sine * std::sin(turn), z};
        const Vec3d p = sphere_.center + sphere_.radius * n;
        return {p, n, 0, drawn_offset(p, sphere_.radius)};
    }
    double area() const override { return 4 * pi * sphere_.radius * sphere_.radius; }
    bool is_closed() const override { return true; }

  private:
    float cone_pdf(const Vec3d& from) const {
        return static_cast<float>(1 / (2 * pi * one_minus_cos(sphere_.center - from)));
    }
    // 1 - cos of the cone's half angle, without cancelling for a far ball; 2 from inside.
    double one_minus_cos(const Vec3d& axis) const {
        const double sine2 = sphere_.radius * sphere_.radius / dot(axis, axis);
        return sine2 < 1 ? sine2 / (1 + std::sqrt(1 - sine2)) : 2;
    }

    Sphere sphere_;
};

// ---- Rectangles: a sheet, or the faces of a box of which a point sees up to three.
struct Face {
    Vec3d corner, edge_x, edge_y, normal;
    double area;
};

class FaceLight : public SurfaceLight {
  public:
    FaceLight(std::vector<Face> faces, bool both_sides, int surface, const Vec3f& emission)
        : faces_(std::move(faces)), both_sides_(both_sides) {
        surface_ = surface;
        emission_ = emission;
    }

    LightSample sample(const Vec3d& point, Vec2f u) const override {
        const Seen seen(*this, point);
        // The first number chooses a face and is stretched to serve again.
        double x = static_cast<double>(u.x) * seen.sum;
        std::size_t i = 0;
        while (i + 1 < faces_.size() && x >= seen.weight[i]) x -= seen.weight[i++];
        if (!(seen.weight[i] > 0)) return {{0, 0, 1}, 0, {}, 0};
        const Face& f = faces_[i];
        const Vec2f v{std::min(static_cast<float>(x / seen.weight[i]), 0x1.fffffep-1f), u.y};
        const Vec3d p = seen.by_area
                            ? f.corner + static_cast<double>(v.x) * f.edge_x +
                                  static_cast<double>(v.y) * f.edge_y
                            : SphericalRectangle(point, f.corner, f.edge_x, f.edge_y).point(v);
        return towards(point, p, emission_, seen.pdf(point, f, i, p));
    }
    float pdf(const Vec3d& point, const Vec3d& direction) const override {
        double pdf = 0, nearest = 1e300;
        const Seen seen(*this, point);
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            const Face& f = faces_[i];
            const Vec3d center = f.corner + 0.5 * (f.edge_x + f.edge_y);
            const auto hit =
                intersect(Shape(Rectangle{center, f.edge_x, f.edge_y}), {point, direction});
            if (!hit || hit->t > nearest || !(seen.weight[i] > 0)) continue;
            nearest = hit->t;
            pdf = seen.pdf(point, f, i, point + hit->t * direction);
        }
        return static_cast<float>(pdf);
    }
    float pdf_of_hit(const Vec3d& from, const SurfaceHit& hit) const override {
        const Seen seen(*this, from);
        const auto i = static_cast<std::size_t>(faces_.size() > 1 ? hit.primitive : 0);
        return seen.weight[i] > 0 ? static_cast<float>(seen.pdf(from, faces_[i], i, hit.point)) : 0;
    }
    Vec3f mean_radiance(const Vec3d& point) const override {
        return emission_ * static_cast<float>(over_sphere * Seen(*this, point).solid_angle);
    }
    std::optional<LightPlace> place() const override {
        Box3d box = Box3d::empty();
        for (const Face& f : faces_) {
            for (const Vec3d& p : {f.corner, f.corner + f.edge_x, f.corner + f.edge_y,
                                   f.corner + f.edge_x + f.edge_y}) {
                box.extend(p);
            }
        }
        return LightPlace{0.5 * (box.lo + box.hi), 0.5 * length(box.size())};
    }
    double power() const override {
        return pi * area() * (both_sides_ && faces_.size() == 1 ? 2 : 1) *
               static_cast<double>(luminance(emission_));
    }
    AreaPoint area_point(Vec2f u) const override {
        double x = static_cast<double>(u.x) * area();
        std::size_t i = 0;
        while (i + 1 < faces_.size() && x >= faces_[i].area) x -= faces_[i++].area;
        const Face& f = faces_[i];
        const Vec3d p =
            f.corner + std::min(x / f.area, 1.0) * f.edge_x + static_cast<double>(u.y) * f.edge_y;
        return {p, f.normal, static_cast<int>(i), drawn_offset(p, length(f.edge_x + f.edge_y))};
    }
    double area() const override {
        double sum = 0;
        for (const Face& f : faces_) sum += f.area;
        return sum;
    }
    bool is_closed() const override { return faces_.size() > 1; }

  private:
    // What a point sees of the faces: their weights in the choice.
    struct Seen {
        std::array<double, 6> weight{};
        double sum = 0, solid_angle = 0;
        bool by_area = false;

        Seen(const FaceLight& light, const Vec3d& point) {
            const bool from_inside = light.is_inside(point);
            for (std::size_t i = 0; i < light.faces_.size(); ++i) {
                const Face& f = light.faces_[i];
                const bool is_front = dot(point - f.corner, f.normal) > 0;
                const bool is_seen = light.faces_.size() == 1 ? is_front || light.both_sides_
                                                              : is_front || from_inside;
                if (!is_seen) continue;
                weight[i] = SphericalRectangle(point, f.corner, f.edge_x, f.edge_y).solid_angle();
                sum += weight[i];
            }
            solid_angle = sum;
            by_area = sum < least_solid_angle;
            if (!by_area) return;
            sum = 0;
            for (std::size_t i = 0; i < light.faces_.size(); ++i) {
                const Face& f = light.faces_[i];
                const Vec3d d = point - f.corner - 0.5 * (f.edge_x + f.edge_y);
                const double facing = dot(d, f.normal);
                const bool is_seen = facing > 0 || (light.faces_.size() == 1 && light.both_sides_);
                weight[i] = is_seen ? f.area * std::abs(facing) / std::pow(dot(d, d), 1.5) : 0;
                sum += weight[i];
            }
            solid_angle = sum;
        }
        // 1/sr, of a point p of face i.
        double pdf(const Vec3d& from, const Face& f, std::size_t i, const Vec3d& p) const {
            if (!by_area) return 1 / sum;
            const Vec3d d = p - from;
            const double r2 = dot(d, d), facing = std::abs(dot(d, f.normal));
            return facing > 0 ? weight[i] / sum * r2 * std::sqrt(r2) / (facing * f.area) : 0;
        }
    };
    bool is_inside(const Vec3d& point) const {
        return faces_.size() > 1 && std::all_of(faces_.begin(), faces_.end(), [&](const Face& f) {
                   return dot(point - f.corner, f.normal) <= 0;
               });
    }

    std::vector<Face> faces_;  // of a box in the order of SurfaceHit::primitive
    bool both_sides_;
};

// ---- A disc, by area.
class DiscLight : public SurfaceLight {
  public:
    DiscLight(const Disc& disc, bool both_sides, int surface, const Vec3f& emission)
        : disc_(disc), both_sides_(both_sides) {
        surface_ = surface;
        emission_ = emission;
        orthonormal_frame(disc.normal, s_, t_);
    }

    LightSample sample(const Vec3d& point, Vec2f u) const override {
        if (!is_seen(point)) return {{0, 0, 1}, 0, {}, 0};
        const double r = disc_.radius * std::sqrt(static_cast<double>(u.x)),
                     turn = 2 * pi * static_cast<double>(u.y);
        const Vec3d p = disc_.center + r * (std::cos(turn) * s_ + std::sin(turn) * t_);
        return towards(point, p, emission_, area_pdf(point, p));
    }
    float pdf(const Vec3d& point, const Vec3d& direction) const override {
        const auto hit = intersect(Shape(disc_), {point, direction});
        if (!hit || !is_seen(point)) return 0;
        return static_cast<float>(area_pdf(point, point + hit->t * direction));
    }
    float pdf_of_hit(const Vec3d& from, const SurfaceHit& hit) const override {
        return is_seen(from) ? static_cast<float>(area_pdf(from, hit.point)) : 0;
    }
    Vec3f mean_radiance(const Vec3d& point) const override {
        if (!is_seen(point)) return {};
        return emission_ *
               static_cast<float>(
                   over_sphere * disc_solid_angle(point, disc_.center, disc_.normal, disc_.radius));
    }
    std::optional<LightPlace> place() const override {
        return LightPlace{disc_.center, disc_.radius};
    }
    double power() const override {
        return pi * area() * (both_sides_ ? 2 : 1) * static_cast<double>(luminance(emission_));
    }
    AreaPoint area_point(Vec2f u) const override {
        const double r = disc_.radius * std::sqrt(static_cast<double>(u.x)),
                     turn = 2 * pi * static_cast<double>(u.y);
        const Vec3d p = disc_.center + r * (std::cos(turn) * s_ + std::sin(turn) * t_);
        return {p, disc_.normal, 0, drawn_offset(p, disc_.radius)};
    }
    double area() const override { return pi * disc_.radius * disc_.radius; }

  private:
    bool is_seen(const Vec3d& from) const {
        return both_sides_ || dot(from - disc_.center, disc_.normal) > 0;
    }
    double area_pdf(const Vec3d& from, const Vec3d& p) const {
        const Vec3d d = p - from;
        const double r2 = dot(d, d), facing = std::abs(dot(d, disc_.normal));
        return facing > 0 ? r2 * std::sqrt(r2) / (facing * pi * disc_.radius * disc_.radius) : 0;
    }

    Disc disc_;
    bool both_sides_;
    Vec3d s_, t_;
};

std::vector<Face> box_faces(const SolidBox& box) {
    std::vector<Face> faces;
    for (int i = 0; i < 6; ++i) {
        const int axis = i / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double side = i % 2 ? 1 : -1;
        Vec3d corner = -0.5 * box.size, x, y, n;
        if (side > 0) corner[axis] *= -1;
        x[u] = box.size[u];
        y[v] = box.size[v];
        n[axis] = side;
        const Transform& turn = box.rotation;
        faces.push_back({box.center + turn.vector(corner), turn.vector(x), turn.vector(y),
                         turn.vector(n), box.size[u] * box.size[v]});
    }
    return faces;
}

// ---- Triangles of a mesh.
class MeshLight : public SurfaceLight {
  public:
    MeshLight(const std::vector<Vec3d>& points, const std::vector<Vec3i>& triangles,
              bool both_sides, int surface, const Vec3f& emission)
        : points_(points), triangles_(triangles), both_sides_(both_sides) {
        surface_ = surface;
        emission_ = emission;
        Box3d box = Box3d::empty();
        cumulative_.push_back(0);
        for (const Vec3i& t : triangles_) {
            const auto [a, b, c] = corners(t);
            cumulative_.push_back(cumulative_.back() + 0.5 * length(cross(b - a, c - a)));
            for (const Vec3d& p : {a, b, c}) box.extend(p);
        }
        middle_ = 0.5 * (box.lo + box.hi);
        reach_ = length(0.5 * (box.hi - box.lo));
    }

    LightSample sample(const Vec3d& point, Vec2f u) const override {
        const auto [i, share] = triangle_at(static_cast<double>(u.x));
        const Vec2f v{std::clamp(static_cast<float>(share), 0.0f, 0x1.fffffep-1f), u.y};
        const auto [a, b, c] = corners(triangles_[i]);
        const Vec3d f = cross(b - a, c - a);
        if (!both_sides_ && dot(point - a, f) <= 0) return {{0, 0, 1}, 0, {}, 0};
        const SphericalTriangle seen(point, a, b, c);
        Vec3d p;
        if (seen.solid_angle() > least_solid_angle) {
            const Vec3d d = seen.direction(v);
            p = point + dot(a - point, f) / dot(d, f) * d;
        } else {
            // Evenly in area: the square folded to a triangle by its root.
            const double r = std::sqrt(static_cast<double>(v.x)), s = static_cast<double>(v.y);
            p = (1 - r) * a + r * (1 - s) * b + r * s * c;
        }
        LightSample sample = towards(point, p, emission_, triangle_pdf(point, i, p));
        // The search for what is in between has the rounding of float.
        const double cosine = std::abs(dot(sample.direction, f)) / length(f);
        sample.distance -= std::min(0.5 * sample.distance, 1e-6 * reach_ / (cosine + 1e-3));
        return sample;
    }
    // Goes through all triangles; pdf_of_hit does not.
    float pdf(const Vec3d& point, const Vec3d& direction) const override {
        double nearest = 1e300, pdf = 0;
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const auto [a, b, c] = corners(triangles_[i]);
            const Vec3d e1 = b - a, e2 = c - a, h = cross(direction, e2), s = point - a,
                        q = cross(s, e1);
            const double det = dot(e1, h), u = dot(s, h) / det, v = dot(direction, q) / det,
                         t = dot(e2, q) / det;
            if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < nearest)) continue;
            nearest = t;
            pdf = triangle_pdf(point, i, point + t * direction);
        }
        return static_cast<float>(pdf);
    }
    float pdf_of_hit(const Vec3d& from, const SurfaceHit& hit) const override {
        return static_cast<float>(
            triangle_pdf(from, static_cast<std::size_t>(hit.primitive), hit.point));
    }
    // An estimate: the light of a ball around the mesh with the same power, halved where only one
    // side of each triangle can be seen.
    Vec3f mean_radiance(const Vec3d& point) const override {
        const Vec3d d = point - middle_;
        const double r2 = std::max(dot(d, d), reach_ * reach_);
        return emission_ *
               static_cast<float>(std::min(1.0, over_sphere * 0.5 * cumulative_.back() / r2));
    }
    std::optional<LightPlace> place() const override { return LightPlace{middle_, reach_}; }
    double power() const override {
        return pi * area() * (both_sides_ ? 2 : 1) * static_cast<double>(luminance(emission_));
    }
    AreaPoint area_point(Vec2f u) const override {
        const auto [i, share] = triangle_at(static_cast<double>(u.x));
        const auto [a, b, c] = corners(triangles_[i]);
        const double r = std::sqrt(share), s = static_cast<double>(u.y);
        const Vec3d p = (1 - r) * a + r * (1 - s) * b + r * s * c;
        // The search tree has the corners in float.
        const double offset = 1e-6 * (max_component(abs(p)) + reach_);
        return {p, normalize(cross(b - a, c - a)), static_cast<int>(i), offset};
    }
    double area() const override { return cumulative_.back(); }

  private:
    // The triangle for a number in [0,1), and what is left of it, in [0,1] again.
    std::pair<std::size_t, double> triangle_at(double u) const {
        const double at = u * cumulative_.back();
        const auto next = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, at);
        const auto i = static_cast<std::size_t>(next - cumulative_.begin()) - 1;
        return {i, (at - cumulative_[i]) / (cumulative_[i + 1] - cumulative_[i])};
    }
    std::array<Vec3d, 3> corners(const Vec3i& t) const {
        return {points_[static_cast<std::size_t>(t.x)], points_[static_cast<std::size_t>(t.y)],
                points_[static_cast<std::size_t>(t.z)]};
    }
    // 1/sr, of a point p of triangle i.
    double triangle_pdf(const Vec3d& from, std::size_t i, const Vec3d& p) const {
        const auto [a, b, c] = corners(triangles_[i]);
        const Vec3d f = cross(b - a, c - a);
        if (!both_sides_ && dot(from - a, f) <= 0) return 0;
        const double area = cumulative_[i + 1] - cumulative_[i], chance = area / cumulative_.back();
        const double solid_angle = triangle_solid_angle(from, a, b, c);
        if (solid_angle > least_solid_angle) return chance / solid_angle;
        const Vec3d d = p - from;
        const double r2 = dot(d, d), facing = std::abs(dot(d, f)) / (2 * area);
        return facing > 0 ? chance * r2 * std::sqrt(r2) / (facing * area) : 0;
    }

    std::vector<Vec3d> points_;
    std::vector<Vec3i> triangles_;
    std::vector<double> cumulative_;  // area before each triangle
    bool both_sides_;
    Vec3d middle_;
    double reach_ = 0;
};

struct MakeLight {
    int surface;
    const SurfaceInfo& info;
    using Made = std::shared_ptr<SurfaceLight>;

    Made operator()(const Sphere& s) const {
        return std::make_shared<SphereLight>(s, surface, info.emission);
    }
    Made operator()(const SolidBox& b) const {
        return std::make_shared<FaceLight>(box_faces(b), true, surface, info.emission);
    }
    Made operator()(const Plane&) const { return nullptr; }
    Made operator()(const Rectangle& r) const {
        const Face face{r.center - 0.5 * (r.edge_x + r.edge_y), r.edge_x, r.edge_y, r.normal(),
                        length(r.edge_x) * length(r.edge_y)};
        return std::make_shared<FaceLight>(std::vector<Face>{face}, info.two_sided, surface,
                                           info.emission);
    }
    Made operator()(const Disc& d) const {
        return std::make_shared<DiscLight>(d, info.two_sided, surface, info.emission);
    }
};

}  // namespace

std::vector<std::shared_ptr<const SurfaceLight>> make_surface_lights(
    const SurfaceSet::Content& content) {
    std::vector<std::shared_ptr<const SurfaceLight>> lights;
    const SurfaceMoments moments{content.time, content.shutter, content.scene_up};
    for (std::size_t i = 0; i < content.surfaces.size(); ++i) {
        const SurfaceEntry& s = content.surfaces[i];
        if (!(max_component(s.info.emission) > 0) || s.info.is_moving) continue;
        const int index = static_cast<int>(i);
        std::shared_ptr<SurfaceLight> light;
        if (s.mesh) {
            const TriangleObject object = triangle_object(s, moments);
            light = std::make_shared<MeshLight>(object.points, object.triangles, s.info.two_sided,
                                                index, s.info.emission);
        } else {
            light = std::visit(MakeLight{index, s.info}, s.shape);
        }
        if (!light) continue;
        light->name = s.info.name;
        light->camera_visible = s.info.camera_visible;
        lights.push_back(std::move(light));
    }
    return lights;
}

}  // namespace gischt
