// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/path/path_tracer.h"
#include "render/photon/photon_map.h"

namespace gischt {

// Makes radiance of the photons around the camera's rays. Keeps scratch memory, so one per thread.
class PhotonLight : public EyeGather {
  public:
    // The map may be another one for each ray.
    PhotonLight(const PhotonScene& scene, const std::unique_ptr<const PhotonMap>& map)
        : scene_(scene), map_(map) {}

    Light along(const Ray& ray, const RayProfile& profile, std::span<const Medium* const> media,
                RandomStream random) override;
    Light at(const SurfaceHit& hit, const Bsdf& bsdf, const Vec3d& out) override;

    std::int64_t gathered = 0;  // photons, for statistics

  private:
    Light by_beams(const Ray& ray, const RayProfile& profile, double end);
    Light by_points(const Ray& ray, const RayProfile& profile, double end, RandomStream& random);
    Light at_point(const Vec3d& point, const Vec3f& towards, float depth);
    Vec3f dimmed(const Vec3f& depth) const;
    void allow(std::span<const Medium* const> media);
    // Photons within the radius around a point: those nearest but for the last one, which tells the
    // radius, squared.
    float find(const PhotonTree& tree, const Vec3f& point, int count, float shrunk);

    const PhotonScene& scene_;
    const std::unique_ptr<const PhotonMap>& map_;
    std::vector<PhotonTree::Near> near_;
    std::vector<ProfilePoint> places_;
    std::vector<char> allowed_;  // by place in scene_.media: whether a ray is in that medium
    std::int64_t lookups_ = 0;
};

}  // namespace gischt
