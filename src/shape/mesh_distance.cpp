// SPDX-License-Identifier: Apache-2.0
#include "shape/mesh_distance.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace gischt {
namespace {

constexpr int leaf_triangles = 8;  // as many cost about as much as two boxes

double square(const Vec3d& v) {
    return dot(v, v);
}

double square_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const Vec3d along = b - a;
    const double l = square(along);
    const double share = l > 0 ? std::clamp(dot(p - a, along) / l, 0.0, 1.0) : 0;
    return square(p - (a + share * along));
}

double square_to_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d n = cross(b - a, c - a);
    // Over the face where it is on the inner side of all three edges, ...
    const bool is_over = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                         dot(cross(a - c, p - c), n) >= 0;
    if (is_over && square(n) > 0) {
        const double height = dot(p - a, n);
        return height * height / square(n);
    }
    // ... else an edge is nearest.
    return std::min(
        {square_to_segment(p, a, b), square_to_segment(p, b, c), square_to_segment(p, c, a)});
}

double square_to_box(const Vec3d& p, const Box3d& box) {
    return square(max(max(box.lo - p, p - box.hi), Vec3d()));
}

// Positive seen from inside (Van Oosterom & Strackee 1983).
double signed_solid_angle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d u = a - p, v = b - p, w = c - p;
    const double lu = length(u), lv = length(v), lw = length(w);
    const double below = lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv;
    return 2 * std::atan2(dot(u, cross(v, w)), below);
}

}  // namespace

MeshDistance::MeshDistance(const Mesh& mesh) {
    const auto refuse = [](const char* what, const char* hint) {
        throw Error(ErrorKind::Input, "mesh", what, hint);
    };
    Mesh sound = mesh;
    const MeshFaults faults = remove_faults(sound);
    if (faults.not_finite + faults.no_point > 0)
        refuse("has triangles with points that are missing or not finite", "");
    if (sound.triangles.empty()) refuse("has no triangles", "");
    if (!is_closed(mesh))
        refuse("is not closed: it has no inside",
               "close its holes, and turn its triangles all the same way");

    for (const Vec3i& t : sound.triangles) {
        const auto point = [&](int i) { return Vec3d(sound.points[static_cast<std::size_t>(i)]); };
        triangles_.push_back({point(t.x), point(t.y), point(t.z)});
    }
    nodes_.reserve(triangles_.size());
    build(0, static_cast<int>(triangles_.size()));
}

int MeshDistance::build(int first, int count) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    const auto begin = triangles_.begin() + first, end = begin + count;
    Node node;
    node.box = Box3d::empty();
    Box3d middles = Box3d::empty();
    double sum = 0;
    for (auto t = begin; t != end; ++t) {
        for (const Vec3d& corner : {t->a, t->b, t->c}) node.box.extend(corner);
        const Vec3d area = 0.5 * cross(t->b - t->a, t->c - t->a), middle = (t->a + t->b + t->c) / 3;
        middles.extend(middle);
        node.area += area;
        node.middle += length(area) * middle;
        sum += length(area);
    }
    node.middle = node.middle / sum;  // triangles without an area are not here
    for (auto t = begin; t != end; ++t) {
        for (const Vec3d& corner : {t->a, t->b, t->c})
            node.radius = std::max(node.radius, length(corner - node.middle));
    }

    if (count <= leaf_triangles) {
        node.first = first;
        node.count = count;
    } else {
        // Half of them on either side along the longest axis.
        const Vec3d size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::nth_element(begin, begin + count / 2, end, [&](const Triangle& s, const Triangle& t) {
            return s.a[axis] + s.b[axis] + s.c[axis] < t.a[axis] + t.b[axis] + t.c[axis];
        });
        build(first, count / 2);
        node.second = build(first + count / 2, count - count / 2);
    }
    nodes_[static_cast<std::size_t>(index)] = node;
    return index;
}

void MeshDistance::nearest(int index, const Vec3d& p, double& best) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.count > 0) {
        for (int i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = triangles_[static_cast<std::size_t>(i)];
            best = std::min(best, square_to_triangle(p, t.a, t.b, t.c));
        }
        return;
    }
    // The nearer child first: it may spare the other one.
    int children[2] = {index + 1, node.second};
    double far[2];
    for (int k = 0; k < 2; ++k)
        far[k] = square_to_box(p, nodes_[static_cast<std::size_t>(children[k])].box);
    if (far[1] < far[0]) {
        std::swap(far[0], far[1]);
        std::swap(children[0], children[1]);
    }
    for (int k = 0; k < 2; ++k) {
        if (far[k] < best) nearest(children[k], p, best);
    }
}

double MeshDistance::distance(const Vec3d& p, double limit) const {
    double best = limit * limit;
    if (square_to_box(p, bounds()) < best) nearest(0, p, best);
    return std::sqrt(best);
}

double MeshDistance::solid_angle(int index, const Vec3d& p) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    const Vec3d to = node.middle - p;
    const double l = length(to);
    // Two radii away a dipole is off by some hundredths of 4 pi in all; it has to tell 0 from 1.
    if (l > 2 * node.radius) return dot(node.area, to) / (l * l * l);
    if (node.count == 0) return solid_angle(index + 1, p) + solid_angle(node.second, p);
    double sum = 0;
    for (int i = node.first; i < node.first + node.count; ++i) {
        const Triangle& t = triangles_[static_cast<std::size_t>(i)];
        sum += signed_solid_angle(p, t.a, t.b, t.c);
    }
    return sum;
}

bool MeshDistance::is_inside(const Vec3d& p) const {
    if (square_to_box(p, bounds()) > 0) return false;
    return std::abs(solid_angle(0, p)) > 2 * pi;
}

}  // namespace gischt
