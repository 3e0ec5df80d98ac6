// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/zonal.h"

#include "render/zonal/gather.h"
#include "render/zonal/zone_light.h"

namespace gischt {
namespace {

class ZonalMethod : public RenderMethod {
  public:
    explicit ZonalMethod(const ZonalParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const double start = now_seconds();
        const Box3d media = check_gathered(view, "zonal");
        ZonalParams params = params_;
        if (settings.preview) params.zones = (params.zones + 1) / 2;
        const auto light = light_of_zones(view, media, params, job);
        RenderResult result = render_gathered(view, settings, "zonal", *light,
                                              {params_.step, params_.step_depth}, job);
        result.statistics.wall_seconds = now_seconds() - start;
        return result;
    }

  private:
    ZonalParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_zonal_method(const ZonalParams& params) {
    return std::make_unique<ZonalMethod>(params);
}

}  // namespace gischt
