// SPDX-License-Identifier: Apache-2.0
// How the points of a surface move.
#include "optics/surface_content.h"

namespace gischt {
namespace {

// Of a point in the plane of a triangle.
Vec3d barycentric(const std::array<Vec3d, 3>& corner, const Vec3d& p) {
    const Vec3d u = corner[1] - corner[0], v = corner[2] - corner[0], w = p - corner[0];
    const Vec3d n = cross(u, v);
    const double area = dot(n, n);
    const double b = dot(cross(w, v), n) / area, c = dot(cross(u, w), n) / area;
    return {1 - b - c, b, c};
}

// The velocity that a mesh gives its points, m/s in its own frame, where a point is `since` seconds
// after the moment for which the file holds them.
Vec3d own_velocity(const Mesh& mesh, int triangle, const Vec3d& point, double since) {
    if (mesh.velocities.empty()) return {};
    const Vec3i& t = mesh.triangles[static_cast<std::size_t>(triangle)];
    std::array<Vec3d, 3> corner, velocity;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i), p = static_cast<std::size_t>(t[i]);
        velocity[at] = Vec3d(mesh.velocities[p]);
        corner[at] = Vec3d(mesh.points[p]) + since * velocity[at];
    }
    const Vec3d share = barycentric(corner, point);
    return share.x * velocity[0] + share.y * velocity[1] + share.z * velocity[2];
}

}  // namespace

Vec3d SurfaceSet::carried_to(double time, const SurfaceHit& hit, float moment) const {
    const Content& c = *content_;
    const SurfaceEntry& s = c.surfaces[static_cast<std::size_t>(hit.surface)];
    const SurfaceMoments moments{c.time, c.shutter, c.scene_up};
    const double now = moments.at(static_cast<double>(moment));
    if (s.mesh) {
        const auto& params = std::get<MeshSurface>(s.params);
        Vec3d p = mesh_placement(params, now, c.scene_up).inverse().point(hit.point);
        p += (time - now) * own_velocity(*s.mesh->source, hit.primitive, p, now - c.time);
        return mesh_placement(params, time, c.scene_up).point(p);
    }
    const Transform from = local_frame(shape_at(s.params, now, c.scene_up)),
                    to = local_frame(shape_at(s.params, time, c.scene_up));
    return to.point(from.inverse().point(hit.point));
}

}  // namespace gischt
