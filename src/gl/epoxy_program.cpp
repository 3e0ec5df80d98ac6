// SPDX-License-Identifier: Apache-2.0
#include "gl/epoxy_program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "base/error.h"

namespace gischt {
namespace {

GLenum word_of(GlStageKind kind) {
    constexpr GLenum words[] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER, GL_COMPUTE_SHADER};
    return words[static_cast<int>(kind)];
}

// The first number of a driver's message that is a line: "0:12(3): error" of Mesa, "0(12) : error"
// of NVIDIA, "ERROR: 0:12:" of others.
std::string line_of(const std::string& log) {
    for (std::size_t i = 0; i + 2 < log.size(); ++i) {
        if (log[i] != '0' || (log[i + 1] != ':' && log[i + 1] != '(')) continue;
        std::size_t end = i + 2;
        while (end < log.size() && std::isdigit(static_cast<unsigned char>(log[end]))) ++end;
        if (end > i + 2) return log.substr(i + 2, end - i - 2);
    }
    return "?";
}

std::string trimmed(std::string log) {
    while (!log.empty() &&
           (log.back() == '\0' || std::isspace(static_cast<unsigned char>(log.back())))) {
        log.pop_back();
    }
    return log;
}

GlId compile(std::string_view name, const GlStage& stage) {
    const GlId shader = glCreateShader(word_of(stage.kind));
    // Lines count from that of the stage's own text.
    const char* texts[] = {"#version 450 core\n#line 1\n", stage.source.c_str()};
    glShaderSource(shader, 2, texts, nullptr);
    glCompileShader(shader);
    GLint is_good = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
    if (is_good) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    glDeleteShader(shader);
    constexpr const char* kinds[] = {"vertex", "fragment", "compute"};
    throw Error(ErrorKind::Internal, fmt::format("{}:{}", name, line_of(log)),
                fmt::format("the {} shader does not compile: {}",
                            kinds[static_cast<int>(stage.kind)], trimmed(log)));
}

}  // namespace

GlId link_program(std::string_view name, std::span<const GlStage> stages) {
    const GlId program = glCreateProgram();
    try {
        for (const GlStage& stage : stages) {
            const GlId shader = compile(name, stage);
            glAttachShader(program, shader);
            glDeleteShader(shader);
        }
    } catch (const Error&) {
        glDeleteProgram(program);
        throw;
    }
    glLinkProgram(program);
    GLint is_good = 0, length = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &is_good);
    if (is_good) return program;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program, length, nullptr, log.data());
    glDeleteProgram(program);
    throw Error(ErrorKind::Internal, std::string(name),
                "the program does not link: " + trimmed(log));
}

}  // namespace gischt
