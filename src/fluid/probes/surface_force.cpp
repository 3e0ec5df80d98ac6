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
    Vec3d middle;  // of the piece
    Vec3d point;   // on the surface beside it
    Vec3d normal;  // out of the solid
};

class ForceOnSolid {
  public:
    ForceOnSolid(const SmokeSolver& solver, std::size_t solid)
        : solver_(solver),
          solid_(solver.world().solids.at(solid)),
          shape_(solid_, solver.state().time),
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
            const Vec3d push = -pressure_on(piece) * piece.area;
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
        piece.cell = c;
        return solver_.domain().is_2d() ? find_chord(piece) : find_facet(piece);
    }

    // 2-D: the chord between the places where the distance, linear along the edges of the cell,
    // changes its sign.
    bool find_chord(SurfacePiece& piece) const {
        const Domain& d = solver_.domain();
        const Vec3d center = d.center_of(piece.cell);
        if (std::abs(shape_.signed_distance(center)) > d.h) return false;
        std::array<Vec3d, 4> corner;
        std::array<double, 4> phi{};
        for (std::size_t i = 0; i < 4; ++i) {
            const bool right = i == 1 || i == 2, top = i >= 2;
            corner[i] = center + 0.5 * d.h * Vec3d(right ? 1 : -1, top ? 1 : -1, 0);
            phi[i] = shape_.signed_distance(corner[i]);
        }
        std::array<Vec3d, 4> end;
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t j = (i + 1) % 4;
            if ((phi[i] > 0) == (phi[j] > 0)) continue;
            end[count++] = corner[i] + phi[i] / (phi[i] - phi[j]) * (corner[j] - corner[i]);
        }
        if (count != 2) return false;
        const Vec3d chord = end[1] - end[0];
        piece.middle = 0.5 * (end[0] + end[1]);
        const double own = shape_.signed_distance(piece.middle);
        if (own > solver_.solids().signed_distance(piece.middle) + 1e-6 * d.h) return false;
        piece.normal = normal_at(piece.middle);
        piece.point = piece.middle - own * piece.normal;
        piece.area = Vec3d(chord.y, -chord.x, 0);
        if (dot(piece.area, piece.normal) < 0) piece.area = -piece.area;
        return true;
    }

    // 3-D: by the open parts of the faces.
    bool find_facet(SurfacePiece& piece) const {
        const Domain& d = solver_.domain();
        const FaceField& fraction = solver_.solids().fraction();
        const Vec3i& c = piece.cell;
        for (int a = 0; a < 3; ++a) {
            Vec3i next = c;
            next[a] += 1;
            piece.area[a] = d.h * d.h *
                            (static_cast<double>(fraction.get(a, next)) -
                             static_cast<double>(fraction.get(a, c)));
        }
        if (piece.area == Vec3d{}) return false;
        // Of several solids the nearest has the piece.
        const Vec3d center = d.center_of(c);
        const double own = shape_.signed_distance(center);
        if (own > solver_.solids().signed_distance(center) + 1e-6 * d.h) return false;
        piece.normal = normal_at(center);
        piece.middle = piece.point = center - own * piece.normal;
        return true;
    }

    // Pa. The cell's own in 3-D, whose sum with the facets is second order as it is; on a circle it
    // would converge with order 3/2 only, for what happens where the grid touches it.
    double pressure_on(const SurfacePiece& piece) const {
        if (!solver_.domain().is_2d()) return pressure_.value(piece.cell);
        constexpr double reach = 3;  // cells
        LocalFit fit(2);
        pressure_.collect(piece.middle, reach, fit);
        return fit.solve().value;
    }

    Vec3d normal_at(const Vec3d& point) const {
        const Domain& d = solver_.domain();
        Vec3d gradient;
        for (int a = 0; a < d.axes(); ++a) {
            Vec3d step;
            step[a] = 0.01 * d.h;  // short against curvature, long against rounding
            gradient[a] =
                shape_.signed_distance(point + step) - shape_.signed_distance(point - step);
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
    PlacedSolid shape_;
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
    // What slips along a solid does not pull it.
    const bool has_friction =
        viscous && solver.params().viscosity > 0 && solver.params().solid_slip == SolidSlip::NoSlip;
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
