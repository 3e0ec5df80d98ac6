// SPDX-License-Identifier: Apache-2.0
#include "fluid/probes/surface_force.h"

#include <cmath>

#include "fluid/probes/sample.h"

namespace gischt {
namespace {

// The piece of a solid's surface in a cell.
struct SurfacePiece {
    Vec3i cell;
    Vec3d area;    // vector out of the solid, m^2 (2-D: m)
    Vec3d point;   // on the surface, nearest to the cell's centre
    Vec3d normal;  // out of the solid
};

class ForceOnSolid {
  public:
    ForceOnSolid(const SmokeSolver& solver, std::size_t solid)
        : solver_(solver),
          solid_(solver.world().solids.at(solid)),
          shape_(solid_.shape_at(solver.state().time)),
          center_(solid_.position.at(solver.state().time)),
          pressure_(StateLattice::pressure(solver)) {
        for (int a = 0; a < solver.domain().axes(); ++a) {
            velocity_.push_back(StateLattice::velocity(solver, a));
        }
    }

    SolidForce in_block(int block, bool viscous) const {
        SolidForce sum;
        for_cells(solver_.blocks().cells(block), [&](const Vec3i& c) {
            SurfacePiece piece;
            if (!find_piece(c, piece)) return;
            const Vec3d push = -pressure_.value(c) * piece.area;
            const Vec3d drag = viscous ? length(piece.area) * traction(piece) : Vec3d{};
            sum.pressure += push;
            sum.viscous += drag;
            Vec3d arm = piece.point - center_;
            if (solver_.domain().is_2d()) arm.z = 0;
            sum.torque += cross(arm, push + drag);
        });
        return sum;
    }

  private:
    bool find_piece(const Vec3i& c, SurfacePiece& piece) const {
        const Domain& d = solver_.domain();
        const FaceField& fraction = solver_.solids().fraction();
        const double face = d.is_2d() ? d.h : d.h * d.h;
        piece.cell = c;
        for (int a = 0; a < d.axes(); ++a) {
            Vec3i next = c;
            next[a] += 1;
            piece.area[a] = face * (static_cast<double>(fraction.get(a, next)) -
                                    static_cast<double>(fraction.get(a, c)));
        }
        if (piece.area == Vec3d{}) return false;
        // Of several solids the nearest has the piece.
        const Vec3d center = d.center_of(c);
        const double own = signed_distance(shape_, center);
        if (own > solver_.solids().signed_distance(center) + 1e-6 * d.h) return false;
        piece.normal = normal_at(center);
        piece.point = center - own * piece.normal;
        return true;
    }

    Vec3d normal_at(const Vec3d& point) const {
        const Domain& d = solver_.domain();
        Vec3d gradient;
        for (int a = 0; a < d.axes(); ++a) {
            Vec3d step;
            step[a] = 0.01 * d.h;  // short against curvature, long against rounding
            gradient[a] =
                signed_distance(shape_, point + step) - signed_distance(shape_, point - step);
        }
        const double size = length(gradient);
        return size > 0 ? gradient / size : Vec3d{};
    }

    // N/m^2 on the solid.
    Vec3d traction(const SurfacePiece& piece) const {
        constexpr double reach = 2.5;  // cells: on one side of a surface enough for a quadratic
        const Domain& d = solver_.domain();
        const Vec3d wall = solid_.velocity_at(solver_.state().time, piece.point);
        std::array<Vec3d, 3> gradient{};
        for (int a = 0; a < d.axes(); ++a) {
            LocalFit fit(d.axes());
            fit.fix(wall[a]);
            velocity_[static_cast<std::size_t>(a)].collect(piece.point, reach, fit);
            gradient[static_cast<std::size_t>(a)] = fit.solve().gradient / d.h;
        }
        const double mu = solver_.params().reference_density * solver_.params().viscosity;
        Vec3d t;
        for (int a = 0; a < d.axes(); ++a) {
            for (int b = 0; b < d.axes(); ++b) {
                t[a] += mu *
                        (gradient[static_cast<std::size_t>(a)][b] +
                         gradient[static_cast<std::size_t>(b)][a]) *
                        piece.normal[b];
            }
        }
        return t;
    }

    const SmokeSolver& solver_;
    const SolidParams& solid_;
    Shape shape_;
    Vec3d center_;
    StateLattice pressure_;
    std::vector<StateLattice> velocity_;
};

}  // namespace

SolidForce measure_solid_force(const SmokeSolver& solver, std::size_t solid, bool viscous) {
    if (solid >= solver.world().solids.size()) {
        throw Error(ErrorKind::Usage, "probe", "there is no such solid to measure a force on");
    }
    const ForceOnSolid force(solver, solid);
    const bool has_friction = viscous && solver.params().viscosity > 0;
    std::vector<SolidForce> parts(static_cast<std::size_t>(solver.blocks().size()));
    parallel_for(solver.blocks().size(), 1, [&](int block) {
        if (!solver.solids().is_cut(block)) return;
        parts[static_cast<std::size_t>(block)] = force.in_block(block, has_friction);
    });
    SolidForce sum;
    for (const SolidForce& p : parts) {
        sum.pressure += p.pressure;
        sum.viscous += p.viscous;
        sum.torque += p.torque;
    }
    return sum;
}

}  // namespace gischt
