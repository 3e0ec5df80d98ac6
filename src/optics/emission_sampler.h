// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "optics/medium.h"

namespace gischt {

// A point of a glowing medium, drawn for a receiver.
struct EmissionSample {
    Vec3d point;     // metres
    float pdf = 0;   // 1/m^3, of drawing the point in this medium; 0: nothing was drawn
    int medium = 0;  // index among the media that the sampler was made of
};

// Draws points of glowing media, so that they can be sampled as lights: where more is emitted, and
// nearer to the receiver, more often. Blocks of 4^3 voxels are the leaves of a tree; on the way
// down a child is taken in proportion to its power over the squared distance of its centre, which
// is not taken smaller than its size (Conty Estevez & Kulla 2018, "Importance sampling of many
// lights with adaptive tree splitting"); in the block the point is drawn evenly. A homogeneous
// medium is one leaf. Every point that emits can be drawn, those without density too.
//
// A single point of a volume as a light has the variance of 1/distance^2 next to it. A line through
// all of the volume in the direction of the point has not (Simon et al. 2017, "Line integration for
// rendering heterogeneous emissive volumes"): gather the emission along it and divide by
// direction_pdf().
class EmissionSampler {
  public:
    EmissionSampler() = default;
    // The media must outlive it. Looks at 64 points of every block that glows.
    explicit EmissionSampler(std::span<const std::shared_ptr<const Medium>> media);

    // Nothing glows.
    bool is_empty() const { return nodes_.empty(); }
    // Estimate of the integral of the emission's luminance over all volume, W/sr.
    double power() const { return is_empty() ? 0 : static_cast<double>(nodes_[0].power); }

    // `choice` finds the block, `place` the point in it; all in [0,1).
    EmissionSample sample(const Vec3d& receiver, float choice, const Vec3f& place) const;
    // The pdf with which sample() draws a point, 1/m^3; 0 where nothing glows.
    float pdf(const Vec3d& receiver, int medium, const Vec3d& point) const;
    // The density in 1/sr with which the direction from a receiver (the ray's origin) to a drawn
    // point is the ray's, which is of unit length: the integral of pdf t^2 over [t_min, t_max],
    // exact.
    float direction_pdf(const Ray& ray) const;

    // For tests: the leaf a point lies in, or -1, their number, and the probability of one.
    int leaf_of(int medium, const Vec3d& point) const;
    int leaf_count() const { return static_cast<int>(leaves_.size()); }
    double probability(const Vec3d& receiver, int leaf) const;

  private:
    class Descent;
    // In depth-first order: the left child follows its parent.
    struct Node {
        Vec3f center;       // metres from origin_
        float radius2 = 0;  // square of half the diagonal
        float power = 0;
        int right = 0;  // index of the right child; of a leaf: -1 - its index
    };
    struct Leaf {
        int medium = 0, brick = -1, block = 0;  // brick -1: the whole of a homogeneous medium
        float power = 0;
        Vec3d center;
        int node = 0;
    };
    struct Body {
        const Medium* medium = nullptr;
        double density = 0;                // 1/m^3 within a leaf: one over its volume
        Vec3d edge;                        // metres: half the diagonal of a leaf as a box
        std::vector<std::int32_t> leaves;  // by 8 brick + block; of a homogeneous medium one
    };

    void add_bricks(int index);
    void add_region(int index);
    void build(std::span<int> order);
    float share_of_left(int node, const Vec3f& receiver) const;
    int leaf_at(const Body& body, int brick, const Vec3f& local) const;

    std::vector<Body> bodies_;
    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
    Vec3d origin_;
};

}  // namespace gischt
