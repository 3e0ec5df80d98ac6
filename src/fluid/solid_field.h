// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fluid/advect.h"
#include "fluid/ghosts.h"
#include "fluid/solid.h"

namespace gischt {

// All solids of a domain at one moment, as the fluid sees them.
class SolidField {
  public:
    // Domain and blocks must outlive it. Throws as check_solid() does.
    SolidField(const Domain& domain, const BlockMap& blocks, std::vector<SolidParams> solids);

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

    // Continues the fluid into the solids, as far as advection may look, and gives the normal
    // component there the solid's (free slip). Deeper faces take the solid's velocity.
    void extrapolate(FaceField& velocity) const;
    // The same for a scalar at cell centres, so that none is drawn out of a solid; zero deeper in.
    void extrapolate(SparseField& scalar) const;
    // Sum over the cells whose centre is in a solid.
    double sum_inside(const TileField<float>& scalar) const;
    // Sets a scalar to zero in cells whose centre is in a solid.
    void clear_inside(TileField<float>& scalar) const;

  private:
    void cut_block(int block);
    void cut_faces(int block, int axis, const std::vector<float>& distance, const Lattice& nodes);
    Vec3d node(const Vec3i& corner) const;
    Box3i reach_of_solids() const;
    void slide(FaceField& velocity) const;

    const Domain& domain_;
    const BlockMap& blocks_;
    std::vector<SolidParams> solids_;
    bool is_moving_ = false;
    std::vector<Shape> shapes_;
    double time_ = 0;
    FaceField fraction_;
    std::vector<std::uint8_t> cut_;
    Ghosts center_ghosts_;
    std::array<Ghosts, 3> face_ghosts_;
};

// The part of a square outside a solid, from signed distances at its corners in the order of a
// walk around it, linear along the edges: exact for a plane (Batty, Bertails, Bridson 2007).
float open_fraction(float a, float b, float c, float d);

}  // namespace gischt
