// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "optics/interior.h"
#include "render/path/tracking.h"
#include "render/photon/photon_scene.h"
#include "render/photon/photon_tree.h"

namespace gischt {

// The photons of a map: those that their places in media and on surfaces scatter.
struct PhotonSet {
    std::vector<Photon> in_media, on_surfaces;
    std::size_t size() const { return in_media.size() + on_surfaces.size(); }
};

// Follows photons from their sources through media and surfaces (Jensen & Christensen 1998), and
// keeps them where they are scattered, but for light that comes there straight from its source.
// Where a part of the light is absorbed the photon ends with that chance instead of growing weaker.
// Keeps scratch memory, so one per thread.
class PhotonTracer {
  public:
    // Keeps this share of its places, drawn by chance, with so much more power.
    PhotonTracer(const PhotonScene& scene, float kept_share);

    // Follows light that has just left its source, its power times `share`.
    void follow(const EmittedLight& light, float share, RandomStream random, PhotonSet& out);

  private:
    enum class End { Infinity, Surface, Collision };

    End fly(Collision& collision, std::optional<SurfaceHit>& hit);
    bool scatter_in_medium(const Collision& collision);
    bool scatter_at_surface(const SurfaceHit& hit);
    bool survives(const Vec3f& before);
    void cross(const SurfaceHit& hit);
    void take_media();
    bool passes(const SurfaceHit& hit) const;
    // Light that comes straight from its source is found in other ways.
    bool is_kept(int events) const { return events > 1 || mirrors_ > 0; }
    void keep(std::vector<Photon>& out, const Vec3d& point, int place, int events);

    const PhotonScene& scene_;
    float kept_share_;
    Tracker tracker_;
    PhotonSet* out_ = nullptr;
    RandomStream random_;
    Ray ray_;
    PathWeight weight_;  // W
    int hero_ = 0, events_ = 0, mirrors_ = 0;
    std::optional<InteriorStack> inside_;
    const Medium* interior_ = nullptr;
};

// How many photons are sent out for a map, and which share of their places is kept.
struct PhotonCount {
    std::int64_t everywhere = 0, aimed = 0;
    float kept_share = 1;
    std::int64_t sum() const { return everywhere + aimed; }
};

// So many that about params.photons are kept, found by a trial. Of a photon that is scattered very
// often not every place is kept: they are too much alike.
PhotonCount count_photons(const PhotonScene& scene, std::uint64_t seed, Job& job);

// The photons of map number `pass`. Bits: a function of the scene, the count, seed and pass alone.
PhotonSet trace_photons(const PhotonScene& scene, const PhotonCount& count, std::uint64_t seed,
                        int pass, Job& job);

}  // namespace gischt
