// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fluid/advect_kernel.h"
#include "fluid/block.h"
#include "fluid/domain.h"

namespace gischt {

// A scalar at cell centres of which most blocks are often zero: those are neither read nor moved.
struct SparseField {
    TileField<float> values;
    std::vector<std::uint8_t> active;  // per block: may hold anything but zeros

    SparseField() = default;
    explicit SparseField(const BlockMap& blocks, const TileMap::Ptr& map)
        : values(map), active(static_cast<std::size_t>(blocks.size()), 0) {}
};

// Zeroes what is below the floor, and finds out which blocks are left with anything.
void drop_small(const BlockMap& blocks, SparseField& field, float floor);

// Three buffers of one scalar. advect() leaves the result in `now`.
struct AdvectedScalar {
    SparseField *now = nullptr, *predicted = nullptr, *next = nullptr;
    AdvectionScheme scheme = AdvectionScheme::MacCormack;
    float factor = 1;                   // decay over the step
    float floor = 0;                    // smaller results become zero
    const ScalarHold* sides = nullptr;  // what the domain's sides hold; null: ambient
};

struct AdvectedVelocity {
    FaceField *now = nullptr, *predicted = nullptr, *next = nullptr;
    AdvectionScheme scheme = AdvectionScheme::MacCormack;
    // The velocity that carries everything; null: `now`.
    const FaceField* through = nullptr;
};

// Largest |component| of the velocity on the faces of each block, m/s.
using BlockSpeeds = std::vector<Vec3f>;
BlockSpeeds measure_speeds(const Domain& domain, const BlockMap& blocks, const FaceField& velocity);

// Transports scalars and the velocity itself over dt seconds through a velocity, whose speeds bound
// how far a block has to look. Conservative scalars are left alone: see transport.h. Results and
// inputs change places: `now` is the new state. Reads and writes about 4 (2 + 3) 5 bytes per cell
// of active fields.
void advect(const Domain& domain, const BlockMap& blocks, const BlockSpeeds& speeds, double dt,
            Interpolation interpolation, AdvectedVelocity& velocity,
            std::span<AdvectedScalar> scalars);

}  // namespace gischt
