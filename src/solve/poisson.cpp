// SPDX-License-Identifier: Apache-2.0
#include "solve/poisson.h"

#include "solve/stencil_solver.h"

namespace gischt {
namespace {

StencilSpec specify(TileMap::Ptr map, const Sides& sides, const FaceField* fraction) {
    if (!map->is_box()) {
        throw Error(ErrorKind::Usage, "solve", "the cells do not form a box",
                    "solve on a map made by TileMap::box");
    }
    StencilSpec spec;
    spec.fraction = fraction;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        switch (sides[s]) {
            case Side::Wall:
                spec.sides[s].kind = SideRule::Kind::Closed;
                break;
            case Side::Open:
                spec.sides[s].kind = SideRule::Kind::Fixed;
                break;
            case Side::Periodic:
                spec.sides[s].kind = SideRule::Kind::Periodic;
                break;
        }
    }
    spec.map = std::move(map);
    return spec;
}

}  // namespace

struct PoissonSolver::Impl {
    StencilSolver solver;
};

PoissonSolver::PoissonSolver(TileMap::Ptr map, const Sides& sides, const FaceField* fraction)
    : impl_(new Impl{StencilSolver(specify(std::move(map), sides, fraction))}) {}

PoissonSolver::~PoissonSolver() = default;
PoissonSolver::PoissonSolver(PoissonSolver&&) noexcept = default;
PoissonSolver& PoissonSolver::operator=(PoissonSolver&&) noexcept = default;

SolveResult PoissonSolver::solve(const TileField<float>& b, TileField<float>& x, double tolerance,
                                 int max_iterations, Job& job) {
    return impl_->solver.solve(b, x, tolerance, max_iterations, job);
}

double PoissonSolver::bytes_per_cell_iteration() const {
    return impl_->solver.bytes_per_cell_iteration();
}

}  // namespace gischt
