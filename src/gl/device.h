// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "gl/types.h"

namespace gischt {

// What can be asked of OpenGL: a narrow door, so that what draws is the same in a window, in a file
// and, with the device that draws nothing (gl/null_device.h), in tests of logic. Objects are owned
// by the classes of gl/objects.h. A device belongs to the thread whose context it speaks to.
// Everything may throw Error{Resource} when memory does not suffice.
class GlDevice {
  public:
    virtual ~GlDevice() = default;

    virtual const GlLimits& limits() const = 0;

    virtual GlId create_buffer(std::size_t bytes, const void* data) = 0;  // data may be null
    virtual void write_buffer(GlId buffer, std::size_t at, std::size_t bytes, const void* data) = 0;
    virtual void read_buffer(GlId buffer, std::size_t at, std::size_t bytes, void* data) = 0;
    // Texels are not initialized. Throws Error{Usage} when a side is larger than the limits.
    virtual GlId create_texture(const GlTextureSpec& spec) = 0;
    // A box of texels, x fastest, rows from bottom to top.
    virtual void write_texture(GlId texture, const GlTextureSpec& spec, const Vec3i& at,
                               const Vec3i& size, const void* data) = 0;
    virtual void read_texture(GlId texture, const GlTextureSpec& spec, void* data) = 0;
    // `depth` may be 0.
    virtual GlId create_framebuffer(std::span<const GlId> colors, GlId depth) = 0;
    // Of colour attachment 0: four floats per pixel, rows from bottom to top.
    virtual void read_pixels(GlId framebuffer, const Vec2i& size, float* rgba) = 0;
    // Compiles and links. Throws Error{Internal} whose `where` is name:line and whose text is the
    // driver's log. Programs of the same text are one, and live as long as the device: compiling
    // takes up to half a second. All uniforms must be set before each use.
    virtual GlId create_program(std::string_view name, std::span<const GlStage> stages) = 0;
    virtual GlId create_timer() = 0;
    virtual void destroy(GlKind kind, GlId id) = 0;

    // What follows draws into this framebuffer, of that many pixels.
    virtual void set_target(GlId framebuffer, const Vec2i& size) = 0;
    // Draws as if the target reached that many pixels farther on each side, where nothing is kept:
    // what is clipped by its middle is not lost at the edges. 0 again after set_target().
    virtual void set_margin(int pixels) = 0;
    virtual void clear_color(int attachment, const std::array<float, 4>& value) = 0;
    virtual void clear_depth(float depth) = 0;

    virtual void use(GlId program) = 0;
    // A uniform that the driver found unused is skipped.
    virtual void set(GlId program, const char* name, const GlValue& value) = 0;
    virtual void bind_texture(int unit, GlId texture) = 0;
    virtual void bind_image(int unit, GlId texture,
                            GlFormat format) = 0;  // read and write, level 0
    virtual void bind_storage(int slot, GlId buffer) = 0;

    virtual void draw(const GlDraw& draw) = 0;
    virtual void dispatch(const Vec3i& groups) = 0;
    // What shaders wrote before is seen by everything after.
    virtual void barrier() = 0;
    // Waits until everything is done.
    virtual void finish() = 0;

    virtual void begin_timer(GlId timer) = 0;
    virtual void end_timer(GlId timer) = 0;
    virtual double timer_seconds(GlId timer) = 0;  // waits for it
};

// The device of the context that is current on this thread: for a window. Throws Error{Usage} when
// none is, or when it is older than OpenGL 4.5.
std::unique_ptr<GlDevice> device_of_current_context();

// The device of a context without a window (EGL), made by the first call on a thread, current on it
// and kept until the thread ends. Graphics hardware goes before Mesa's software. Throws
// Error{Usage} with the way to mend it when there is no driver.
GlDevice& offscreen_device();

}  // namespace gischt
