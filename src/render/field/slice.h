// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "grid/frame.h"
#include "render/field/field_params.h"

namespace gischt {

// Which cells of a field a slice goes through and how it lies in the picture. Axes count the
// field's own axes: `right` and `up` grow to the right and upwards.
struct SliceAxes {
    int normal = 2, right = 0, up = 1;
};

// The axes of a slice through a field. Where `wanted` leaves it open: the thin axis of a 2-D field,
// else the one that `forward` (unit, metres) looks along most. `above` decides what is up where
// neither is y over x.
SliceAxes slice_axes(const Field& field, SliceAxis wanted, const Vec3d& forward,
                     const Vec3d& above);

// Numbers on a plane: the cells of a field cut by a plane, linear between the two layers of centres
// beside it.
class Slice {
  public:
    // `position` in metres along the normal; unset: the middle of the field. Throws Error{Usage}
    // when the plane misses the field. `value` gives a cell's number.
    Slice(const Field& field, const SliceAxes& axes, std::optional<double> position,
          const std::function<float(const Vec3i&)>& value);

    // The slice's edges in metres along right and up.
    const Vec2d& low() const { return low_; }
    const Vec2d& high() const { return high_; }
    int width() const { return width_; }
    int height() const { return height_; }
    double position() const { return position_; }  // m along the normal

    // Value at a point in metres along right and up; beyond the outermost centres the nearest.
    float at(double right, double up, FieldInterpolation interpolation) const;
    const std::vector<float>& values() const { return values_; }

  private:
    float cell(int i, int j) const;

    int width_ = 1, height_ = 1;
    Vec2d low_, high_;
    double position_ = 0;
    std::vector<float> values_;  // rows from the bottom
};

}  // namespace gischt
