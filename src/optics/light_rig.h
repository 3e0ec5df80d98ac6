// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "image/image.h"
#include "optics/light.h"
#include "optics/light_params.h"
#include "optics/sky.h"

namespace gischt {

// All lights of a scene over time. Pictures are loaded once, skies computed when the sun has moved.
class LightRig {
  public:
    // Reads the picture of an environment light; the door to files lies above this room.
    using ImageLoader = std::function<Image(const std::string& file)>;

    LightRig() = default;
    // Loads all pictures. Throws what the loader throws, and Error{Usage} where a picture is needed
    // and there is no loader.
    LightRig(std::vector<AnyLightParams> lights, const Vec3d& scene_up, const ImageLoader& load);

    const std::vector<AnyLightParams>& params() const { return params_; }

    // The lights at one moment; lights without strength are left out, a sky with its sun is two.
    // Lights that have a size are surfaces (optics/surface_rig.h) and not among them.
    // Not to be called by two threads at once. Throws Error{Usage} for a direction without length.
    std::vector<LightPtr> at(double time);

  private:
    struct Builder;

    std::vector<AnyLightParams> params_;
    Vec3d scene_up_{0, 0, 1};
    std::map<std::string, EnvironmentMap::Ptr> maps_;
    std::vector<std::pair<SkyState, Sky>> skies_;  // the last one of each sky light
};

// The colour of a light times that of its black body.
Vec3f light_tint(const LightParams& light, double time);

// The exposure in stops that shows a grey card (albedo 0.18) as middle grey (0.18) that lies at a
// point without shadow and faces the light: half of the lights' fluence counts as its irradiance.
// 0 when there is no light.
double natural_exposure(const std::vector<LightPtr>& lights, const Vec3d& point);

}  // namespace gischt
