// SPDX-License-Identifier: Apache-2.0
// The window's loop: pictures in, wishes out.
#include "window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/display.h"

namespace gischt {
namespace {

std::string glfw_says;

void keep_error(int, const char* text) {
    glfw_says = text;
}

// Of a scene with particles their own method, else slices.
std::string method_for(const Snapshot& shot) {
    for (const auto& frame : shot.view.frames) {
        if (frame && !frame->particles.empty()) return "billboards";
    }
    return "slices";
}

}  // namespace

Window::Window(Stage& stage, Artist& artist, WindowOptions options)
    : stage_(stage), artist_(artist), options_(std::move(options)) {
    glfwSetErrorCallback(keep_error);
    const auto fail = [&] {
        throw Error(ErrorKind::Usage, "view",
                    "there is no display to open a window on: " + glfw_says,
                    "set DISPLAY, or make pictures with `gischt render`");
    };
    if (!glfwInit()) fail();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(options_.size.x, options_.size.y, "gischt", nullptr, nullptr);
    if (!window_) {
        glfwTerminate();
        fail();
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        if (count > 0) static_cast<Window*>(glfwGetWindowUserPointer(w))->dropped(paths[0]);
    });
    // Kept here, as a key that goes down and up between two frames would be lost otherwise. Dear
    // ImGui calls what was there before it.
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int with) {
        if (action == GLFW_RELEASE) return;
        static_cast<Window*>(glfwGetWindowUserPointer(w))
            ->pressed_.push_back({key, (with & GLFW_MOD_CONTROL) != 0});
    });
    device_ = device_of_current_context();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 450");
    overrides_ = options_.overrides;
}

Window::~Window() {
    texture_ = GlTexture();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    device_.reset();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::run() {
    while (!glfwWindowShouldClose(window_)) {
        // Wakes up for input at once, else often enough to see what has become ready.
        glfwWaitEventsTimeout(0.015);
        frame();
    }
}

void Window::frame() {
    take_news();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    keys();
    mouse();
    show_picture();
    if (is_panel_open_) controls();
    time_line();
    status();
    ImGui::Render();
    ask_for_picture();

    Vec2i size;
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    device_->set_target(0, size);
    device_->clear_color(0, {0.05f, 0.05f, 0.06f, 1});
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
}

// Takes what stage and artist have made in the meantime.
void Window::take_news() {
    if (const auto shot = stage_.latest(); shot && shot != shot_) {
        const bool is_other = !shot_ || shot_->scene != shot->scene;
        const bool is_first = !camera_is_set_;
        shot_ = shot;
        has_moved_ = true;
        if (is_other) values_ = to_value(shot->scene->scene, scene_table());
        if (is_first) {
            fly_home();
            method_ = options_.method.empty() ? method_for(*shot) : options_.method;
            glfwSetWindowTitle(window_, ("gischt: " + shot->scene->name).c_str());
        }
    }
    const auto picture = artist_.take();
    if (!picture) return;
    picture_ = picture;
    if (is_realtime(picture->method)) {
        cost_ = picture->seconds;
        pixels_ = static_cast<double>(picture->image.pixel_count());
    }
    const Scene& scene = shot_->scene->scene;
    const std::vector<std::uint8_t> rgb =
        to_rgb8(picture->image, {scene.film.tone, scene.film.exposure, true, false});
    std::vector<std::uint8_t> rgba(rgb.size() / 3 * 4, 255);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgba[i / 3 * 4 + i % 3] = rgb[i];
    const Vec3i size(picture->image.width, picture->image.height, 1);
    if (texture_.is_empty() || texture_.spec().size != size) {
        texture_ = GlTexture(*device_, {GlShape::Flat, GlFormat::Rgba8, size, true});
    }
    texture_.write(rgba.data());
    if (is_recording_) record();
}

// As many pixels as are drawn in a twelfth of a second while something moves.
Vec2i Window::drawing_size(bool is_moving) const {
    Vec2i full;
    glfwGetFramebufferSize(window_, &full.x, &full.y);
    full.x = std::max(full.x, 16);
    full.y = std::max(full.y, 16);
    if (!is_moving) return full;
    constexpr double affordable = 1.0 / 12;
    const double share = std::clamp(
        std::sqrt(affordable * pixels_ / std::max(cost_, 1e-4) / (full.x * full.y)), 0.15, 1.0);
    const double step = std::floor(share * 8) / 8;  // few different sizes: textures are kept
    const double s = std::max(step, 0.15);
    return {static_cast<int>(full.x * s), static_cast<int>(full.y * s)};
}

// What is moving is drawn coarsely; what rests is drawn whole, and then traced to the end.
void Window::ask_for_picture() {
    if (!shot_) return;
    const double now = glfwGetTime();
    PictureWish wish{shot_, orbit_.params(), drawing_size(true), method_, 1};
    const bool is_playing = stage_.is_playing();
    if (is_playing && is_final_asked_) {  // leaves the processor to the simulation
        artist_.rest();
        is_final_asked_ = false;
        wish_ = 0;
    }
    if (has_moved_) {
        // Wait for the picture under way: a new wish would only push it aside.
        if (wish_ != 0 && picture_ && picture_->wish != wish_ && is_realtime(method_) &&
            !is_final_asked_ && artist_.error(wish_).empty()) {
            return;
        }
        wish_ = artist_.wish(std::move(wish));
        has_moved_ = is_final_asked_ = is_sharp_asked_ = false;
        moved_at_ = now;
    } else if (!is_sharp_asked_ && now - moved_at_ > 0.2 && !is_playing) {
        wish.size = drawing_size(false);
        if (!is_realtime(method_)) wish.samples = shot_->scene->scene.render.spp;
        wish_ = artist_.wish(std::move(wish));
        is_sharp_asked_ = true;
    } else if (wants_final_ && is_sharp_asked_ && !is_final_asked_ && !is_playing && picture_ &&
               (picture_->wish == wish_ || !artist_.error(wish_).empty()) &&
               now - moved_at_ > 0.8) {
        wish.size = drawing_size(false);
        wish.method = final_method_;
        wish.samples = 1 << 16;
        wish_ = artist_.wish(std::move(wish));
        is_final_asked_ = true;
    }
}

void Window::show_picture() {
    if (texture_.is_empty()) return;
    const ImVec2 area = ImGui::GetIO().DisplaySize;
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture_.id())), ImVec2(0, 0),
        area);
}

void Window::fly_home() {
    orbit_ = Orbit(shot_->camera, shot_->view.time, shot_->scene->scene.up_vector());
    camera_is_set_ = has_moved_ = true;
}

void Window::note(std::string text) {
    note_ = std::move(text);
    noted_at_ = glfwGetTime();
}

}  // namespace gischt
