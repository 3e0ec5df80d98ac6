// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "math/vec.h"

namespace gischt {

enum class AdvectionScheme { SemiLagrangian, MacCormack, Conservative };
// Linear; cubic Hermite with limited slopes (Fritsch & Carlson 1980), which makes no new extrema;
// cubic through the four nearest points (Lagrange), of fourth order.
enum class Interpolation { Linear, MonotoneCubic, Cubic };

// One quantity in an advection sweep over a block. Without `predicted`: out = before, taken where
// the fluid came from (semi-Lagrangian, Stam 1999). With it: out = predicted corrected by half the
// error that the way forth and back leaves, within the range of the eight values around the origin
// (MacCormack of Selle, Fedkiw, Kim, Liu, Rossignac 2008).
struct AdvectedBlock {
    const float* before = nullptr;
    const float* predicted = nullptr;
    float* out = nullptr;
    float factor = 1;  // multiplies the result: decay
    float floor = 0;   // results smaller than this become zero
    // Without `predicted`: keeps the result in the range of the values at the corners around the
    // origin, so that the cubic through four points does not overshoot (Bermejo, Staniforth 1992).
    bool limited = false;
};

// A block with its halo: all inputs are dense arrays of `size` points, x fastest, component a of
// the velocity on the lower faces of the cells. Point (i,j,k) of the block is point first + (i,j,k)
// of the inputs; the outputs have strides of their own and rows of room for a multiple of 16.
struct AdvectGeometry {
    std::array<const float*, 3> velocity{};  // m/s
    Vec3i size, first, count;
    std::ptrdiff_t out_stride_y = 0, out_stride_z = 0;
    float dt_over_h = 0;  // s/m
    int face_axis = -1;   // the points are centres of cells, or lower faces along this axis
    bool is_2d = false;
    Interpolation interpolation = Interpolation::Linear;
};

// Advects the quantities, which live at the same points and share the traces: the midpoint rule
// (second-order Runge-Kutta), for cubics through four points Ralston's rule of third order (1962),
// through the velocity interpolated linearly. Vectorized, the
// instruction set chosen at run time. The halo must hold the largest displacement plus 1 (2 for the
// cubic interpolation); what lies further is clamped to it.
void advect_block(const AdvectGeometry& geometry, std::span<const AdvectedBlock> quantities);

}  // namespace gischt
