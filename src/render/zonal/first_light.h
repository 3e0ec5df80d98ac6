// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "math/sobol.h"
#include "optics/surface_light.h"
#include "optics/view.h"
#include "render/zonal/zone_grid.h"

namespace gischt {

// The light that comes to zones straight from the lights of a view: points, suns, skies and
// surfaces that glow. Everything is a mean over points of a zone, not the value at its centre, and
// dimmed by the zones on its way; surfaces block.
class FirstLight {
  public:
    // `samples` points per zone and directions per light. All of it must outlive this.
    FirstLight(const View& view, const ZoneGrid& grid, int samples);

    // Calls add(direction, weight) for samples of the light at a zone: the sum of weight *
    // f(direction) is the mean over the zone, as far as it lies outside of solids, of the integral
    // over the directions to the lights of radiance times f; weight in W/m^2.
    template <class F>
    void for_zone(std::size_t zone, F&& add) const {
        const Vec3d corner = grid_.box.lo + Vec3d(grid_.cell(zone)) * grid_.cell_size();
        int outside = 0;
        for (int i = 0; i < samples_; ++i) {
            outside += is_inside_solid(corner + place(i) * grid_.cell_size()) ? 0 : 1;
        }
        for (int i = 0; i < samples_; ++i) {
            const Vec3d point = corner + place(i) * grid_.cell_size();
            if (outside < samples_ && is_inside_solid(point)) continue;
            for (std::size_t l = 0; l < lights_.size(); ++l) {
                Vec3d direction;
                const Vec3f weight = sample(l, {point, {}}, i, direction);
                if (max_component(weight) > 0) {
                    add(direction, weight / Vec3f(static_cast<float>(outside)));
                }
            }
        }
    }
    // Irradiance at a point of a surface divided by pi, W/(m^2 sr); sample `i` of the lights.
    Vec3f at_surface(const SurfaceHit& hit, int i) const;
    // Mean over all directions of the light in each zone: fluence / (4 pi).
    std::vector<Vec3f> mean_radiance(Job& job) const;

    const ZoneGrid& grid() const { return grid_; }

  private:
    // Radiance over density, times transmittance; 0 where blocked. The ray's origin is given.
    Vec3f sample(std::size_t light, Ray ray, int i, Vec3d& direction) const;
    bool is_inside_solid(const Vec3d& point) const;
    // Point i of those of each zone, in [0,1)^3.
    static Vec3d place(int i);

    const View& view_;
    const ZoneGrid& grid_;
    int samples_;
    std::vector<const Light*> lights_;
};

}  // namespace gischt
