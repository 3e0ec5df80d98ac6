// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gl/device.h"

namespace gischt {

// A device that draws nothing and writes down what it is asked: tests read in which order and with
// which states something is drawn, on machines without any driver. What is read back is zero.
class NullDevice : public GlDevice {
  public:
    // One line per call that changes what is seen: "target", "clear", "use", "draw", "dispatch",
    // with its figures.
    std::vector<std::string> calls;
    std::vector<GlDraw> draws;
    int objects = 0;  // that exist

    const GlLimits& limits() const override { return limits_; }
    GlId create_buffer(std::size_t, const void*) override { return make(); }
    void write_buffer(GlId, std::size_t, std::size_t, const void*) override {}
    void read_buffer(GlId, std::size_t, std::size_t bytes, void* data) override;
    GlId create_texture(const GlTextureSpec&) override { return make(); }
    void write_texture(GlId, const GlTextureSpec&, const Vec3i&, const Vec3i&,
                       const void*) override {}
    void read_texture(GlId, const GlTextureSpec& spec, void* data) override;
    GlId create_framebuffer(std::span<const GlId>, GlId) override { return make(); }
    void read_pixels(GlId, const Vec2i& size, float* rgba) override;
    GlId create_program(std::string_view, std::span<const GlStage>) override { return make(); }
    GlId create_timer() override { return make(); }
    void destroy(GlKind, GlId) override { --objects; }
    void set_target(GlId framebuffer, const Vec2i& size) override;
    void set_margin(int) override {}
    void clear_color(int attachment, const std::array<float, 4>& value) override;
    void clear_depth(float depth) override;
    void use(GlId program) override;
    void set(GlId, const char*, const GlValue&) override {}
    void bind_texture(int, GlId) override {}
    void bind_image(int, GlId, GlFormat) override {}
    void bind_storage(int, GlId) override {}
    void draw(const GlDraw& draw) override;
    void dispatch(const Vec3i& groups) override;
    void barrier() override {}
    void finish() override {}
    void begin_timer(GlId) override {}
    void end_timer(GlId) override {}
    double timer_seconds(GlId) override { return 0; }

  private:
    GlId make() {
        ++objects;
        return ++last_;
    }

    GlLimits limits_{"nothing", "0", 2048, 16384, 255, 1 << 30, true};
    GlId last_ = 0;
};

}  // namespace gischt
