// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fluid/procedural/params.h"
#include "shape/mesh_distance.h"

namespace gischt {

// What a shape is at a point.
struct EnvelopeSample {
    double depth = 0;  // m below the surface, negative outside
    double hold = 1;   // share of a displacement that is possible here; 0 where the shape ends
    Vec3d drift;       // m/s with which the shape moves here
};

// The shape of a procedural fluid at one moment. Depths are distances for a ball, box, slab, mesh
// and single blob; where blobs melt together, the distance at which a lone one would have their
// field.
class Envelope {
  public:
    // `up` is a unit vector. A slab and the whole box end at the sides of the domain.
    // `mesh` is that of the shape of this name, else null; it must outlive the envelope.
    Envelope(const ProceduralParams& params, const MeshDistance* mesh, const Vec3d& up,
             double time);

    // The parts that matter within `radius` of a point where noise moves the surface by up to
    // `displacement`; empty where there is nothing.
    std::vector<int> parts_near(const Vec3d& center, double radius, double displacement) const;
    EnvelopeSample at(std::span<const int> parts, const Vec3d& p) const;
    // Metres above the base, along `up`.
    double height(const Vec3d& p) const { return dot(p - position_, up_); }

  private:
    double depth_of_solid(const Vec3d& p) const;
    double depth_in_mesh(std::span<const int> parts, const Vec3d& p) const;
    double cut_at_base(double depth, const Vec3d& p) const {
        return base_ ? std::min(depth, dot(p, up_) - *base_) : depth;
    }

    ProceduralShape shape_;
    BlobKernel kernel_;
    double blobbiness_;
    Box3d domain_;
    Vec3d up_, position_, drift_, half_size_;
    double radius_, thickness_;
    std::optional<double> base_;
    Blobs blobs_;
    const MeshDistance* mesh_;
};

}  // namespace gischt
