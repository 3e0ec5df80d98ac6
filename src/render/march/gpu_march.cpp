// SPDX-License-Identifier: Apache-2.0
#include "render/march/gpu_march.h"

#include "render/march/gpu_march_drawer.h"

namespace gischt {
namespace {

class GpuMarchMethod : public RenderMethod {
  public:
    explicit GpuMarchMethod(const GpuMarchParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        GpuMarchDrawer drawer(offscreen_device(), params_);
        return draw_to_image("gpu_march", drawer, view, settings, job);
    }

  private:
    GpuMarchParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_gpu_march_method(const GpuMarchParams& params) {
    return std::make_unique<GpuMarchMethod>(params);
}

}  // namespace gischt
