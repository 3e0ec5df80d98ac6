// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/device.h"

namespace gischt {

// Owns one object of a device, which must outlive it. Empty when default-constructed or moved from.
class GlObject {
  public:
    GlObject() = default;
    GlObject(GlDevice& device, GlKind kind, GlId id) : device_(&device), kind_(kind), id_(id) {}
    ~GlObject() {
        if (device_) device_->destroy(kind_, id_);
    }
    GlObject(GlObject&& other) noexcept
        : device_(std::exchange(other.device_, nullptr)),
          kind_(other.kind_),
          id_(std::exchange(other.id_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(kind_, other.kind_);
        std::swap(id_, other.id_);
        return *this;
    }

    GlId id() const { return id_; }
    bool is_empty() const { return !device_; }
    GlDevice& device() const { return *device_; }

  private:
    GlDevice* device_ = nullptr;
    GlKind kind_ = GlKind::Buffer;
    GlId id_ = 0;
};

// Numbers for shaders, bound as storage.
class GlBuffer : public GlObject {
  public:
    GlBuffer() = default;
    GlBuffer(GlDevice& device, std::size_t bytes, const void* data = nullptr)
        : GlObject(device, GlKind::Buffer, device.create_buffer(bytes, data)), bytes_(bytes) {}
    template <class T>
    GlBuffer(GlDevice& device, const std::vector<T>& values)
        : GlBuffer(device, values.size() * sizeof(T), values.data()) {}

    std::size_t bytes() const { return bytes_; }
    template <class T>
    void write(std::span<const T> values, std::size_t at = 0) {
        device().write_buffer(id(), at * sizeof(T), values.size_bytes(), values.data());
    }
    template <class T>
    std::vector<T> read(std::size_t count) const {
        std::vector<T> values(count);
        device().read_buffer(id(), 0, count * sizeof(T), values.data());
        return values;
    }

  private:
    std::size_t bytes_ = 0;
};

class GlTexture : public GlObject {
  public:
    GlTexture() = default;
    GlTexture(GlDevice& device, const GlTextureSpec& spec, const void* data = nullptr)
        : GlObject(device, GlKind::Texture, device.create_texture(spec)), spec_(spec) {
        if (data) device.write_texture(id(), spec, {}, spec.size, data);
    }

    const GlTextureSpec& spec() const { return spec_; }
    void write(const void* data) { device().write_texture(id(), spec_, {}, spec_.size, data); }
    std::vector<float> read() const {
        std::vector<float> values(volume(spec_.size) *
                                  static_cast<std::size_t>(channels_of(spec_.format)));
        device().read_texture(id(), spec_, values.data());
        return values;
    }
    void bind(int unit) const { device().bind_texture(unit, id()); }
    void bind_image(int unit) const { device().bind_image(unit, id(), spec_.format); }

  private:
    GlTextureSpec spec_;
};

// What is drawn into: colours of 4 floats per pixel, linear radiance with coverage, and a depth.
class GlFramebuffer : public GlObject {
  public:
    GlFramebuffer() = default;
    GlFramebuffer(GlDevice& device, const Vec2i& size, int colors = 1) : size_(size) {
        std::vector<GlId> ids;
        for (int i = 0; i < colors; ++i) {
            colors_.emplace_back(device, GlTextureSpec{GlShape::Flat, GlFormat::Rgba32F,
                                                       Vec3i(size.x, size.y, 1), false});
            ids.push_back(colors_.back().id());
        }
        depth_ = GlTexture(device, GlTextureSpec{GlShape::Flat, GlFormat::Depth32F,
                                                 Vec3i(size.x, size.y, 1), false});
        GlObject::operator=(
            GlObject(device, GlKind::Framebuffer, device.create_framebuffer(ids, depth_.id())));
    }

    const Vec2i& size() const { return size_; }
    const GlTexture& color(int i = 0) const { return colors_[static_cast<std::size_t>(i)]; }
    const GlTexture& depth() const { return depth_; }
    void bind() const { device().set_target(id(), size_); }
    // Four floats per pixel, rows from bottom to top.
    std::vector<float> read() const {
        std::vector<float> rgba(4 * static_cast<std::size_t>(size_.x) *
                                static_cast<std::size_t>(size_.y));
        device().read_pixels(id(), size_, rgba.data());
        return rgba;
    }

  private:
    Vec2i size_;
    std::vector<GlTexture> colors_;
    GlTexture depth_;
};

class GlProgram : public GlObject {
  public:
    GlProgram() = default;
    GlProgram(GlDevice& device, std::string_view name, std::span<const GlStage> stages)
        : GlObject(device, GlKind::Program, device.create_program(name, stages)) {}
    GlProgram(GlDevice& device, std::string_view name, std::initializer_list<GlStage> stages)
        : GlProgram(device, name, std::span(stages.begin(), stages.size())) {}

    void use() const { device().use(id()); }
    // Set before or after use().
    void set(const char* name, const GlValue& value) const { device().set(id(), name, value); }
};

// Seconds that the device was busy between begin and end: hardware time, not that of the calls.
class GlTimer : public GlObject {
  public:
    explicit GlTimer(GlDevice& device) : GlObject(device, GlKind::Timer, device.create_timer()) {}
    void begin() { device().begin_timer(id()); }
    void end() { device().end_timer(id()); }
    double seconds() { return device().timer_seconds(id()); }
};

}  // namespace gischt
