// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_map.h"

#include <cmath>

namespace gischt {

double shrunk_radius(int pass, double reduction, int dimensions) {
    double product = 1;
    for (int i = 1; i <= pass; ++i) product *= (i + reduction) / (i + 1);
    return std::pow(product, 1.0 / dimensions);
}

PhotonMap::PhotonMap(const PhotonScene& scene, PhotonSet photons, int pass)
    : in_media(std::move(photons.in_media)), on_surfaces(std::move(photons.on_surfaces)) {
    const PhotonParams& params = scene.params;
    shrunk_disc = static_cast<float>(shrunk_radius(pass, params.reduction, 2));
    shrunk_ball = static_cast<float>(shrunk_radius(pass, params.reduction, 3));
    // Where there are few photons their light is not spread over all of the scene.
    constexpr double most_share = 0.05;
    const auto fixed = static_cast<float>(params.radius);
    most = fixed > 0 ? fixed : static_cast<float>(most_share * length(scene.reach.size()));
    if (params.gather == PhotonGather::Points) return;
    if (fixed > 0) {
        in_media.set_radius(fixed * shrunk_disc);
    } else {
        in_media.set_radius_by_nearest(params.nearest, shrunk_disc, most);
    }
}

}  // namespace gischt
