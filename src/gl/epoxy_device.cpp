// SPDX-License-Identifier: Apache-2.0
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "base/error.h"
#include "gl/device.h"
#include "gl/epoxy_program.h"

namespace gischt {
namespace {

struct FormatWords {
    GLenum internal, order, type;
};

FormatWords words_of(GlFormat format) {
    switch (format) {
        case GlFormat::R32F:
            return {GL_R32F, GL_RED, GL_FLOAT};
        case GlFormat::Rg32F:
            return {GL_RG32F, GL_RG, GL_FLOAT};
        case GlFormat::Rgba32F:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
        case GlFormat::R16F:
            return {GL_R16F, GL_RED, GL_FLOAT};
        case GlFormat::Rgba16F:
            return {GL_RGBA16F, GL_RGBA, GL_FLOAT};
        case GlFormat::Rgba8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
        case GlFormat::R32Ui:
            return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
        case GlFormat::Depth32F:
            return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
    }
    return {};
}

GLenum word_of(GlShape shape) {
    constexpr GLenum words[] = {GL_TEXTURE_2D, GL_TEXTURE_3D, GL_TEXTURE_2D_ARRAY};
    return words[static_cast<int>(shape)];
}

GLenum word_of(BlendFactor factor) {
    constexpr GLenum words[] = {GL_ZERO,           GL_ONE,
                                GL_SRC_COLOR,      GL_ONE_MINUS_SRC_COLOR,
                                GL_DST_COLOR,      GL_ONE_MINUS_DST_COLOR,
                                GL_SRC_ALPHA,      GL_ONE_MINUS_SRC_ALPHA,
                                GL_DST_ALPHA,      GL_ONE_MINUS_DST_ALPHA,
                                GL_CONSTANT_COLOR, GL_ONE_MINUS_CONSTANT_COLOR,
                                GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA,
                                GL_SRC1_COLOR,     GL_SRC1_ALPHA};
    return words[static_cast<int>(factor)];
}

GLenum word_of(GlPrimitive primitive) {
    constexpr GLenum words[] = {GL_POINTS, GL_TRIANGLES, GL_TRIANGLE_STRIP};
    return words[static_cast<int>(primitive)];
}

void check_memory(const char* what) {
    if (glGetError() == GL_OUT_OF_MEMORY) {
        throw Error(ErrorKind::Resource, "OpenGL", fmt::format("no memory for a {}", what),
                    "take a lower resolution");
    }
}

class EpoxyDevice : public GlDevice {
  public:
    EpoxyDevice() {
        if (epoxy_gl_version() < 45) {
            throw Error(ErrorKind::Usage, "OpenGL",
                        fmt::format("4.5 is needed, the driver has {}.{}", epoxy_gl_version() / 10,
                                    epoxy_gl_version() % 10),
                        "install libgl1-mesa-dri, which draws by the processor");
        }
        const auto text = [](GLenum name) {
            return std::string(reinterpret_cast<const char*>(glGetString(name)));
        };
        limits_.renderer = text(GL_RENDERER);
        limits_.version = text(GL_VERSION);
        limits_.is_software = limits_.renderer.find("llvmpipe") != std::string::npos ||
                              limits_.renderer.find("softpipe") != std::string::npos;
        glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limits_.volume_size);
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limits_.flat_size);
        float points[2] = {1, 1};
        glGetFloatv(GL_POINT_SIZE_RANGE, points);
        limits_.point_size = points[1];
        glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limits_.storage_bytes);
        glCreateVertexArrays(1, &no_attributes_);
        glBindVertexArray(no_attributes_);
        // Reversed depth: the matrices give 0 at infinity and up to 1 near the eye.
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glDepthFunc(GL_GEQUAL);
        glEnable(GL_PROGRAM_POINT_SIZE);
        glDisable(GL_DITHER);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    }
    ~EpoxyDevice() override { glDeleteVertexArrays(1, &no_attributes_); }

    const GlLimits& limits() const override { return limits_; }

    GlId create_buffer(std::size_t bytes, const void* data) override {
        if (static_cast<std::int64_t>(bytes) > limits_.storage_bytes) {
            throw Error(
                ErrorKind::Resource, "OpenGL",
                fmt::format("a buffer of {} MB is more than the driver takes", bytes >> 20));
        }
        GlId id = 0;
        glCreateBuffers(1, &id);
        // A buffer of nothing is not allowed; one larger than its data is filled afterwards.
        constexpr std::size_t least = 16;
        glNamedBufferStorage(id, static_cast<GLsizeiptr>(std::max(bytes, least)),
                             bytes < least ? nullptr : data, GL_DYNAMIC_STORAGE_BIT);
        if (data && bytes > 0 && bytes < least) {
            glNamedBufferSubData(id, 0, static_cast<GLsizeiptr>(bytes), data);
        }
        check_memory("buffer");
        return id;
    }
    void write_buffer(GlId buffer, std::size_t at, std::size_t bytes, const void* data) override {
        glNamedBufferSubData(buffer, static_cast<GLintptr>(at), static_cast<GLsizeiptr>(bytes),
                             data);
    }
    void read_buffer(GlId buffer, std::size_t at, std::size_t bytes, void* data) override {
        glGetNamedBufferSubData(buffer, static_cast<GLintptr>(at), static_cast<GLsizeiptr>(bytes),
                                data);
    }

    GlId create_texture(const GlTextureSpec& spec) override {
        const int most = spec.shape == GlShape::Volume ? limits_.volume_size : limits_.flat_size;
        if (max_component(spec.size) > most || min_component(spec.size) < 1) {
            throw Error(ErrorKind::Usage, "OpenGL",
                        fmt::format("a texture of {}x{}x{} is asked for, a side has 1 to {} texels",
                                    spec.size.x, spec.size.y, spec.size.z, most),
                        "take a lower resolution");
        }
        GlId id = 0;
        const GLenum target = word_of(spec.shape), internal = words_of(spec.format).internal;
        glCreateTextures(target, 1, &id);
        if (spec.shape == GlShape::Flat) {
            glTextureStorage2D(id, 1, internal, spec.size.x, spec.size.y);
        } else {
            glTextureStorage3D(id, 1, internal, spec.size.x, spec.size.y, spec.size.z);
        }
        check_memory("texture");
        const GLint filter = spec.is_linear ? GL_LINEAR : GL_NEAREST;
        const GLint wrap = spec.is_repeated ? GL_REPEAT : GL_CLAMP_TO_EDGE;
        glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, filter);
        glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, filter);
        constexpr GLenum sides[] = {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R};
        for (const GLenum side : sides) {
            glTextureParameteri(id, side, wrap);
        }
        return id;
    }
    void write_texture(GlId texture, const GlTextureSpec& spec, const Vec3i& at, const Vec3i& size,
                       const void* data) override {
        const FormatWords w = words_of(spec.format);
        if (spec.shape == GlShape::Flat) {
            glTextureSubImage2D(texture, 0, at.x, at.y, size.x, size.y, w.order, w.type, data);
        } else {
            glTextureSubImage3D(texture, 0, at.x, at.y, at.z, size.x, size.y, size.z, w.order,
                                w.type, data);
        }
    }
    void read_texture(GlId texture, const GlTextureSpec& spec, void* data) override {
        const FormatWords w = words_of(spec.format);
        const std::size_t bytes = volume(spec.size) * texel_bytes(spec.format);
        glGetTextureImage(texture, 0, w.order, w.type, static_cast<GLsizei>(bytes), data);
    }

    GlId create_framebuffer(std::span<const GlId> colors, GlId depth) override {
        GlId id = 0;
        glCreateFramebuffers(1, &id);
        std::vector<GLenum> buffers;
        for (std::size_t i = 0; i < colors.size(); ++i) {
            buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
            glNamedFramebufferTexture(id, buffers.back(), colors[i], 0);
        }
        glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(buffers.size()), buffers.data());
        if (depth) glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth, 0);
        const GLenum status = glCheckNamedFramebufferStatus(id, GL_FRAMEBUFFER);
        if (status != GL_FRAMEBUFFER_COMPLETE) {
            glDeleteFramebuffers(1, &id);
            throw Error(ErrorKind::Internal, "OpenGL",
                        fmt::format("the framebuffer is incomplete: {:#x}", status));
        }
        return id;
    }
    void read_pixels(GlId framebuffer, const Vec2i& size, float* rgba) override {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
        if (framebuffer) glNamedFramebufferReadBuffer(framebuffer, GL_COLOR_ATTACHMENT0);
        glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, rgba);
    }

    GlId create_program(std::string_view name, std::span<const GlStage> stages) override;
    GlId create_timer() override {
        // Two time stamps: llvmpipe (Mesa 22) leaves out the start of GL_TIME_ELAPSED.
        GLuint ids[2] = {};
        glCreateQueries(GL_TIMESTAMP, 2, ids);
        timer_ends_[ids[0]] = ids[1];
        return ids[0];
    }
    void destroy(GlKind kind, GlId id) override {
        switch (kind) {
            case GlKind::Buffer:
                glDeleteBuffers(1, &id);
                break;
            case GlKind::Texture:
                glDeleteTextures(1, &id);
                break;
            case GlKind::Framebuffer:
                glDeleteFramebuffers(1, &id);
                break;
            case GlKind::Program:
                break;  // kept
            case GlKind::Timer:
                glDeleteQueries(1, &id);
                break;
        }
    }

    void set_target(GlId framebuffer, const Vec2i& size) override {
        target_ = framebuffer;
        target_size_ = size;
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, size.x, size.y);
    }
    void set_margin(int pixels) override {
        glViewport(-pixels, -pixels, target_size_.x + 2 * pixels, target_size_.y + 2 * pixels);
    }
    void clear_color(int attachment, const std::array<float, 4>& value) override {
        glClearNamedFramebufferfv(target_, GL_COLOR, attachment, value.data());
    }
    void clear_depth(float depth) override {
        glDepthMask(GL_TRUE);
        glClearNamedFramebufferfv(target_, GL_DEPTH, 0, &depth);
    }

    void use(GlId program) override { glUseProgram(program); }
    void set(GlId program, const char* name, const GlValue& value) override;
    void bind_texture(int unit, GlId texture) override {
        glBindTextureUnit(static_cast<GLuint>(unit), texture);
    }
    void bind_image(int unit, GlId texture, GlFormat format) override {
        glBindImageTexture(static_cast<GLuint>(unit), texture, 0, GL_TRUE, 0, GL_READ_WRITE,
                           words_of(format).internal);
    }
    void bind_storage(int slot, GlId buffer) override {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(slot), buffer);
    }

    void draw(const GlDraw& draw) override;
    void dispatch(const Vec3i& groups) override {
        glDispatchCompute(static_cast<GLuint>(groups.x), static_cast<GLuint>(groups.y),
                          static_cast<GLuint>(groups.z));
    }
    void barrier() override { glMemoryBarrier(GL_ALL_BARRIER_BITS); }
    void finish() override { glFinish(); }

    void begin_timer(GlId timer) override {
        glQueryCounter(timer, GL_TIMESTAMP);
        // llvmpipe stamps a batch of work when it is done with all of it.
        if (limits_.is_software) glFinish();
    }
    void end_timer(GlId timer) override { glQueryCounter(timer_ends_.at(timer), GL_TIMESTAMP); }
    double timer_seconds(GlId timer) override {
        GLuint64 begin = 0, end = 0;
        glGetQueryObjectui64v(timer, GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(timer_ends_.at(timer), GL_QUERY_RESULT, &end);
        return end > begin ? 1e-9 * static_cast<double>(end - begin) : 0;
    }

  private:
    GlLimits limits_;
    GlId no_attributes_ = 0, target_ = 0;
    Vec2i target_size_;
    std::map<std::pair<GlId, std::string>, GLint> locations_;
    std::map<std::string, GlId> programs_;  // by their whole text
    std::map<GlId, GlId> timer_ends_;       // the second stamp of each
};

GlId EpoxyDevice::create_program(std::string_view name, std::span<const GlStage> stages) {
    std::string text;
    for (const GlStage& s : stages)
        text += fmt::format("{} {}\n", static_cast<int>(s.kind), s.source);
    GlId& kept = programs_[text];
    if (!kept) kept = link_program(name, stages);
    return kept;
}

void EpoxyDevice::set(GlId program, const char* name, const GlValue& value) {
    const auto [entry, is_new] = locations_.try_emplace({program, name}, -1);
    if (is_new) entry->second = glGetUniformLocation(program, name);
    const GLint at = entry->second;
    if (at < 0) return;
    struct Setter {
        GlId program;
        GLint at;
        void operator()(int v) const { glProgramUniform1i(program, at, v); }
        void operator()(float v) const { glProgramUniform1f(program, at, v); }
        void operator()(const Vec2f& v) const { glProgramUniform2f(program, at, v.x, v.y); }
        void operator()(const Vec3f& v) const { glProgramUniform3f(program, at, v.x, v.y, v.z); }
        void operator()(const Vec3i& v) const { glProgramUniform3i(program, at, v.x, v.y, v.z); }
        void operator()(const std::array<float, 4>& v) const {
            glProgramUniform4fv(program, at, 1, v.data());
        }
        void operator()(const GlMatrix& v) const {
            glProgramUniformMatrix4fv(program, at, 1, GL_FALSE, v.data());
        }
    };
    std::visit(Setter{program, at}, value);
}

void EpoxyDevice::draw(const GlDraw& draw) {
    (draw.blend ? glEnable : glDisable)(GL_BLEND);
    if (draw.blend) {
        const GlBlend& b = *draw.blend;
        glBlendFuncSeparate(word_of(b.source), word_of(b.destination), word_of(b.source_alpha),
                            word_of(b.destination_alpha));
        glBlendColor(b.constant[0], b.constant[1], b.constant[2], b.constant[3]);
    }
    (draw.depth == GlDepth::Off ? glDisable : glEnable)(GL_DEPTH_TEST);
    glDepthMask(draw.depth == GlDepth::TestAndWrite ? GL_TRUE : GL_FALSE);
    if (!draw.indices) {
        glDrawArraysInstanced(word_of(draw.primitive), draw.first, draw.count, draw.instances);
        return;
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, draw.indices);
    const auto* first = reinterpret_cast<const void*>(4 * static_cast<std::uintptr_t>(draw.first));
    glDrawElementsInstanced(word_of(draw.primitive), draw.count, GL_UNSIGNED_INT, first,
                            draw.instances);
}

}  // namespace

std::unique_ptr<GlDevice> device_of_current_context() {
    return std::make_unique<EpoxyDevice>();
}

}  // namespace gischt
