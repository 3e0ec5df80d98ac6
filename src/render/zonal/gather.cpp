// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "image/color.h"
#include "optics/material.h"
#include "render/aov.h"
#include "render/path/path_tracer.h"
#include "render/progressive.h"
#include "render/zonal/scattered_march.h"

namespace gischt {
namespace {

constexpr float least_opacity = 0.01f;  // below, nothing was hit
// Of a sample, beyond those of the path tracer.
constexpr std::uint32_t dimension_jitter = PixelSampler::stratified_dimensions - 1;

constexpr std::array gathered_aovs{Aov::Direct, Aov::Indirect,      Aov::Emission, Aov::Albedo,
                                   Aov::Normal, Aov::Transmittance, Aov::Variance, Aov::Samples};

class GatherWorker : public PixelWorker {
  public:
    GatherWorker(const View& view, const PathScene& scene, const AovLayout& layout,
                 const ScatteredSource& source, const GatherParams& params)
        : view_(view), layout_(layout), tracer_(scene, 1, false), march_(scene, source, params) {}

    void sample(const PixelSample& at, FilmSample& out, std::span<float> extra) override {
        const Ray ray = view_.camera.ray(at.film_x, at.film_y, at.lens, at.time);
        const TracedRay& seen = tracer_(ray, static_cast<float>(at.time), at.numbers);
        const Vec3f further = march_(ray, at.numbers.one(dimension_jitter));
        rays = 2 * tracer_.rays();
        lookups = tracer_.lookups() + march_.lookups;
        out.radiance = seen.radiance + further;
        out.alpha = seen.alpha;
        if (seen.opacity > least_opacity) {
            out.depth = static_cast<float>(
                view_.camera.depth(ray, static_cast<double>(seen.depth / seen.opacity)));
        }
        AovLayout::add(extra, layout_.direct, seen.direct);
        AovLayout::add(extra, layout_.indirect, seen.indirect + further);
        AovLayout::add(extra, layout_.emission, seen.emission);
        AovLayout::add(extra, layout_.albedo, seen.albedo);
        AovLayout::add(extra, layout_.normal, seen.normal);
        AovLayout::add(extra, layout_.transmittance, seen.transmittance);
    }

  private:
    const View& view_;
    const AovLayout& layout_;
    PathTracer tracer_;
    ScatteredMarch march_;
};

[[noreturn]] void refuse_view(std::string_view method, std::string what, std::string hint) {
    throw Error(ErrorKind::Usage, std::string(method), std::move(what), std::move(hint));
}

void check_surfaces(const SurfaceSet& surfaces, std::string_view method) {
    for (int i = 0; i < surfaces.size(); ++i) {
        const SurfaceInfo& info = surfaces.info(i);
        if (info.holdout || info.shadow_catcher) {
            refuse_view(method, fmt::format("solid '{}' is a holdout or shadow catcher", info.name),
                        "take method 'path'");
        }
        if (info.is_moving) {
            refuse_view(method,
                        fmt::format("solid '{}' moves while the film is exposed", info.name),
                        "set camera.shutter to 0, or take method 'path'");
        }
        if (info.material != MaterialKind::Lambert && !info.is_lamp) {
            refuse_view(method,
                        fmt::format("solid '{}' scatters light in another way than Lambert's: a "
                                    "mirror, glass, a coat or a boundary",
                                    info.name),
                        "take method 'path'");
        }
    }
}

}  // namespace

Box3d check_gathered(const View& view, std::string_view method) {
    check_surfaces(view.surfaces, method);
    if (!view.moving_media.empty()) {
        refuse_view(method, "a medium moves while the film is exposed",
                    "set camera.shutter to 0, or take method 'path'");
    }
    Box3d box = Box3d::empty();
    for (const auto& medium : view.media) {
        if (medium->majorant() == 0 && medium->emission_majorant() == 0) continue;
        if (!medium->has_lattice()) {
            refuse_view(method, "a medium has no end, or is as large as a planet",
                        "give the fog a box, or take method 'path'");
        }
        box.extend(medium->bounds());
    }
    if (box.is_empty()) {
        refuse_view(method, "there is no medium, and so no box for light to be found in",
                    "take method 'path'");
    }
    return box;
}

RenderResult render_gathered(const View& view, const RenderSettings& settings,
                             std::string_view method, const ScatteredSource& source,
                             const GatherParams& params, Job& job) {
    const PathParams path_params;
    const PathScene scene(view, path_params, job);
    ProgressiveTask task;
    task.method = method;
    task.layout = aov_layout(view, settings, {method, gathered_aovs, false});
    task.make_worker = [&] {
        return std::make_unique<GatherWorker>(view, scene, task.layout, source, params);
    };
    return render_progressively(view, settings, task, job);
}

}  // namespace gischt
