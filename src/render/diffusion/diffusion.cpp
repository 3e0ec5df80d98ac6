// SPDX-License-Identifier: Apache-2.0
#include "render/diffusion/diffusion.h"

#include "render/diffusion/diffusion_light.h"
#include "render/zonal/gather.h"

namespace gischt {
namespace {

class DiffusionMethod : public RenderMethod {
  public:
    explicit DiffusionMethod(const DiffusionParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        const Box3d media = check_gathered(view, "diffusion");
        DiffusionParams params = params_;
        if (settings.preview) params.resolution = (params.resolution + 1) / 2;
        const auto light = light_by_diffusion(view, media, params, job);
        RenderResult result = render_gathered(view, settings, "diffusion", *light,
                                              {params_.step, params_.step_depth}, job);
        result.statistics.wall_seconds = now_seconds() - start;
        return result;
    }

  private:
    DiffusionParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_diffusion_method(const DiffusionParams& params) {
    return std::make_unique<DiffusionMethod>(params);
}

}  // namespace gischt
