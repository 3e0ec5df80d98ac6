// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "math/keyframes.h"
#include "schema/table.h"

namespace gischt {

// How the field of a blob falls with the distance from its middle.
enum class BlobKernel {
    Wyvill,    // polynomial of sixth degree (Wyvill, McPheeters, Wyvill 1986)
    Blinn,     // Gaussian (Blinn 1982)
    Metaball,  // piecewise quadratic (Nishimura et al. 1985)
    Murakami,  // polynomial of fourth degree (Murakami, Ichihara 1987)
};
enum class BlobCurve { Polyline, CatmullRom };

// A ball of a radius around a point, or a hose around a curve.
struct BlobParams {
    Keyed<Vec3d> position;        // m
    Keyed<double> radius = 0.25;  // m, of the surface where no other blob is near
    std::vector<Vec3d> points;    // m from `position`: the skeleton; none: the position itself
    std::vector<double> radii;    // share of `radius` at each point; none: 1
    BlobCurve curve = BlobCurve::CatmullRom;
};
const Table<BlobParams>& blob_table();

// Fields are scaled such that the surface is where their sum is this.
inline constexpr double blob_surface = 0.5;

// The field of one blob at a distance of `rho` of its radii: 1 in the middle (Blinn: exp(b) / 2, b
// being the `blobbiness`), 1/2 at rho = 1, 0 from blob_support() on, falling all the way.
double blob_field(BlobKernel kernel, double rho, double blobbiness);
// Radii to which the field reaches. A Gaussian ends where it is 2^-21, below what a float adds to
// the surface's value.
double blob_support(BlobKernel kernel, double blobbiness);
// The rho at which one blob has this field; 0 for more than it has in the middle.
double blob_distance(BlobKernel kernel, double field, double blobbiness);

// What all blobs together are at a point.
struct BlobSample {
    double field = 0;   // sum over blobs
    double radius = 0;  // m, mean of the blobs that are here
    Vec3d drift;        // m/s, mean of their motions
};

// Blobs at one moment. A curve is taken as straight pieces; its field is that of the nearest place
// on it, in units of the radius there, so that a curve does not bulge where pieces meet.
class Blobs {
  public:
    Blobs() = default;
    // Throws Error{Usage} on a radius that is not positive.
    Blobs(const std::vector<BlobParams>& blobs, BlobKernel kernel, double blobbiness, double time);

    // Pieces that may matter within `reach` of a point, in order.
    std::vector<int> near(const Vec3d& center, double reach) const;
    // Sums over the given pieces.
    BlobSample at(std::span<const int> pieces, const Vec3d& p) const;

  private:
    struct Piece {
        Vec3d a, b;
        double radius_a, radius_b;
        int blob;
        Vec3d drift;
    };
    std::vector<Piece> pieces_;
    BlobKernel kernel_ = BlobKernel::Wyvill;
    double blobbiness_ = 1, support_ = 0;
};

}  // namespace gischt
