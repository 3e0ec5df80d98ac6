// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "render/billboards/billboards_params.h"
#include "render/method.h"

namespace gischt {

// Particles as small pictures that face the camera, their motion, or one side (eq. 3), blended by
// eq. 4.
std::unique_ptr<RenderMethod> make_billboards_method(const BillboardsParams& params);

inline constexpr std::string_view billboards_simulates =
    "particles as pictures that scatter the light which reaches them, glow, or show their colour; "
    "surfaces behind and before them";
inline constexpr std::string_view billboards_leaves_out =
    "media: fluids without particles are not seen, but cast their shadows; how light changes "
    "within a picture; depth of field, motion blur";
inline constexpr std::string_view billboards_cost =
    "particles times the pixels that each covers, on graphics hardware or the processor (OpenGL "
    "4.5)";

}  // namespace gischt
