// SPDX-License-Identifier: Apache-2.0
#include "render/field/slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/interpolate.h"

namespace gischt {
namespace {

Vec3d unit_column(const Field& field, int axis) {
    return normalize(field.to_world.column[static_cast<std::size_t>(axis)]);
}

// The field's axis whose direction in space is nearest to a unit vector.
int nearest_axis(const Field& field, const Vec3d& direction) {
    int best = 0;
    for (int a = 1; a < 3; ++a) {
        if (std::abs(dot(unit_column(field, a), direction)) >
            std::abs(dot(unit_column(field, best), direction)) + 1e-9) {
            best = a;
        }
    }
    return best;
}

}  // namespace

SliceAxes slice_axes(const Field& field, SliceAxis wanted, const Vec3d& forward,
                     const Vec3d& above) {
    SliceAxes axes;
    if (wanted == SliceAxis::Automatic) {
        axes.normal = nearest_axis(field, forward);
        const Vec3i n = field.map().bounds().size();
        for (int a = 2; a >= 0; --a) {
            if (n[a] == 1) axes.normal = a;
        }
    } else {
        Vec3d direction;
        direction[wanted == SliceAxis::X ? 0 : wanted == SliceAxis::Y ? 1 : 2] = 1;
        axes.normal = nearest_axis(field, direction);
    }
    axes.right = axes.normal == 0 ? 1 : 0;
    axes.up = 3 - axes.normal - axes.right;
    // Seen from the side the scene's up is up; a plane seen from above keeps x to the right.
    if (axes.normal == 0 && std::abs(dot(unit_column(field, axes.right), above)) >
                                std::abs(dot(unit_column(field, axes.up), above)) + 1e-9) {
        std::swap(axes.right, axes.up);
    }
    return axes;
}

Slice::Slice(const Field& field, const SliceAxes& axes, std::optional<double> position,
             const std::function<float(const Vec3i&)>& value) {
    // Where nothing is stored there is still the background to show.
    Box3i box = field.map().bounds();
    if (box.is_empty()) box = {{0, 0, 0}, {1, 1, 1}};
    width_ = box.size()[axes.right];
    height_ = box.size()[axes.up];
    const auto metres = [&](int axis, double cell) {
        Vec3d corner;
        corner[axis] = cell;
        return dot(field.to_world.point(corner), unit_column(field, axis));
    };
    low_ = {metres(axes.right, box.lo[axes.right]), metres(axes.up, box.lo[axes.up])};
    high_ = {metres(axes.right, box.hi[axes.right]), metres(axes.up, box.hi[axes.up])};

    // The plane in cells along the normal, and the two layers of centres beside it.
    const int n = axes.normal;
    const double first = metres(n, box.lo[n]), last = metres(n, box.hi[n]);
    position_ = position ? *position : 0.5 * (first + last);
    const double slack = 1e-9 * (std::abs(first) + std::abs(last));
    if (!(position_ >= first - slack && position_ <= last + slack)) {
        throw Error(ErrorKind::Usage, "field",
                    fmt::format("position {} misses the field", position_),
                    fmt::format("it reaches from {:.4g} to {:.4g} m", first, last));
    }
    const double c = std::clamp((position_ - first) / (last - first) * box.size()[n] - 0.5, 0.0,
                                box.size()[n] - 1.0);
    const int layer = std::min(static_cast<int>(c), box.size()[n] - 1);
    const auto t = static_cast<float>(c - layer);

    values_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int j = 0; j < height_; ++j) {
        for (int i = 0; i < width_; ++i) {
            Vec3i at = box.lo;
            at[axes.right] += i;
            at[axes.up] += j;
            at[n] += layer;
            float v = value(at);
            if (t > 0) {
                ++at[n];
                v = lerp(v, value(at), t);
            }
            values_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(i)] = v;
        }
    }
}

float Slice::cell(int i, int j) const {
    return values_[static_cast<std::size_t>(std::clamp(j, 0, height_ - 1)) *
                       static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(std::clamp(i, 0, width_ - 1))];
}

float Slice::at(double right, double up, FieldInterpolation interpolation) const {
    const double x = (right - low_.x) / (high_.x - low_.x) * width_;
    const double y = (up - low_.y) / (high_.y - low_.y) * height_;
    if (interpolation == FieldInterpolation::Nearest) {
        return cell(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
    }
    const double cx = std::clamp(x - 0.5, 0.0, width_ - 1.0),
                 cy = std::clamp(y - 0.5, 0.0, height_ - 1.0);
    const int i = static_cast<int>(cx), j = static_cast<int>(cy);
    const auto s = static_cast<float>(cx - i), t = static_cast<float>(cy - j);
    if (interpolation == FieldInterpolation::Linear) {
        return lerp(lerp(cell(i, j), cell(i + 1, j), s),
                    lerp(cell(i, j + 1), cell(i + 1, j + 1), s), t);
    }
    float row[4];
    for (int r = 0; r < 4; ++r) {
        const int k = j + r - 1;
        row[r] = monotone_cubic(cell(i - 1, k), cell(i, k), cell(i + 1, k), cell(i + 2, k), s);
    }
    return monotone_cubic(row[0], row[1], row[2], row[3], t);
}

}  // namespace gischt
