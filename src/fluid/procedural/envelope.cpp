// SPDX-License-Identifier: Apache-2.0
#include "fluid/procedural/envelope.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "math/box.h"

namespace gischt {

static std::vector<BlobParams> blobs_of(const ProceduralParams& params) {
    return params.shape == ProceduralShape::Blobs ? params.blobs : std::vector<BlobParams>();
}

Envelope::Envelope(const ProceduralParams& params, const MeshDistance* mesh, const Vec3d& up,
                   double time)
    : shape_(params.shape),
      kernel_(params.kernel),
      blobbiness_(params.blobbiness),
      domain_{params.min, params.max},
      up_(up),
      position_(params.position.at(time)),
      drift_(params.position.rate(time)),
      half_size_(0.5 * params.size.at(time)),
      radius_(params.radius.at(time)),
      thickness_(params.thickness.at(time)),
      base_(params.base),
      blobs_(blobs_of(params), params.kernel, params.blobbiness, time),
      mesh_(mesh) {
    GISCHT_ASSERT(mesh_ || shape_ != ProceduralShape::Mesh);
}

// Below the nearest face of a box; outside minus the distance to it.
static double depth_in_box(const Vec3d& from_center, const Vec3d& half_size) {
    const Vec3d inside = half_size - abs(from_center);
    const Vec3d outside = max(-inside, Vec3d());
    return std::min(min_component(inside), 0.0) < 0 ? -length(outside) : min_component(inside);
}

double Envelope::depth_of_solid(const Vec3d& p) const {
    const Vec3d from_center = p - 0.5 * (domain_.lo + domain_.hi);
    const Vec3d half_domain = 0.5 * (domain_.hi - domain_.lo);
    switch (shape_) {
        case ProceduralShape::All:
            return depth_in_box(from_center, half_domain);
        case ProceduralShape::Ball:
            return radius_ - length(p - position_);
        case ProceduralShape::Box:
            return depth_in_box(p - position_, half_size_);
        case ProceduralShape::Slab: {
            double depth = std::min(height(p), thickness_ - height(p));
            for (int a = 0; a < 3; ++a) {
                if (std::abs(up_[a]) < 0.5)
                    depth = std::min(depth, half_domain[a] - std::abs(from_center[a]));
            }
            return depth;
        }
        case ProceduralShape::Mesh:
            return depth_in_mesh({}, p);
        case ProceduralShape::Blobs:
            break;
    }
    return -std::numeric_limits<double>::infinity();
}

// What parts_near() says of a mesh: a region is on one side of it, or it may be on both.
enum MeshSide { OnBothSides, AllInside, AllOutside };

double Envelope::depth_in_mesh(std::span<const int> parts, const Vec3d& p) const {
    const Vec3d q = p - position_;
    const int side = parts.empty() ? OnBothSides : parts[0];
    const bool is_inside = side == OnBothSides ? mesh_->is_inside(q) : side == AllInside;
    return is_inside ? mesh_->distance(q) : -mesh_->distance(q);
}

std::vector<int> Envelope::parts_near(const Vec3d& center, double radius,
                                      double displacement) const {
    if (shape_ == ProceduralShape::Blobs) return blobs_.near(center - position_, radius);
    // Depths change by no more than the way.
    const double depth = depth_of_solid(center);
    if (cut_at_base(depth, center) + radius + displacement <= 0) return {};
    const bool is_on_one_side = shape_ == ProceduralShape::Mesh && std::abs(depth) > radius;
    return {!is_on_one_side ? OnBothSides : depth > 0 ? AllInside : AllOutside};
}

EnvelopeSample Envelope::at(std::span<const int> parts, const Vec3d& p) const {
    if (shape_ == ProceduralShape::Mesh)
        return {cut_at_base(depth_in_mesh(parts, p), p), 1, drift_};
    if (shape_ != ProceduralShape::Blobs) return {cut_at_base(depth_of_solid(p), p), 1, drift_};
    const BlobSample blob = blobs_.at(parts, p - position_);
    if (blob.field <= 0) return {-std::numeric_limits<double>::infinity(), 0, {}};
    const double depth = blob.radius * (1 - blob_distance(kernel_, blob.field, blobbiness_));
    // Noise cannot make a fluid where no field is; on the surface it acts in full.
    return {cut_at_base(depth, p), smoothstep(blob.field / (0.5 * blob_surface)),
            drift_ + blob.drift};
}

}  // namespace gischt
