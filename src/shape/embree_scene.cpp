// SPDX-License-Identifier: Apache-2.0
#include "shape/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "base/error.h"

namespace gischt {
namespace {

constexpr double half_ulp = 0x1p-24;  // of a float near 1

struct DeviceDeleter {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
struct SceneDeleter {
    void operator()(RTCScene s) const { rtcReleaseScene(s); }
};

// What the filter is told about a ray.
struct SearchContext {
    RTCIntersectContext embree;  // first, so that Embree's pointer is one to this
    std::uint32_t skip = 0;
    const std::vector<TriangleObject>* objects{};
    std::vector<RTCHit>* all{};
};

void pass_skipped(const RTCFilterFunctionNArguments* args) {
    const auto* search = reinterpret_cast<const SearchContext*>(args->context);
    const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, 0);
    if ((*search->objects)[hit.geomID].bits & search->skip) args->valid[0] = 0;
}

void collect(const RTCFilterFunctionNArguments* args) {
    const auto* search = reinterpret_cast<const SearchContext*>(args->context);
    search->all->push_back(rtcGetHitFromHitN(args->hit, args->N, 0));
    args->valid[0] = 0;
}

[[noreturn]] void fail(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    throw Error(code == RTC_ERROR_OUT_OF_MEMORY ? ErrorKind::Resource : ErrorKind::Internal,
                "meshes",
                "the search tree could not be built (Embree error " +
                    std::to_string(static_cast<int>(code)) + ")");
}

}  // namespace

struct EmbreeScene::Content {
    std::vector<TriangleObject> objects;
    Box3d bounds = Box3d::empty();
    Vec3d middle;      // Embree's coordinates count from here, so that floats suffice
    double reach = 0;  // largest coordinate in them
    std::uint32_t bits = 0;
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceDeleter> device;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneDeleter> scene;

    void build();
    void add(const TriangleObject& object, unsigned id);
    void set_points(RTCGeometry geometry, unsigned slot, const std::vector<Vec3d>& points) const;
    // The point of an object at a moment, as Embree has it.
    Vec3d point(const TriangleObject& object, int index, double moment) const;
    TriangleHit finish(const RTCHit& hit, const Ray& ray, float moment) const;
};

Vec3d EmbreeScene::Content::point(const TriangleObject& object, int index, double moment) const {
    const auto i = static_cast<std::size_t>(index);
    const Vec3d begin(Vec3f(object.points[i] - middle));
    if (object.points_end.empty()) return begin;
    return begin + moment * (Vec3d(Vec3f(object.points_end[i] - middle)) - begin);
}

void EmbreeScene::Content::set_points(RTCGeometry geometry, unsigned slot,
                                      const std::vector<Vec3d>& points) const {
    auto* out = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, slot,
                                                            RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                            points.size()));
    if (!out) fail(device.get());
    for (const Vec3d& p : points) {
        const Vec3f q(p - middle);
        for (int a = 0; a < 3; ++a) *out++ = q[a];
    }
}

void EmbreeScene::Content::add(const TriangleObject& object, unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const bool moves = !object.points_end.empty();
    rtcSetGeometryTimeStepCount(geometry, moves ? 2 : 1);
    set_points(geometry, 0, object.points);
    if (moves) set_points(geometry, 1, object.points_end);
    auto* corner = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), object.triangles.size()));
    if (!corner) fail(device.get());
    for (const Vec3i& t : object.triangles) {
        for (int k = 0; k < 3; ++k) *corner++ = static_cast<unsigned>(t[k]);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene.get(), geometry, id);
    rtcReleaseGeometry(geometry);
}

void EmbreeScene::Content::build() {
    // One thread builds the tree, so that it never depends on their number.
    device.reset(rtcNewDevice("threads=1,set_affinity=0"));
    if (!device) fail(nullptr);
    scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(
        scene.get(),
        static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    for (std::size_t i = 0; i < objects.size(); ++i) add(objects[i], static_cast<unsigned>(i));
    rtcCommitScene(scene.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) fail(device.get());
}

EmbreeScene::EmbreeScene(std::vector<TriangleObject> objects) {
    auto content = std::make_shared<Content>();
    content->objects = std::move(objects);
    bool is_empty = true;
    for (const TriangleObject& o : content->objects) {
        for (const Vec3i& t : o.triangles) {
            is_empty = false;
            for (int k = 0; k < 3; ++k) {
                const auto i = static_cast<std::size_t>(t[k]);
                content->bounds.extend(o.points[i]);
                if (!o.points_end.empty()) content->bounds.extend(o.points_end[i]);
            }
        }
        content->bits |= o.bits;
    }
    if (is_empty) return;
    content->middle = 0.5 * (content->bounds.lo + content->bounds.hi);
    content->reach = max_component(content->bounds.hi - content->middle);
    content->build();
    content_ = std::move(content);
}

Box3d EmbreeScene::bounds() const {
    return content_ ? content_->bounds : Box3d::empty();
}

namespace {

// A ray in Embree's coordinates: of unit length, and begun close to the triangles, so that its
// origin has the digits of their coordinates. t = begin + s * t_embree.
struct FloatRay {
    RTCRay ray{};
    double begin = 0, scale = 1;
    bool is_empty = true;

    FloatRay(const Ray& r, const Box3d& bounds, const Vec3d& middle, double reach, float moment) {
        const double l = length(r.direction);
        if (!(l > 0)) return;
        const Vec3d margin(1e-6 * reach);
        const Interval inside = clip(r, {bounds.lo - margin, bounds.hi + margin});
        if (!(inside.t0 <= inside.t1)) return;
        is_empty = false;
        scale = 1 / l;
        begin = inside.t0;
        const Vec3f o(r.at(begin) - middle), d(r.direction * scale);
        ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
        ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
        // The box's far side counts a little further, for what lies in it.
        ray.tfar = r.t_max > inside.t1 ? std::numeric_limits<float>::infinity()
                                       : std::nextafter(static_cast<float>((r.t_max - begin) * l),
                                                        std::numeric_limits<float>::infinity());
        ray.time = moment;
        ray.mask = ~0u;
    }
};

}  // namespace

TriangleHit EmbreeScene::Content::finish(const RTCHit& found, const Ray& ray, float moment) const {
    TriangleHit hit;
    hit.object = static_cast<int>(found.geomID);
    hit.triangle = static_cast<int>(found.primID);
    const TriangleObject& object = objects[found.geomID];
    const Vec3i& t = object.triangles[found.primID];
    const auto time = static_cast<double>(moment);
    const Vec3d a = point(object, t.x, time), b = point(object, t.y, time),
                c = point(object, t.z, time);

    // The point in double on the triangle; its t is that of the nearest point of the ray.
    hit.barycentric = {static_cast<double>(found.u), static_cast<double>(found.v)};
    const Vec3d p = a + hit.barycentric.x * (b - a) + hit.barycentric.y * (c - a);
    hit.point = p + middle;
    hit.t = dot(hit.point - ray.origin, ray.direction) / dot(ray.direction, ray.direction);

    // A new origin is rounded by half an ulp of its coordinates (twice for points in motion, which
    // are interpolated in float). The search takes corners relative to it, rounded by half ulps of
    // their distance, and a normal whose error is that of a product of the two shorter edges: large
    // beside the normal itself only where all edges are long and the triangle is slim.
    const Vec3d e1 = b - a, e2 = c - a, f = cross(e1, e2);
    const double area2 = length(f);
    hit.normal = area2 > 0 ? f / area2 : Vec3d{0, 0, 1};
    double edges[3] = {length(e1), length(e2), length(e2 - e1)};
    std::sort(edges, edges + 3);
    const double slimness = area2 > 0 ? std::min(edges[0] * edges[1] / area2, 1e4) : 1;
    hit.offset = half_ulp * (8 * max_component(abs(p)) + 8 * edges[2] * slimness) +
                 static_cast<double>(std::numeric_limits<float>::min());
    return hit;
}

std::optional<TriangleHit> EmbreeScene::intersect(const Ray& ray, float moment,
                                                  std::uint32_t skip) const {
    if (!content_) return std::nullopt;
    const FloatRay start(ray, content_->bounds, content_->middle, content_->reach, moment);
    if (start.is_empty) return std::nullopt;
    SearchContext search;
    rtcInitIntersectContext(&search.embree);
    search.skip = skip;
    search.objects = &content_->objects;
    if (skip & content_->bits) search.embree.filter = pass_skipped;
    RTCRayHit found{};
    found.ray = start.ray;
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(content_->scene.get(), &search.embree, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return content_->finish(found.hit, ray, moment);
}

bool EmbreeScene::is_blocked(const Ray& ray, float moment, std::uint32_t skip) const {
    if (!content_) return false;
    FloatRay start(ray, content_->bounds, content_->middle, content_->reach, moment);
    if (start.is_empty) return false;
    SearchContext search;
    rtcInitIntersectContext(&search.embree);
    search.skip = skip;
    search.objects = &content_->objects;
    if (skip & content_->bits) search.embree.filter = pass_skipped;
    rtcOccluded1(content_->scene.get(), &search.embree, &start.ray);
    return start.ray.tfar < 0;
}

std::vector<TriangleHit> EmbreeScene::all_hits(const Ray& ray, float moment) const {
    std::vector<TriangleHit> hits;
    if (!content_) return hits;
    const FloatRay start(ray, content_->bounds, content_->middle, content_->reach, moment);
    if (start.is_empty) return hits;
    std::vector<RTCHit> found;
    SearchContext search;
    rtcInitIntersectContext(&search.embree);
    search.objects = &content_->objects;
    search.all = &found;
    search.embree.filter = collect;
    RTCRayHit any{};
    any.ray = start.ray;
    any.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(content_->scene.get(), &search.embree, &any);
    for (const RTCHit& f : found) hits.push_back(content_->finish(f, ray, moment));
    std::sort(hits.begin(), hits.end(), [](const TriangleHit& a, const TriangleHit& b) {
        return std::tie(a.t, a.object, a.triangle) < std::tie(b.t, b.object, b.triangle);
    });
    return hits;
}

}  // namespace gischt
