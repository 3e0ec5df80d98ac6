// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "math/vec.h"

namespace gischt {

// The words of the device's interface (gl/device.h).

// The name of an object of a device; 0 is none, as a framebuffer that of the window.
using GlId = std::uint32_t;

enum class GlFormat { R32F, Rg32F, Rgba32F, R16F, Rgba16F, Rgba8, R32Ui, Depth32F };
int channels_of(GlFormat format);
// Of one texel as it is handed over: floats, unsigned integers for R32Ui, bytes for Rgba8.
std::size_t texel_bytes(GlFormat format);

enum class GlShape { Flat, Volume, Array };

struct GlTextureSpec {
    GlShape shape = GlShape::Flat;
    GlFormat format = GlFormat::Rgba32F;
    Vec3i size{1, 1, 1};       // z: depth of a volume, layers of an array
    bool is_linear = true;     // between texels, else the nearest
    bool is_repeated = false;  // beyond the edge, else the texel at the edge
};

// Factors of the blending equation C = C_src B_src + C_dst B_dst (OpenGL 4.5 core, table 17.2).
// Those with a 1 take the second colour that a fragment shader may write.
enum class BlendFactor {
    Zero,
    One,
    SrcColor,
    OneMinusSrcColor,
    DstColor,
    OneMinusDstColor,
    SrcAlpha,
    OneMinusSrcAlpha,
    DstAlpha,
    OneMinusDstAlpha,
    ConstantColor,
    OneMinusConstantColor,
    ConstantAlpha,
    OneMinusConstantAlpha,
    Src1Color,
    Src1Alpha,
};

struct GlBlend {
    BlendFactor source = BlendFactor::One, destination = BlendFactor::Zero;
    BlendFactor source_alpha = BlendFactor::One, destination_alpha = BlendFactor::Zero;
    std::array<float, 4> constant{};
};

// Depths are reversed: 0 is infinitely far, and the larger is nearer, which spreads the digits of a
// float evenly.
enum class GlDepth { Off, Test, TestAndWrite };

enum class GlPrimitive { Points, Triangles, TriangleStrip };

// One call that draws. Vertices have no attributes: shaders fetch what they need by gl_VertexID.
struct GlDraw {
    GlPrimitive primitive = GlPrimitive::Triangles;
    int first = 0, count = 3, instances = 1;
    GlDepth depth = GlDepth::Off;
    // A buffer of unsigned integers, gl_VertexID of each vertex; 0: they count up. Equal ones near
    // each other are computed once.
    GlId indices = 0;
    std::optional<GlBlend> blend;  // unset: replaces
};

using GlMatrix = std::array<float, 16>;  // columns
using GlValue = std::variant<int, float, Vec2f, Vec3f, Vec3i, std::array<float, 4>, GlMatrix>;

enum class GlStageKind { Vertex, Fragment, Compute };
struct GlStage {
    GlStageKind kind = GlStageKind::Vertex;
    std::string source;  // without #version, which the device puts on top
};

enum class GlKind { Buffer, Texture, Framebuffer, Program, Timer };

struct GlLimits {
    std::string renderer, version;   // as the driver names itself
    int volume_size = 0;             // texels along an edge of a volume
    int flat_size = 0;               // of a flat texture
    float point_size = 1;            // pixels across a point
    std::int64_t storage_bytes = 0;  // of one buffer
    bool is_software = false;        // no graphics hardware: drawn by the processor
};

}  // namespace gischt
