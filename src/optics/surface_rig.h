// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/job.h"
#include "image/image.h"
#include "optics/light_params.h"
#include "optics/surface.h"
#include "optics/surface_params.h"
#include "shape/mesh.h"

namespace gischt {

// All surfaces of a scene over time: its solids, and its lights that have a size. Meshes and
// pictures are loaded once.
class SurfaceRig {
  public:
    // A mesh and the colour that its file gives it.
    struct ColoredMesh {
        ColoredMesh(Mesh the_mesh, std::optional<Vec3f> the_color = {},
                    std::string the_picture = {})
            : mesh(std::move(the_mesh)), color(the_color), picture(std::move(the_picture)) {}
        Mesh mesh;
        std::optional<Vec3f> color;  // linear, in [0,1]
        std::string picture;         // path; multiplies the colour; empty for none
    };
    // Read files; the door to them lies above this room.
    using MeshLoader = std::function<ColoredMesh(const std::string& file, Job& job)>;
    using ImageLoader = std::function<Image(const std::string& file)>;
    using Media = std::map<std::string, std::shared_ptr<const Medium>>;

    SurfaceRig();
    ~SurfaceRig();
    SurfaceRig(SurfaceRig&&) noexcept;
    SurfaceRig& operator=(SurfaceRig&&) noexcept;
    // Throws what the loaders throw, and Error{Usage} where a file is needed and there is no
    // loader. Reports triangles that were dropped, and dielectric meshes that are not closed.
    SurfaceRig(const std::vector<SurfaceParams>& solids, const std::vector<AnyLightParams>& lights,
               const Vec3d& scene_up, const MeshLoader& load_mesh, const ImageLoader& load_image,
               Job& job);

    // The surfaces while the film is exposed, centred on `time`. `media` are the fluids that may
    // fill an inside. Not to be called by two threads at once. Throws Error{Usage} for an interior
    // that is not among them, and on sizes that are not positive.
    SurfaceSet at(double time, double shutter, const Media& media);

  private:
    struct Loaded;
    std::unique_ptr<Loaded> loaded_;
};

}  // namespace gischt
