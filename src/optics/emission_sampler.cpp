// SPDX-License-Identifier: Apache-2.0
#include "optics/emission_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/units.h"
#include "image/color.h"

namespace gischt {
namespace {

constexpr int block_edge = BrickVolume::brick_edge / 2;

Vec3i block_offset(int block) {
    return block_edge * Vec3i(block & 1, block >> 1 & 1, block >> 2);
}

// An even point of the unit ball.
Vec3d in_ball(const Vec3f& u) {
    const double r = std::cbrt(static_cast<double>(u.x)), z = 2 * static_cast<double>(u.y) - 1;
    const double turn = 2 * pi * static_cast<double>(u.z), sine = std::sqrt(1 - z * z);
    return r * Vec3d(sine * std::cos(turn), sine * std::sin(turn), z);
}

}  // namespace

EmissionSampler::EmissionSampler(std::span<const std::shared_ptr<const Medium>> media) {
    for (const auto& medium : media) {
        bodies_.push_back({medium.get(), 0, {}, {}});
        if (!(medium->emission_majorant() > 0)) continue;
        const int index = static_cast<int>(bodies_.size()) - 1;
        if (medium->bricks()) {
            add_bricks(index);
        } else {
            add_region(index);
        }
    }
    if (leaves_.empty()) return;
    origin_ = leaves_[0].center;
    std::vector<int> order(leaves_.size());
    std::iota(order.begin(), order.end(), 0);
    nodes_.reserve(2 * order.size());
    build(order);
}

void EmissionSampler::add_bricks(int index) {
    Body& body = bodies_[static_cast<std::size_t>(index)];
    const BrickVolume& bricks = *body.medium->bricks();
    const Transform& to_world = bricks.to_world();
    const double volume = std::abs(to_world.determinant()) * block_edge * block_edge * block_edge;
    body.density = 1 / volume;
    for (const Vec3d& c : to_world.column) body.edge += 0.5 * block_edge * abs(c);
    std::vector<float> emission(static_cast<std::size_t>(bricks.size()) * 8);
    parallel_for(bricks.size(), 16, [&](int brick) {
        for (int b = 0; b < BrickVolume::brick_blocks; ++b) {
            const float bound = body.medium->emission_bound(brick, b);
            if (!(bound > 0)) continue;
            // The 64 points may miss what little a corner emits.
            emission[static_cast<std::size_t>(8 * brick + b)] =
                std::max(luminance(body.medium->mean_emission(brick, b)), 1e-3f * bound);
        }
    });
    body.leaves.assign(emission.size(), -1);
    for (std::size_t i = 0; i < emission.size(); ++i) {
        const auto power = static_cast<float>(static_cast<double>(emission[i]) * volume);
        if (!(power > 0)) continue;
        const int brick = static_cast<int>(i / 8), block = static_cast<int>(i % 8);
        const Vec3i lo = bricks.coord(brick) * BrickVolume::brick_edge + block_offset(block);
        body.leaves[i] = static_cast<std::int32_t>(leaves_.size());
        leaves_.push_back(
            {index, brick, block, power, to_world.point(Vec3d(lo) + Vec3d(0.5 * block_edge)), 0});
    }
}

void EmissionSampler::add_region(int index) {
    Body& body = bodies_[static_cast<std::size_t>(index)];
    const Box3d box = body.medium->bounds();
    const double unit = body.medium->is_ellipsoid() ? 4 * pi / 3 : 8;
    const double volume = unit * std::abs(body.medium->region_to_world().determinant());
    const Vec3d center = 0.5 * (box.lo + box.hi);
    const auto emission = static_cast<double>(luminance(body.medium->at(center).emission));
    body.density = 1 / volume;
    body.edge = 0.5 * box.size();
    body.leaves = {static_cast<std::int32_t>(leaves_.size())};
    leaves_.push_back({index, -1, 0, static_cast<float>(emission * volume), center, 0});
}

// Halves the leaves along the longest side of the box of their centres.
void EmissionSampler::build(std::span<int> order) {
    Box3d centers = Box3d::empty(), box = Box3d::empty();
    double power = 0;
    for (const int i : order) {
        const Leaf& leaf = leaves_[static_cast<std::size_t>(i)];
        const Vec3d& edge = bodies_[static_cast<std::size_t>(leaf.medium)].edge;
        centers.extend(leaf.center);
        box.extend(Box3d{leaf.center - edge, leaf.center + edge});
        power += static_cast<double>(leaf.power);
    }
    const std::size_t self = nodes_.size();
    const Vec3d half = 0.5 * box.size();
    nodes_.push_back({Vec3f(0.5 * (box.lo + box.hi) - origin_), static_cast<float>(dot(half, half)),
                      static_cast<float>(power), 0});
    if (order.size() == 1) {
        leaves_[static_cast<std::size_t>(order[0])].node = static_cast<int>(self);
        nodes_[self].right = -1 - order[0];
        return;
    }
    const Vec3d size = centers.size();
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const std::size_t middle = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle),
                     order.end(), [&](int a, int b) {
                         const double x = leaves_[static_cast<std::size_t>(a)].center[axis],
                                      y = leaves_[static_cast<std::size_t>(b)].center[axis];
                         return x != y ? x < y : a < b;
                     });
    build(order.first(middle));
    nodes_[self].right = static_cast<int>(nodes_.size());
    build(order.subspan(middle));
}

// The probability with which the left child of an inner node is taken.
float EmissionSampler::share_of_left(int node, const Vec3f& receiver) const {
    const auto importance = [&](int child) {
        const Node& n = nodes_[static_cast<std::size_t>(child)];
        const Vec3f d = n.center - receiver;
        return n.power / std::max(dot(d, d), n.radius2);
    };
    const float left = importance(node + 1),
                right = importance(nodes_[static_cast<std::size_t>(node)].right);
    const float sum = left + right;
    if (!(sum > 0 && std::isfinite(sum))) return 0.5f;
    // Neither child is given up: what glows must be in reach.
    constexpr float least = 1e-6f;
    return std::clamp(left / sum, least, 1 - least);
}

EmissionSample EmissionSampler::sample(const Vec3d& receiver, float choice,
                                       const Vec3f& place) const {
    if (is_empty()) return {};
    const Vec3f from(receiver - origin_);
    double u = static_cast<double>(choice), probability = 1;
    int node = 0;
    while (nodes_[static_cast<std::size_t>(node)].right >= 0) {
        const auto left = static_cast<double>(share_of_left(node, from));
        if (u < left) {
            u /= left;
            probability *= left;
            ++node;
        } else {
            u = (u - left) / (1 - left);
            probability *= 1 - left;
            node = nodes_[static_cast<std::size_t>(node)].right;
        }
    }
    const Leaf& leaf =
        leaves_[static_cast<std::size_t>(-1 - nodes_[static_cast<std::size_t>(node)].right)];
    const Body& body = bodies_[static_cast<std::size_t>(leaf.medium)];
    EmissionSample s{{}, static_cast<float>(probability * body.density), leaf.medium};
    if (leaf.brick >= 0) {
        const BrickVolume& bricks = *body.medium->bricks();
        const Vec3i lo =
            bricks.coord(leaf.brick) * BrickVolume::brick_edge + block_offset(leaf.block);
        s.point = bricks.to_world().point(Vec3d(lo) + double{block_edge} * Vec3d(place));
    } else {
        s.point = body.medium->region_to_world().point(
            body.medium->is_ellipsoid() ? in_ball(place) : 2.0 * Vec3d(place) - Vec3d(1));
    }
    return s;
}

// The leaf at local coordinates of a brick.
int EmissionSampler::leaf_at(const Body& body, int brick, const Vec3f& local) const {
    if (body.leaves.empty()) return -1;
    if (brick < 0) return body.leaves[0];
    const int block =
        (local.x >= block_edge) + 2 * (local.y >= block_edge) + 4 * (local.z >= block_edge);
    return body.leaves[static_cast<std::size_t>(8 * brick + block)];
}

int EmissionSampler::leaf_of(int medium, const Vec3d& point) const {
    const Body& body = bodies_[static_cast<std::size_t>(medium)];
    if (body.leaves.empty()) return -1;
    const BrickVolume* bricks = body.medium->bricks();
    if (!bricks) return body.medium->density(point) > 0 ? body.leaves[0] : -1;
    const Vec3d q = bricks->to_lattice().point(point);
    if (!(max_component(abs(q)) < 1e8)) return -1;
    const Vec3i b = floor(q * (1.0 / BrickVolume::brick_edge));
    const int brick = bricks->find(b);
    return brick < 0 ? -1
                     : leaf_at(body, brick, Vec3f(q - Vec3d(b) * double{BrickVolume::brick_edge}));
}

// The probabilities of leaves for one receiver; neighbours share most of the way down.
class EmissionSampler::Descent {
  public:
    Descent(const EmissionSampler& sampler, const Vec3d& receiver)
        : sampler_(sampler), from_(receiver - sampler.origin_) {
        steps_[0] = {0, static_cast<int>(sampler.nodes_.size()), 1};
    }

    double to(int leaf) {
        const int target = sampler_.leaves_[static_cast<std::size_t>(leaf)].node;
        while (target < steps_[last_].node || target >= steps_[last_].end) --last_;
        while (steps_[last_].node != target) {
            const Step& at = steps_[last_];
            const int left = at.node + 1,
                      right = sampler_.nodes_[static_cast<std::size_t>(at.node)].right;
            const auto share = static_cast<double>(sampler_.share_of_left(at.node, from_));
            steps_[last_ + 1] = target < right ? Step{left, right, at.probability * share}
                                               : Step{right, at.end, at.probability * (1 - share)};
            ++last_;
        }
        return steps_[last_].probability;
    }

  private:
    struct Step {
        int node, end;  // the subtree is [node, end)
        double probability;
    };
    const EmissionSampler& sampler_;
    Vec3f from_;
    std::array<Step, 64> steps_;  // the tree is halved by number: 32 levels at most
    std::size_t last_ = 0;
};

double EmissionSampler::probability(const Vec3d& receiver, int leaf) const {
    return Descent(*this, receiver).to(leaf);
}

float EmissionSampler::pdf(const Vec3d& receiver, int medium, const Vec3d& point) const {
    const int leaf = is_empty() ? -1 : leaf_of(medium, point);
    if (leaf < 0) return 0;
    return static_cast<float>(probability(receiver, leaf) *
                              bodies_[static_cast<std::size_t>(medium)].density);
}

float EmissionSampler::direction_pdf(const Ray& ray) const {
    if (is_empty()) return 0;
    double sum = 0;
    Descent descent(*this, ray.origin);
    for (const Body& body : bodies_) {
        if (body.leaves.empty()) continue;
        SegmentWalk walk = body.medium->segments(ray, BrickGrain::Blocks);
        for (MediumSegment s; walk.next(s);) {
            const auto middle = static_cast<float>(0.5 * (s.t0 + s.t1) - s.anchor);
            const int leaf = leaf_at(body, s.brick, s.entry + middle * s.step);
            if (leaf < 0) continue;
            const double shell = (s.t1 * s.t1 * s.t1 - s.t0 * s.t0 * s.t0) / 3;
            sum += descent.to(leaf) * body.density * shell;
        }
    }
    return static_cast<float>(sum);
}

}  // namespace gischt
