// SPDX-License-Identifier: Apache-2.0
#include "fluid/solid_field.h"

#include <algorithm>
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
                       std::vector<SolidParams> solids, SolidSlip slip, double ambient)
    : domain_(domain), blocks_(blocks), solids_(std::move(solids)), slip_(slip), ambient_(ambient) {
    for (const SolidParams& s : solids_) {
        check_solid(s);
        is_moving_ |= s.is_moving();
        holds_heat_ |= s.temperature.has_value();
        has_keyed_heat_ |= s.temperature && !s.temperature->is_constant();
    }
    if (!solids_.empty()) update(0);
}

bool SolidField::update(double time) {
    const bool is_first = shapes_.empty(), is_new = time != time_;
    if (solids_.empty() || (!is_first && !is_new)) return false;
    time_ = time;
    if (!is_first && !is_moving_) {
        if (has_keyed_heat_) update_heat();
        return false;
    }
    shapes_.clear();
    for (const SolidParams& s : solids_) shapes_.emplace_back(s, time);
    fraction_ = FaceField(domain_.map, 1.0f);
    cut_.assign(static_cast<std::size_t>(blocks_.size()), 0);
    parallel_for(blocks_.size(), 1, [&](int block) { cut_block(block); });

    const auto is_covered = [&](const Vec3i& c) {
        if (!is_cut(blocks_.find(c / blocks_.extent()))) return false;
        const Vec3d p = domain_.center_of(c);
        return std::ranges::any_of(shapes_, [&](const PlacedSolid& s) { return s.is_inside(p); });
    };
    center_ghosts_.find(*domain_.map, -1, reach_of_solids(), ghost_layers, is_covered);
    find_faces();
    if (holds_heat_) update_heat();
    return true;
}

void SolidField::find_faces() {
    const bool sticks = slip_ == SolidSlip::NoSlip;
    if (sticks) {
        // Far from all solids any positive distance does.
        distance_ = FaceField(domain_.map, std::numeric_limits<float>::max());
        if (is_moving_) wall_ = FaceField(domain_.map, 0.0f);
        parallel_for(blocks_.size(), 1, [&](int block) { measure_block(block); });
    }
    const Box3i cells = reach_of_solids();
    for (int a = 0; a < domain_.axes(); ++a) {
        const auto s = static_cast<std::size_t>(a);
        const Box3i faces = cells.is_empty() ? cells : domain_.faces_of(cells, a);
        const FaceField& open = sticks ? distance_ : fraction_;
        face_ghosts_[s].find(*domain_.map, a, faces, ghost_layers,
                             [&](const Vec3i& f) { return open.get(a, f) <= 0; });
        if (sticks) {
            find_no_slip_ghosts(a);
        } else {
            find_normals(a);
        }
    }
}

double SolidField::signed_distance(const Vec3d& point) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlacedSolid& s : shapes_) nearest = std::min(nearest, s.signed_distance(point));
    return nearest;
}

// Index of the nearest solid, of those that hold a temperature only when asked to; -1 for none.
int SolidField::nearest(const Vec3d& point, bool held_only) const {
    int found = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        if (held_only && !solids_[s].temperature) continue;
        const double distance = shapes_[s].signed_distance(point);
        if (distance < least) {
            least = distance;
            found = static_cast<int>(s);
        }
    }
    return found;
}

Vec3d SolidField::velocity(const Vec3d& point) const {
    if (!is_moving_) return {};
    const int s = shapes_.size() == 1 ? 0 : nearest(point, false);
    return s < 0 ? Vec3d{} : solids_[static_cast<std::size_t>(s)].velocity_at(time_, point);
}

double SolidField::top_speed() const {
    if (!is_moving_) return 0;
    // A velocity of rigid motion is largest at a corner of the part of the domain that is covered.
    const Vec3d lo = domain_.origin, hi = lo + domain_.h * Vec3d(domain_.cells);
    double top = 0;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        const Box3d box = shapes_[s].bounds(), part = intersection(box, Box3d{lo, hi});
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
    for (const PlacedSolid& s : shapes_) {
        const Box3d box = s.bounds();
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

}  // namespace gischt
