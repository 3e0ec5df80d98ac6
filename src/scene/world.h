// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "fluid/source.h"
#include "optics/light_rig.h"
#include "optics/surface_rig.h"
#include "optics/view.h"
#include "scene/scene.h"

namespace gischt {

// What moves a fluid of a scene: the solver, the procedure or the reader behind one section.
std::unique_ptr<FluidSource> make_source(const Scene& scene, const FluidSection& fluid);

// Reports the solids that stand where a simulated fluid is and do not stop it: meshes, of smoke
// those that are not closed.
void report_unmet_solids(const Scene& scene, const FluidSection& fluid, Job& job);

// Whether frames of this fluid are computed (and cached as VDB), not read from files of somebody
// else.
bool is_computed(const FluidSection& fluid);

// A scene over time: turns the frames of its fluids into what a render method is given. Loads
// pictures and meshes once.
class World {
  public:
    // The scene must outlive it. Throws what reading the files throws.
    World(const Scene& scene, Job& job);

    // `frames` holds one frame per fluid of the scene, in order.
    View view(const std::vector<std::shared_ptr<const Frame>>& frames, int frame, Job& job);
    // The camera of such a view: the scene's, or the one that frames the fluids.
    CameraParams camera(const View& view) const;

  private:
    void blur(View& view, Job& job) const;

    const Scene& scene_;
    LightRig lights_;
    SurfaceRig surfaces_;
};

}  // namespace gischt
