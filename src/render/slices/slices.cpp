// SPDX-License-Identifier: Apache-2.0
#include "render/slices/slices.h"

#include "render/slices/slice_drawer.h"

namespace gischt {
namespace {

class SlicesMethod : public RenderMethod {
  public:
    explicit SlicesMethod(const SlicesParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        SliceDrawer drawer(offscreen_device(), params_);
        return draw_to_image("slices", drawer, view, settings, job);
    }

  private:
    SlicesParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_slices_method(const SlicesParams& params) {
    return std::make_unique<SlicesMethod>(params);
}

}  // namespace gischt
