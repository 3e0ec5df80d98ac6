// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/job.h"
#include "optics/light_emission.h"
#include "render/path/path_scene.h"
#include "render/photon/photon_params.h"

namespace gischt {

// A view made ready for photon mapping.
struct PhotonScene {
    // `depth`: most scattering events of a light path. Throws Error{Usage} where the view asks for
    // what the method cannot do. View and parameters must outlive it.
    PhotonScene(const View& the_view, const PhotonParams& the_params, const PathParams& path_params,
                int the_depth, Job& job);

    const View& view;
    const PhotonParams& params;
    int depth;
    PathScene path;  // for the camera's end of light paths

    std::vector<const Medium*> media;  // all there are, those that fill surfaces too
    int place_of(const Medium* medium) const;

    Box3d reach;   // m, around all that photons can meet
    Vec3d origin;  // its middle, from which photons count
    // What shines. With `aimed` the rays of lights without a surface that meet `target` are its
    // own, and so are all of surfaces and media; `everywhere` has the rest.
    std::optional<LightEmission> everywhere, aimed;
    std::optional<BoxTarget> target;
    // Some light arrives in other ways than straight from its source.
    bool has_photons = false;

  private:
    void refuse_what_it_cannot() const;
    void find_reach();
    void find_target(Job& job);
};

}  // namespace gischt
