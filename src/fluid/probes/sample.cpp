// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/sample.h"

#include <cmath>
#include <limits>

namespace gischt {

StateLattice::StateLattice(const SmokeSolver& solver, int axis)
    : solver_(&solver), axis_(axis), count_(solver.domain().cells) {
    if (axis >= 0 && !solver.domain().is_periodic(axis)) count_[axis] += 1;
}

StateLattice StateLattice::velocity(const SmokeSolver& solver, int axis) {
    StateLattice l(solver, axis);
    l.faces_ = &solver.state().velocity;
    return l;
}

StateLattice StateLattice::density(const SmokeSolver& solver) {
    StateLattice l(solver, -1);
    l.cells_ = &solver.state().density.values;
    return l;
}

StateLattice StateLattice::temperature(const SmokeSolver& solver) {
    StateLattice l(solver, -1);
    l.cells_ = &solver.state().temperature.values;
    return l;
}

StateLattice StateLattice::pressure(const SmokeSolver& solver) {
    StateLattice l(solver, -1);
    const SmokeState& s = solver.state();
    l.cells_ = &s.potential;
    l.scale_ = s.potential_dt > 0
                   ? solver.params().reference_density * solver.domain().h / s.potential_dt
                   : 0.0;
    l.by_fraction_ = true;
    return l;
}

bool StateLattice::wrap(Vec3i& index) const {
    const Domain& d = solver_->domain();
    for (int a = 0; a < 3; ++a) {
        if (a < d.axes() && d.is_periodic(a)) {
            index[a] = ((index[a] % count_[a]) + count_[a]) % count_[a];
        } else if (index[a] < 0 || index[a] >= count_[a]) {
            return false;
        }
    }
    return true;
}

Vec3d StateLattice::place(const Vec3i& index) const {
    const Domain& d = solver_->domain();
    return axis_ < 0 ? d.center_of(index) : d.face_center(axis_, index);
}

bool StateLattice::is_fluid(const Vec3i& index) const {
    const SolidField& solids = solver_->solids();
    if (solids.is_empty()) return true;
    if (!by_fraction_) return solids.signed_distance(place(index)) > 0;
    // A cell whose centre is covered has a pressure as long as one of its faces is open.
    for (int a = 0; a < solver_->domain().axes(); ++a) {
        Vec3i next = index;
        next[a] += 1;
        if (solids.fraction().get(a, index) > 0 || solids.fraction().get(a, next) > 0) return true;
    }
    return false;
}

double StateLattice::at(const Vec3d& point) const {
    const Domain& d = solver_->domain();
    const Vec3d q = (point - place({})) / d.h;
    Vec3i first;
    Vec3d t;
    for (int a = 0; a < d.axes(); ++a) {
        first[a] = static_cast<int>(std::floor(q[a]));
        if (!d.is_periodic(a)) first[a] = std::clamp(first[a], 0, std::max(count_[a] - 2, 0));
        t[a] = count_[a] > 1 ? q[a] - first[a] : 0.0;
    }
    double sum = 0;
    bool all_fluid = true;
    for (int corner = 0; corner < (d.is_2d() ? 4 : 8) && all_fluid; ++corner) {
        Vec3i index = first;
        double weight = 1;
        for (int a = 0; a < d.axes(); ++a) {
            const bool upper = (corner >> a & 1) != 0;
            index[a] += upper;
            weight *= upper ? t[a] : 1 - t[a];
        }
        if (weight == 0) continue;
        wrap(index);
        all_fluid = is_fluid(index);
        if (all_fluid) sum += weight * value(index);
    }
    if (all_fluid) return sum;
    constexpr double reach = 2.5;  // cells: enough points on one side of a surface
    LocalFit fit(d.axes());
    collect(point, reach, fit);
    return fit.solve(1).value;
}

void StateLattice::collect(const Vec3d& point, double reach, LocalFit& fit) const {
    const Domain& d = solver_->domain();
    const Vec3d q = (point - place({})) / d.h;
    Box3i box;
    for (int a = 0; a < 3; ++a) {
        const bool flat = a >= d.axes();
        box.lo[a] = flat ? 0 : static_cast<int>(std::ceil(q[a] - reach));
        box.hi[a] = flat ? 1 : static_cast<int>(std::floor(q[a] + reach)) + 1;
    }
    for_cells(box, [&](const Vec3i& unwrapped) {
        Vec3d offset = Vec3d(unwrapped) - q;
        if (d.is_2d()) offset.z = 0;
        const double square = dot(offset, offset);
        Vec3i index = unwrapped;
        if (square > reach * reach || !wrap(index) || !is_fluid(index)) return;
        fit.add(offset, value(index), std::exp(-2 * square / (reach * reach)));
    });
}

SmokeSample sample_smoke(const SmokeSolver& solver, const Vec3d& point) {
    SmokeSample s;
    // A point on a surface may lie a rounding inside.
    if (solver.solids().signed_distance(point) < -1e-6 * solver.domain().h) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        return {Vec3d(none), none, none, none};
    }
    for (int a = 0; a < solver.domain().axes(); ++a) {
        s.velocity[a] = StateLattice::velocity(solver, a).at(point);
    }
    s.pressure = StateLattice::pressure(solver).at(point);
    s.temperature =
        solver.params().ambient_temperature + StateLattice::temperature(solver).at(point);
    s.density = StateLattice::density(solver).at(point);
    return s;
}

}  // namespace gischt
