// SPDX-License-Identifier: Apache-2.0
#include "render/points/points.h"

#include "render/points/point_drawer.h"

namespace gischt {
namespace {

class PointsMethod : public RenderMethod {
  public:
    explicit PointsMethod(const PointsParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        PointDrawer drawer(offscreen_device(), params_);
        return draw_to_image("points", drawer, view, settings, job);
    }

  private:
    PointsParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_points_method(const PointsParams& params) {
    return std::make_unique<PointsMethod>(params);
}

}  // namespace gischt
