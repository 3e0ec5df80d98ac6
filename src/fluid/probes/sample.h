// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/probes/fit.h"
#include "fluid/smoke.h"

namespace gischt {

// One quantity of a solver's state on its lattice: cell centres, or faces along an axis.
class StateLattice {
  public:
    // Component `axis` of the velocity, m/s.
    static StateLattice velocity(const SmokeSolver& solver, int axis);
    static StateLattice density(const SmokeSolver& solver);      // 1
    static StateLattice temperature(const SmokeSolver& solver);  // K above the ambient
    static StateLattice pressure(const SmokeSolver& solver);     // Pa

    // At a point of the domain: linear between the lattice's points, continued linearly where the
    // domain ends half a cell further; beside solids fitted to the points in the fluid. Second
    // order.
    double at(const Vec3d& point) const;
    // Adds the points in the fluid within `reach` cells of a point, offsets in cells.
    void collect(const Vec3d& point, double reach, LocalFit& fit) const;
    double value(const Vec3i& index) const {
        return scale_ *
               static_cast<double>(axis_ < 0 ? cells_->get(index) : faces_->get(axis_, index));
    }

  private:
    StateLattice(const SmokeSolver& solver, int axis);
    bool is_fluid(const Vec3i& index) const;
    // The index around periodic axes; false where there is none.
    bool wrap(Vec3i& index) const;
    Vec3d place(const Vec3i& index) const;

    const SmokeSolver* solver_;
    int axis_;
    Vec3i count_;
    bool by_fraction_ = false;  // valid where any face is open, else where the point is outside
    double scale_ = 1;
    const TileField<float>* cells_ = nullptr;
    const FaceField* faces_ = nullptr;
};

struct SmokeSample {
    Vec3d velocity;          // m/s
    double pressure = 0;     // Pa
    double temperature = 0;  // K
    double density = 0;      // 1
};
// The state at a point of the domain; NaN in solids.
SmokeSample sample_smoke(const SmokeSolver& solver, const Vec3d& point);

}  // namespace gischt
