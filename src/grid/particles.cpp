// SPDX-License-Identifier: Apache-2.0
#include "grid/particles.h"

#include "base/error.h"

namespace gischt {

void Particles::resize(std::size_t count) {
    for_all_particle_arrays(*this, [count](auto& array) { array.resize(count); });
}

Box3d Particles::bounds() const {
    Box3d box = Box3d::empty();
    for (const Vec3d& p : position) box.extend(p);
    return box;
}

void keep_particles(Particles& particles, const std::vector<std::uint8_t>& keep) {
    GISCHT_ASSERT(keep.size() == particles.size());
    for_all_particle_arrays(particles, [&keep](auto& array) {
        std::size_t to = 0;
        for (std::size_t i = 0; i < keep.size(); ++i) {
            if (keep[i]) array[to++] = array[i];
        }
        array.resize(to);
    });
}

}  // namespace gischt
