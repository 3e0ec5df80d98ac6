// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fluid/solid_field.h"

// What solids do to the quantities of the fluid at and beyond their surface.
namespace gischt {

void SolidField::extrapolate(FaceField& velocity) const {
    for (int a = 0; a < domain_.axes(); ++a) {
        const auto s = static_cast<std::size_t>(a);
        face_ghosts_[s].extrapolate(velocity[a], &velocity.last[s]);
        for (const Vec3i& f : face_ghosts_[s].deep()) {
            velocity.ref(a, f) = static_cast<float>(this->velocity(domain_.face_center(a, f))[a]);
        }
    }
    if (slip_ == SolidSlip::NoSlip) {
        stick(velocity);
    } else {
        slide(velocity);
    }
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
            const Vec3d& normal =
                face_normals_[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
            Vec3d v;
            for (int b = 0; b < domain_.axes(); ++b) v[b] = component_at(b, a, f);
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

void SolidField::stick(FaceField& velocity) const {
    for (int a = 0; a < domain_.axes(); ++a) {
        continue_through(
            no_slip_ghosts_[static_cast<std::size_t>(a)],
            domain_.faces_of(Box3i{{}, domain_.cells}, a).hi,
            [&](const Vec3i& f) { return velocity.get(a, f); },
            [&](const Vec3i& f, float value) { velocity.ref(a, f) = value; });
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

void SolidField::extrapolate_heat(SparseField& temperature) const {
    extrapolate(temperature);
    if (!holds_heat_) return;
    hold_heat(temperature);
    continue_through(
        heat_ghosts_, domain_.cells, [&](const Vec3i& c) { return temperature.values.get(c); },
        [&](const Vec3i& c, float value) { temperature.values.ref(c) = value; });
}

void SolidField::hold(FaceField& velocity) const {
    if (is_empty() || slip_ != SolidSlip::NoSlip) return;
    for (int a = 0; a < domain_.axes(); ++a) {
        const Ghosts& ghosts = face_ghosts_[static_cast<std::size_t>(a)];
        for (const auto* points : {&ghosts.points(), &ghosts.deep()}) {
            for (const Vec3i& f : *points) velocity.ref(a, f) = is_moving_ ? wall_.get(a, f) : 0;
        }
    }
}

void SolidField::hold_heat(SparseField& temperature) const {
    if (!holds_heat_) return;
    for (const auto* points : {&center_ghosts_.points(), &center_ghosts_.deep()}) {
        for (const Vec3i& c : *points) {
            if (heat_distance_.get(c) > 0) continue;
            const float value = heat_value_.get(c);
            temperature.values.ref(c) = value;
            if (value == 0) continue;
            const int block = blocks_.find(c / blocks_.extent());
            temperature.active[static_cast<std::size_t>(block)] = 1;
        }
    }
}

VelocitySolids SolidField::velocity_solids() const {
    if (is_empty()) return {};
    if (slip_ == SolidSlip::FreeSlip) return {&fraction_, nullptr, nullptr};
    return {&fraction_, &distance_, is_moving_ ? &wall_ : nullptr};
}

ScalarSolids SolidField::smoke_solids() const {
    return is_empty() ? ScalarSolids{} : ScalarSolids{&fraction_, nullptr, nullptr};
}

ScalarSolids SolidField::heat_solids() const {
    if (!holds_heat_) return smoke_solids();
    return {&heat_fraction_, &heat_distance_, &heat_value_};
}

double SolidField::top_temperature() const {
    double top = 0;
    for (const SolidParams& s : solids_) {
        if (s.temperature) top = std::max(top, std::abs(s.temperature->at(time_) - ambient_));
    }
    return top;
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
