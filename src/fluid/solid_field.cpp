// SPDX-License-Identifier: Apache-2.0
#include "fluid/solid_field.h"

#include <cmath>
#include <limits>

namespace gischt {
namespace {

// Layers of points in a solid that get values. A trace leaves the fluid by its error only; two
// layers serve the interpolation there, two more the cubic one and the way back of MacCormack.
constexpr int ghost_layers = 4;

// Smallest open part of a face that counts as open.
constexpr float least_fraction = 0.01f;

}  // namespace

float open_fraction(float a, float b, float c, float d) {
    const std::array<float, 4> phi{a, b, c, d};
    constexpr std::array<float, 4> px{0, 1, 1, 0}, py{0, 0, 1, 1};
    // Walk around the square and collect the outline of the part with phi > 0; its area by the
    // shoelace formula.
    std::array<float, 8> x{}, y{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        if (phi[i] > 0) {
            x[n] = px[i];
            y[n++] = py[i];
        }
        if ((phi[i] > 0) != (phi[j] > 0)) {
            const float t = phi[i] / (phi[i] - phi[j]);
            x[n] = px[i] + t * (px[j] - px[i]);
            y[n++] = py[i] + t * (py[j] - py[i]);
        }
    }
    float twice = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        twice += x[i] * y[j] - x[j] * y[i];
    }
    return std::clamp(0.5f * twice, 0.0f, 1.0f);
}

SolidField::SolidField(const Domain& domain, const BlockMap& blocks,
                       std::vector<SolidParams> solids)
    : domain_(domain), blocks_(blocks), solids_(std::move(solids)) {
    for (const SolidParams& s : solids_) {
        check_solid(s);
        is_moving_ |= s.is_moving();
    }
    if (!solids_.empty()) update(0);
}

bool SolidField::update(double time) {
    if (solids_.empty() || (!shapes_.empty() && (!is_moving_ || time == time_))) return false;
    time_ = time;
    shapes_.clear();
    for (const SolidParams& s : solids_) shapes_.push_back(s.shape_at(time));
    fraction_ = FaceField(domain_.map, 1.0f);
    cut_.assign(static_cast<std::size_t>(blocks_.size()), 0);
    parallel_for(blocks_.size(), 1, [&](int block) { cut_block(block); });

    const Box3i cells = reach_of_solids();
    center_ghosts_.find(*domain_.map, -1, cells, ghost_layers,
                        [&](const Vec3i& c) { return signed_distance(domain_.center_of(c)) < 0; });
    for (int a = 0; a < domain_.axes(); ++a) {
        const Box3i faces = cells.is_empty() ? cells : domain_.faces_of(cells, a);
        face_ghosts_[static_cast<std::size_t>(a)].find(
            *domain_.map, a, faces, ghost_layers,
            [&](const Vec3i& f) { return fraction_.get(a, f) == 0; });
    }
    return true;
}

double SolidField::signed_distance(const Vec3d& point) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Shape& s : shapes_) nearest = std::min(nearest, gischt::signed_distance(s, point));
    return nearest;
}

Vec3d SolidField::velocity(const Vec3d& point) const {
    if (!is_moving_) return {};
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        const double distance = gischt::signed_distance(shapes_[s], point);
        if (distance < least) {
            least = distance;
            nearest = s;
        }
    }
    return solids_[nearest].velocity_at(time_, point);
}

double SolidField::top_speed() const {
    if (!is_moving_) return 0;
    // A velocity of rigid motion is largest at a corner of the part of the domain that is covered.
    const Vec3d lo = domain_.origin, hi = lo + domain_.h * Vec3d(domain_.cells);
    double top = 0;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        const Box3d box = bounds(shapes_[s]), part = intersection(box, Box3d{lo, hi});
        if (min_component(part.size()) < 0) continue;
        for (int c = 0; c < 8; ++c) {
            const Vec3d corner{c & 1 ? part.hi.x : part.lo.x, c & 2 ? part.hi.y : part.lo.y,
                               c & 4 ? part.hi.z : part.lo.z};
            top = std::max(top, max_component(abs(solids_[s].velocity_at(time_, corner))));
        }
    }
    return top;
}

// The cells that solids may cover, and one layer around them.
Box3i SolidField::reach_of_solids() const {
    Box3i all = Box3i::empty();
    const Box3d domain{{}, Vec3d(domain_.cells)};
    for (const Shape& s : shapes_) {
        const Box3d box = bounds(s);
        Box3d part{(box.lo - domain_.origin) / domain_.h, (box.hi - domain_.origin) / domain_.h};
        part = intersection(part, domain);
        if (min_component(part.size()) < 0) continue;
        all.extend(Box3i{floor(part.lo) - Vec3i(1), floor(part.hi) + Vec3i(2)});
    }
    return all.is_empty() ? Box3i{} : intersection(all, Box3i{{}, domain_.cells});
}

// Corners of the cells in metres; in 2-D all lie in the plane of the centres.
Vec3d SolidField::node(const Vec3i& corner) const {
    Vec3d p = domain_.origin + domain_.h * Vec3d(corner);
    if (domain_.is_2d()) p.z = domain_.origin.z + 0.5 * domain_.h;
    return p;
}

void SolidField::cut_block(int block) {
    const Box3i cells = blocks_.cells(block);
    const Vec3d lo = node(cells.lo), hi = node(cells.hi);
    const double reach = 0.5 * length(hi - lo), middle = signed_distance(0.5 * (lo + hi));
    if (middle > reach) return;
    cut_[static_cast<std::size_t>(block)] = 1;
    const Lattice nodes{{cells.lo, cells.hi + Vec3i(1)}};
    std::vector<float> distance(nodes.count());
    for_cells(nodes.region, [&](const Vec3i& c) {
        distance[static_cast<std::size_t>(nodes.index(c))] =
            static_cast<float>(signed_distance(node(c)));
    });
    for (int a = 0; a < domain_.axes(); ++a) cut_faces(block, a, distance, nodes);
}

void SolidField::cut_faces(int block, int axis, const std::vector<float>& distance,
                           const Lattice& nodes) {
    const Box3i faces = domain_.faces_of(blocks_.cells(block), axis);
    Vec3i u, v;
    u[(axis + 1) % 3] = 1;
    v[(axis + 2) % 3] = 1;
    for_cells(faces, [&](const Vec3i& f) {
        const auto phi = [&](const Vec3i& c) {
            return distance[static_cast<std::size_t>(nodes.index(c))];
        };
        const float open = open_fraction(phi(f), phi(f + u), phi(f + u + v), phi(f + v));
        fraction_.ref(axis, f) = open < least_fraction ? 0.0f : open;
    });
}

void SolidField::extrapolate(FaceField& velocity) const {
    for (int a = 0; a < domain_.axes(); ++a) {
        const auto s = static_cast<std::size_t>(a);
        face_ghosts_[s].extrapolate(velocity[a], &velocity.last[s]);
        for (const Vec3i& f : face_ghosts_[s].deep()) {
            velocity.ref(a, f) = static_cast<float>(this->velocity(domain_.face_center(a, f))[a]);
        }
    }
    slide(velocity);
}

// Gives the ghosts the solid's velocity along the normal of its surface.
void SolidField::slide(FaceField& velocity) const {
    const auto component_at = [&](int a, int face_axis, const Vec3i& face) {
        if (a == face_axis) return static_cast<double>(velocity.get(a, face));
        // The four faces along a around this one, as far as they exist.
        double sum = 0;
        int count = 0;
        for (const int back : {-1, 0}) {
            for (const int up : {0, 1}) {
                Vec3i f = face;
                f[face_axis] += back;
                f[a] += up;
                if (f[face_axis] < 0 || f[face_axis] >= domain_.cells[face_axis]) continue;
                sum += velocity.get(a, f);
                ++count;
            }
        }
        return sum / count;
    };
    std::array<std::vector<float>, 3> slid;
    for (int a = 0; a < domain_.axes(); ++a) {
        const auto& points = face_ghosts_[static_cast<std::size_t>(a)].points();
        auto& out = slid[static_cast<std::size_t>(a)];
        out.resize(points.size());
        parallel_for(static_cast<int>(points.size()), 256, [&](int i) {
            const Vec3i& f = points[static_cast<std::size_t>(i)];
            const Vec3d p = domain_.face_center(a, f), solid = this->velocity(p);
            Vec3d v, normal;
            for (int b = 0; b < domain_.axes(); ++b) {
                v[b] = component_at(b, a, f);
                Vec3d step;
                step[b] = 0.5 * domain_.h;
                normal[b] = signed_distance(p + step) - signed_distance(p - step);
            }
            const double size = length(normal);
            if (size > 0) v -= normal * (dot(v - solid, normal) / (size * size));
            out[static_cast<std::size_t>(i)] = static_cast<float>(v[a]);
        });
    }
    for (int a = 0; a < domain_.axes(); ++a) {
        const auto& points = face_ghosts_[static_cast<std::size_t>(a)].points();
        for (std::size_t i = 0; i < points.size(); ++i) {
            velocity.ref(a, points[i]) = slid[static_cast<std::size_t>(a)][i];
        }
    }
}

void SolidField::extrapolate(SparseField& scalar) const {
    center_ghosts_.extrapolate(scalar.values, nullptr);
    for (const Vec3i& c : center_ghosts_.deep()) scalar.values.ref(c) = 0;
    for (const Vec3i& c : center_ghosts_.points()) {
        auto& active = scalar.active[static_cast<std::size_t>(blocks_.find(c / blocks_.extent()))];
        if (!active && scalar.values.get(c) != 0) active = 1;
    }
}

double SolidField::sum_inside(const TileField<float>& scalar) const {
    double sum = 0;
    for (const auto* points : {&center_ghosts_.points(), &center_ghosts_.deep()}) {
        for (const Vec3i& c : *points) sum += scalar.get(c);
    }
    return sum;
}

void SolidField::clear_inside(TileField<float>& scalar) const {
    for (const auto* points : {&center_ghosts_.points(), &center_ghosts_.deep()}) {
        for (const Vec3i& c : *points) scalar.ref(c) = 0;
    }
}

}  // namespace gischt
