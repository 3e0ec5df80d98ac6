// SPDX-License-Identifier: Apache-2.0
#include "shape/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "base/random.h"
#include "base/units.h"

namespace gischt {
namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

// Bits of a vector as a key; -0 counts as 0.
struct PointKey {
    std::array<std::uint32_t, 3> bits{};

    explicit PointKey(const Vec3f& p) {
        const std::array<float, 3> v{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
        std::memcpy(bits.data(), v.data(), sizeof(bits));
    }
    bool operator==(const PointKey&) const = default;
};
struct PointHash {
    std::size_t operator()(const PointKey& k) const {
        return random_key(k.bits[0], k.bits[1], k.bits[2]);
    }
};

// For each point the first one at its place.
std::vector<int> welded(const std::vector<Vec3f>& points) {
    std::vector<int> first(points.size());
    std::unordered_map<PointKey, int, PointHash> known;
    known.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        first[i] = known.try_emplace(PointKey(points[i]), static_cast<int>(i)).first->second;
    }
    return first;
}

// Twice the area times the normal.
Vec3d face_vector(const Mesh& mesh, const Vec3i& t) {
    const Vec3d a(mesh.points[at(t.x)]), b(mesh.points[at(t.y)]), c(mesh.points[at(t.z)]);
    return cross(b - a, c - a);
}

bool is_finite(const Vec3f& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

Mesh transformed(Mesh mesh, const Transform& map) {
    const bool is_mirror = map.determinant() < 0;
    // Normals turn with the cofactors, the inverse transpose times the determinant.
    const Transform cofactors{
        {cross(map.column[1], map.column[2]), cross(map.column[2], map.column[0]),
         cross(map.column[0], map.column[1])},
        {}};
    for (Vec3f& p : mesh.points) p = Vec3f(map.point(Vec3d(p)));
    for (Vec3f& v : mesh.velocities) v = Vec3f(map.vector(Vec3d(v)));
    for (Vec3f& n : mesh.normals) {
        const Vec3d turned = (is_mirror ? -1.0 : 1.0) * cofactors.vector(Vec3d(n));
        const double l = length(turned);
        if (l > 0) n = Vec3f(turned / l);
    }
    if (is_mirror) {
        for (Vec3i& t : mesh.triangles) std::swap(t.y, t.z);
    }
    return mesh;
}

MeshFaults remove_faults(Mesh& mesh) {
    MeshFaults faults;
    const int count = static_cast<int>(mesh.points.size());
    const auto is_faulty = [&](const Vec3i& t) {
        if (std::min({t.x, t.y, t.z}) < 0 || std::max({t.x, t.y, t.z}) >= count) {
            ++faults.no_point;
            return true;
        }
        if (!is_finite(mesh.points[at(t.x)]) || !is_finite(mesh.points[at(t.y)]) ||
            !is_finite(mesh.points[at(t.z)])) {
            ++faults.not_finite;
            return true;
        }
        const Vec3d f = face_vector(mesh, t);
        const bool is_flat = !(dot(f, f) > 0);
        faults.flat += is_flat;
        return is_flat;
    };
    std::erase_if(mesh.triangles, is_faulty);
    return faults;
}

bool is_closed(const Mesh& mesh) {
    if (mesh.triangles.empty()) return false;
    const std::vector<int> weld = welded(mesh.points);
    std::unordered_map<std::uint64_t, int> balance;  // of edges by their ends, lower first
    balance.reserve(mesh.triangles.size() * 2);
    for (const Vec3i& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = weld[at(t[k])], b = weld[at(t[(k + 1) % 3])];
            if (a == b) continue;
            const auto lo = static_cast<std::uint64_t>(std::min(a, b)),
                       hi = static_cast<std::uint64_t>(std::max(a, b));
            balance[lo << 32 | hi] += a < b ? 1 : -1;
        }
    }
    return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

double enclosed_volume(const Mesh& mesh) {
    if (mesh.triangles.empty()) return 0;
    const Vec3d origin(mesh.points[at(mesh.triangles.front().x)]);
    double sum = 0;
    for (const Vec3i& t : mesh.triangles) {
        sum += dot(Vec3d(mesh.points[at(t.x)]) - origin, face_vector(mesh, t));
    }
    return sum / 6;
}

double surface_area(const Mesh& mesh) {
    double sum = 0;
    for (const Vec3i& t : mesh.triangles) sum += length(face_vector(mesh, t));
    return 0.5 * sum;
}

Box3d bounds(const Mesh& mesh) {
    Box3d box = Box3d::empty();
    for (const Vec3i& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) box.extend(Vec3d(mesh.points[at(t[k])]));
    }
    return box;
}

bool add_polygon(Mesh& mesh, const std::vector<int>& polygon) {
    std::vector<int> corners = polygon;
    const auto place = [&](std::size_t i) {
        return Vec3d(mesh.points[at(corners[i % corners.size()])]);
    };
    Vec3d normal;  // of least projection error, by Newell's sum
    for (std::size_t i = 0; i < corners.size(); ++i) normal += cross(place(i), place(i + 1));
    // Twice the area of a triangle as seen along the normal.
    const auto turn = [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
        return dot(normal, cross(q - p, r - p));
    };
    bool is_convex = true;
    for (std::size_t i = 0; i < corners.size() && is_convex; ++i) {
        is_convex = turn(place(i), place(i + 1), place(i + 2)) >= 0;
    }
    if (!is_convex && corners.size() > 1024) return false;

    // A corner is an ear where the polygon turns inwards and no other corner lies in its triangle.
    const auto is_ear = [&](std::size_t i) {
        const std::size_t n = corners.size();
        const Vec3d a = place(i + n - 1), b = place(i), c = place(i + 1);
        if (!(turn(a, b, c) > 0)) return false;
        for (std::size_t k = 2; k + 1 < n; ++k) {
            const Vec3d p = place(i + k);
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    };
    while (!is_convex && corners.size() > 3) {
        const std::size_t n = corners.size();
        std::size_t ear = 0;
        while (ear < n && !is_ear(ear)) ++ear;
        if (ear == n) break;  // it crosses itself: the rest as a fan
        mesh.triangles.emplace_back(corners[(ear + n - 1) % n], corners[ear],
                                    corners[(ear + 1) % n]);
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        mesh.triangles.emplace_back(corners[0], corners[i], corners[i + 1]);
    }
    return true;
}

Mesh with_smooth_normals(const Mesh& mesh, double crease_degrees) {
    const double least_cosine = std::cos(radians(crease_degrees)) - 1e-9;
    const std::vector<int> weld = welded(mesh.points);

    // The faces around each place: their normals, and their angles there.
    std::vector<Vec3d> face_normal;
    std::vector<int> begin(mesh.points.size() + 1, 0);
    for (const Vec3i& t : mesh.triangles) {
        const Vec3d f = face_vector(mesh, t);
        face_normal.push_back(dot(f, f) > 0 ? normalize(f) : Vec3d{});
        for (int k = 0; k < 3; ++k) ++begin[at(weld[at(t[k])]) + 1];
    }
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    struct Corner {
        int face;
        double angle;
    };
    std::vector<Corner> around(3 * mesh.triangles.size());
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Vec3i& t = mesh.triangles[f];
        for (int k = 0; k < 3; ++k) {
            const Vec3d p(mesh.points[at(t[k])]);
            const Vec3d a = Vec3d(mesh.points[at(t[(k + 1) % 3])]) - p,
                        b = Vec3d(mesh.points[at(t[(k + 2) % 3])]) - p;
            const double angle = std::atan2(length(cross(a, b)), dot(a, b));
            around[at(next[at(weld[at(t[k])])]++)] = {static_cast<int>(f), angle};
        }
    }

    // One point per place, coordinates and normal.
    Mesh out;
    std::map<std::pair<int, std::array<std::uint32_t, 3>>, int> known;
    const auto corner = [&](int point, std::size_t face) {
        const auto place = at(weld[at(point)]);
        Vec3d sum;
        for (int i = begin[place]; i < begin[place + 1]; ++i) {
            const Corner& c = around[at(i)];
            const Vec3d& n = face_normal[at(c.face)];
            if (dot(n, face_normal[face]) >= least_cosine) sum += c.angle * n;
        }
        const Vec3f normal(length(sum) > 1e-12 ? normalize(sum) : face_normal[face]);
        const auto [it, is_new] =
            known.try_emplace({point, PointKey(normal).bits}, static_cast<int>(out.points.size()));
        if (is_new) {
            out.points.push_back(mesh.points[at(point)]);
            out.normals.push_back(normal);
            if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[at(point)]);
            if (!mesh.velocities.empty()) out.velocities.push_back(mesh.velocities[at(point)]);
        }
        return it->second;
    };
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Vec3i& t = mesh.triangles[f];
        out.triangles.emplace_back(corner(t.x, f), corner(t.y, f), corner(t.z, f));
    }
    return out;
}

Mesh cube_mesh() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.points.emplace_back(i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, w = 1 << axis;
        mesh.triangles.emplace_back(w, w + u, w + u + v);
        mesh.triangles.emplace_back(w, w + u + v, w + v);
        mesh.triangles.emplace_back(0, u + v, u);
        mesh.triangles.emplace_back(0, v, u + v);
    }
    return mesh;
}

// An icosahedron, each triangle cut into four `level` times, with its points on the sphere.
Mesh ball_mesh(double radius, int level) {
    const double g = 0.5 * (1 + std::sqrt(5.0));
    std::vector<Vec3d> points;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 4; ++i) {
            Vec3d p;
            p[(axis + 1) % 3] = i & 1 ? 1 : -1;
            p[(axis + 2) % 3] = i & 2 ? g : -g;
            points.push_back(normalize(p));
        }
    }
    // The faces are the triples of neighbours, whose angle has the cosine 1 / sqrt 5.
    std::vector<Vec3i> faces;
    const auto is_near = [&](int a, int b) { return dot(points[at(a)], points[at(b)]) > 0.4; };
    for (int a = 0; a < 12; ++a) {
        for (int b = a + 1; b < 12; ++b) {
            for (int c = b + 1; c < 12; ++c) {
                if (!is_near(a, b) || !is_near(b, c) || !is_near(c, a)) continue;
                const bool is_outward = dot(points[at(a)], cross(points[at(b)], points[at(c)])) > 0;
                faces.emplace_back(a, is_outward ? b : c, is_outward ? c : b);
            }
        }
    }
    for (int l = 0; l < level; ++l) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [it, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                          static_cast<int>(points.size()));
            if (is_new) points.push_back(normalize(points[at(a)] + points[at(b)]));
            return it->second;
        };
        std::vector<Vec3i> finer;
        for (const Vec3i& t : faces) {
            const int ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    Mesh mesh;
    for (const Vec3d& p : points) mesh.points.emplace_back(radius * p);
    mesh.triangles = std::move(faces);
    return mesh;
}

}  // namespace gischt
