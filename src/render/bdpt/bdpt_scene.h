// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "optics/light_emission.h"
#include "render/bdpt/bdpt_params.h"
#include "render/path/path_scene.h"

namespace gischt {

// A view made ready for paths from both ends.
struct BdptScene {
    // `method` is the name in messages. Throws Error{Usage} where the view asks for what the method
    // cannot do.
    BdptScene(const View& the_view, const BdptParams& the_params, std::string_view method,
              Job& job);

    BdptParams params;
    PathParams path_params;
    PathScene path;  // lights by kind
    const View& view;
    Box3d reach;                            // finite, around all that light paths can meet
    std::optional<LightEmission> emission;  // none where nothing shines
    std::vector<const Medium*> glowing;     // by index in `glow`
    EmissionSampler glow;                   // points of media that glow, seen from a receiver
    // Collisions per metre at which paths from the camera are taken to meet what glows, for
    // weights.
    double glow_rate = 0;

    // The sources of light paths; -1 for what is none.
    int source_of(const Light* light) const { return found_in(light_sources_, light); }
    int source_of(const Medium* medium) const { return found_in(medium_sources_, medium); }
    // Probability with which a light at infinity is sampled for a vertex; 0 for one that is only
    // met.
    double far_share(const Light& light) const;
    int glow_index(const Medium* medium) const { return found_in(glow_index_, medium); }
    // Whether light of a source at infinity that passes a point along `travel` may be the start of
    // a light path.
    bool is_in_reach(const Vec3d& point, const Vec3d& travel) const;

  private:
    template <class Key>
    static int found_in(const std::unordered_map<const Key*, int>& map, const Key* key) {
        const auto found = map.find(key);
        return found == map.end() ? -1 : found->second;
    }
    void take_glow();
    void take_sources(Job& job);

    std::unordered_map<const Light*, int> light_sources_;
    std::unordered_map<const Medium*, int> medium_sources_, glow_index_;
};

}  // namespace gischt
