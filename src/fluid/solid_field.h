// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fluid/advect.h"
#include "fluid/ghosts.h"
#include "fluid/solid.h"
#include "fluid/surface_ghosts.h"
#include "solve/diffusion.h"

namespace gischt {

// All solids of a domain at one moment, as the fluid sees them.
class SolidField {
  public:
    // Domain and blocks must outlive it; `ambient` temperature in K. Throws as check_solid() does.
    SolidField(const Domain& domain, const BlockMap& blocks, std::vector<SolidParams> solids,
               SolidSlip slip = SolidSlip::FreeSlip, double ambient = 0);

    bool is_empty() const { return solids_.empty(); }
    bool is_moving() const { return is_moving_; }
    // Evaluates the solids at a time in seconds. True when they are not where they were.
    bool update(double time);

    // The part of each face that is not covered, in [0,1]; exact for planes. Below 1 % counts as
    // closed: such faces carry nothing and spoil the conditioning.
    const FaceField& fraction() const { return fraction_; }
    // Whether any face of the block's cells is (partly) covered.
    bool is_cut(int block) const {
        return !cut_.empty() && cut_[static_cast<std::size_t>(block)] != 0;
    }
    // Distance to the nearest solid, negative inside, m; infinite without solids.
    double signed_distance(const Vec3d& point) const;
    // Velocity of the nearest solid's material, m/s.
    Vec3d velocity(const Vec3d& point) const;
    // Largest speed of any solid's material in the domain, m/s.
    double top_speed() const;

    // Continues the fluid into the solids, as far as advection may look. Free slip: gives the
    // component normal to the surface the solid's. No slip: linear through the surface, where the
    // fluid has the solid's velocity. Deeper faces take the solid's velocity.
    void extrapolate(FaceField& velocity) const;
    // The same for a scalar at cell centres, so that none is drawn out of a solid; zero deeper in.
    void extrapolate(SparseField& scalar) const;
    // And for T - T_ambient, linear through surfaces that hold a temperature.
    void extrapolate_heat(SparseField& temperature) const;

    // What diffusion needs to know of the solids; smoke does not pass them. Valid until update().
    VelocitySolids velocity_solids() const;
    ScalarSolids smoke_solids() const;
    ScalarSolids heat_solids() const;
    // Before diffusion: gives faces in no-slip solids the solid's velocity, and cells in solids
    // that hold a temperature that.
    void hold(FaceField& velocity) const;
    void hold_heat(SparseField& temperature) const;
    // Largest |T - T_ambient| of a solid's surface, K.
    double top_temperature() const;

    // Sum over the cells whose centre is in a solid.
    double sum_inside(const TileField<float>& scalar) const;
    // Sets a scalar to zero in cells whose centre is in a solid.
    void clear_inside(TileField<float>& scalar) const;

  private:
    void cut_block(int block);
    void cut_faces(int block, int axis, const std::vector<float>& distance, const Lattice& nodes);
    Vec3d node(const Vec3i& corner) const;
    Box3i reach_of_solids() const;
    void find_faces();
    void find_normals(int axis);
    void find_no_slip_ghosts(int axis);
    void measure_block(int block);
    void update_heat();
    void measure_heat(int block);
    int nearest(const Vec3d& point, bool held_only) const;
    Vec3d gradient(const Vec3d& point) const;
    void slide(FaceField& velocity) const;
    void stick(FaceField& velocity) const;

    const Domain& domain_;
    const BlockMap& blocks_;
    std::vector<SolidParams> solids_;
    SolidSlip slip_;
    double ambient_;
    bool is_moving_ = false, holds_heat_ = false, has_keyed_heat_ = false;
    std::vector<PlacedSolid> shapes_;
    double time_ = 0;
    FaceField fraction_;
    std::vector<std::uint8_t> cut_;
    Ghosts center_ghosts_;
    std::array<Ghosts, 3> face_ghosts_;
    std::array<std::vector<Vec3d>, 3> face_normals_;  // of free-slip ghosts, of any length
    // No slip: signed distances at faces near solids, m, and the solids' velocity there when they
    // move.
    FaceField distance_, wall_;
    std::array<std::vector<SurfaceGhost>, 3> no_slip_ghosts_;
    // Solids that hold a temperature: distances to them at cells, m, what they hold, K, and the
    // fractions that the others leave open.
    TileField<float> heat_distance_, heat_value_;
    FaceField heat_fraction_;
    std::vector<SurfaceGhost> heat_ghosts_;
};

// The part of a square outside a solid, from signed distances at its corners in the order of a
// walk around it, linear along the edges: exact for a plane (Batty, Bertails, Bridson 2007).
float open_fraction(float a, float b, float c, float d);

}  // namespace gischt
