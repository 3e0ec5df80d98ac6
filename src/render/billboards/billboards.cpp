// SPDX-License-Identifier: Apache-2.0
#include "render/billboards/billboards.h"

#include "render/billboards/billboard_drawer.h"

namespace gischt {
namespace {

class BillboardsMethod : public RenderMethod {
  public:
    explicit BillboardsMethod(const BillboardsParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        BillboardDrawer drawer(offscreen_device(), params_);
        return draw_to_image("billboards", drawer, view, settings, job);
    }

  private:
    BillboardsParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_billboards_method(const BillboardsParams& params) {
    return std::make_unique<BillboardsMethod>(params);
}

}  // namespace gischt
