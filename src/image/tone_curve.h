// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "math/vec.h"

namespace gischt {

// How linear radiance becomes display-linear light in [0,1], for PNG and MP4.
//   linear  clips at 1: exact for colour maps, harsh for fire and clouds
//   filmic  a soft shoulder over 6.5 stops above middle grey; bright colours pale towards white
enum class ToneKind { Linear, Filmic };

const std::vector<std::string>& tone_names();
// Throws Error{Usage}, listing the names.
ToneKind tone_kind(std::string_view name);
std::string_view tone_name(ToneKind kind);

// Maps radiance, after exposure, to display-linear Rec.709 in [0,1]. Black stays black, grey stays
// grey, and grey never gets darker with more light. Negative components count as 0, NaN as 0.
//
// filmic is the curve x^a / (b x^(a d) + c) of Lottes (2016, "Advanced techniques and optimization
// of HDR color pipelines", GDC) with 0.18 -> 0.18 and 16 -> 1. Before the curve the channels leak
// into each other, as the layers of film do, so that a saturated light turns white as it gets
// brighter instead of clipping at a pure primary (the inset of Sobotka's AgX, 2022); after it most
// of the leak is taken back, so that colours below middle grey keep their saturation.
class ToneCurve {
  public:
    explicit ToneCurve(ToneKind kind = ToneKind::Filmic);

    ToneKind kind() const { return kind_; }
    Vec3f operator()(const Vec3f& radiance) const;

  private:
    float curve(float x) const;

    ToneKind kind_;
    float b_ = 0, c_ = 1;
};

}  // namespace gischt
