// SPDX-License-Identifier: Apache-2.0
// What the user does: mouse, keys, widgets.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "scene/bare.h"
#include "schema/toml.h"
#include "window.h"

namespace gischt {
namespace fs = std::filesystem;

void Window::keys() {
    const std::vector<Key> pressed = std::exchange(pressed_, {});
    if (ImGui::GetIO().WantTextInput || !shot_) return;
    for (const Key& k : pressed) act_on(k.key, k.with_control);
}

void Window::act_on(int key, bool with_control) {
    constexpr std::array<const char*, 4> methods{"slices", "gpu_march", "billboards", "points"};
    const int first = shot_->scene->scene.frames.x;
    switch (key) {
        case GLFW_KEY_SPACE:
            return stage_.play(!stage_.is_playing());
        case GLFW_KEY_RIGHT:
            return stage_.seek(shot_->frame + 1);
        case GLFW_KEY_LEFT:
            return stage_.seek(std::max(shot_->frame - 1, first));
        case GLFW_KEY_R:
            return stage_.reset();
        case GLFW_KEY_H:
            return fly_home();
        case GLFW_KEY_S:
            return with_control ? save_scene() : save_picture();
        case GLFW_KEY_TAB:
            is_panel_open_ = !is_panel_open_;
            break;
        case GLFW_KEY_F:
            wants_final_ = !wants_final_;
            has_moved_ = true;
            break;
        case GLFW_KEY_Q:
        case GLFW_KEY_ESCAPE:
            glfwSetWindowShouldClose(window_, 1);
            break;
        default:
            if (key < GLFW_KEY_1 || key > GLFW_KEY_4) break;
            method_ = methods[static_cast<std::size_t>(key - GLFW_KEY_1)];
            has_moved_ = true;
    }
}

// Left button: orbit; with Shift: stir; middle or right button: pan; wheel: dolly.
void Window::mouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const Vec2d before = mouse_;
    mouse_ = {static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y)};
    if (!shot_ || !camera_is_set_) return;
    const bool is_free = !io.WantCaptureMouse;
    const double height = std::max(1.0, static_cast<double>(io.DisplaySize.y));
    const Vec2d way{(mouse_.x - before.x) / height, (mouse_.y - before.y) / height};
    const bool has_way = way.x != 0 || way.y != 0;
    // A button counts from the frame after it went down: the way there is none of its doing.
    const bool was_down = std::exchange(is_down_, ImGui::IsAnyMouseDown());
    const bool left = ImGui::IsMouseDown(0) && is_free && was_down,
               other = (ImGui::IsMouseDown(1) || ImGui::IsMouseDown(2)) && is_free && was_down;
    if (left && io.KeyShift) {
        stir(before, mouse_);
    } else if (is_stirring_) {
        stage_.stir(std::nullopt);
        is_stirring_ = false;
    }
    if (left && !io.KeyShift && has_way) orbit_.turn(-4 * way.x, 4 * way.y), has_moved_ = true;
    if (other && has_way) orbit_.pan(-way.x, way.y), has_moved_ = true;
    if (io.MouseWheel != 0 && is_free) {
        orbit_.dolly(std::pow(0.9, static_cast<double>(io.MouseWheel)));
        has_moved_ = true;
    }
}

// A ball under the mouse that takes the fluid with it, and gives smoke where it is told to.
void Window::stir(Vec2d from, Vec2d to) {
    const ImGuiIO& io = ImGui::GetIO();
    const Vec2i size{static_cast<int>(io.DisplaySize.x), static_cast<int>(io.DisplaySize.y)};
    const Scene& scene = shot_->scene->scene;
    const Camera camera(orbit_.params(), shot_->view.time, size.x, size.y, scene.up_vector());
    const Vec3d here = Orbit::point_at(camera, to, orbit_.target()),
                there = Orbit::point_at(camera, from, orbit_.target());
    const double height = camera.pixel_size(dot(here - camera.position(), camera.forward())) *
                          static_cast<double>(size.y);
    const double dt = std::max(static_cast<double>(io.DeltaTime), 1e-3);
    Vec3d velocity = (here - there) / dt;
    // No faster than once across the picture in a quarter of a second.
    const double speed = length(velocity), most = 4 * height;
    if (speed > most) velocity = velocity * (most / speed);
    EmitterParams hand;
    hand.position = here;
    hand.radius = static_cast<double>(brush_) * height;
    hand.edge = 0.5 * static_cast<double>(brush_) * height;
    hand.velocity = Keyed<Vec3d>(velocity);
    hand.rate = 30.0;
    if (smoke_ > 0) hand.density = Keyed<double>(static_cast<double>(smoke_));
    stage_.stir(hand);
    if (!stage_.is_playing()) stage_.play(true);
    is_stirring_ = true;
}

void Window::controls() {
    ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(330, ImGui::GetIO().DisplaySize.y - 90),
                             ImGuiCond_FirstUseEver);
    ImGui::Begin("gischt");
    if (shot_) {
        if (ImGui::BeginCombo("method", method_.c_str())) {
            for (const MethodInfo& m : render_methods()) {
                const std::string name(m.name);
                if (ImGui::Selectable(name.c_str(), name == method_)) {
                    method_ = name;
                    has_moved_ = true;
                }
                if (ImGui::IsItemHovered()) {
                    ImGui::SetTooltip("%s", std::string(m.simulates).c_str());
                }
            }
            ImGui::EndCombo();
        }
        if (ImGui::Checkbox("final picture when at rest (F)", &wants_final_)) has_moved_ = true;
        ImGui::SliderFloat("brush", &brush_, 0.01f, 0.4f, "%.2f of the picture");
        ImGui::SliderFloat("smoke", &smoke_, 0, 2, "density %.2f");
        if (ImGui::Button("save picture (S)")) save_picture();
        ImGui::SameLine();
        if (ImGui::Button("save scene (Ctrl+S)")) save_scene();
        if (ImGui::Checkbox("record", &is_recording_) && is_recording_) recorded_ = 0;
        ImGui::Separator();
        ImGui::BeginChild("parameters");
        if (panel_.draw(scene_table(), values_, overrides_)) stage_.set_overrides(overrides_);
        ImGui::EndChild();
    }
    ImGui::End();
}

void Window::time_line() {
    const ImVec2 area = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(8, area.y - 74));
    ImGui::SetNextWindowSize(ImVec2(area.x - 16, 0));
    ImGui::Begin("time", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    if (shot_) {
        const bool is_playing = stage_.is_playing();
        if (ImGui::Button(is_playing ? "pause" : "play ")) stage_.play(!is_playing);
        ImGui::SameLine();
        if (ImGui::Button("step")) stage_.seek(shot_->frame + 1);
        ImGui::SameLine();
        if (ImGui::Button("reset")) stage_.reset();
        ImGui::SameLine();
        if (ImGui::Button("home")) fly_home();
        ImGui::SameLine();
        int frame = shot_->frame;
        const Vec2i range = shot_->scene->scene.frames;
        ImGui::SetNextItemWidth(-1);
        const int last = std::max({range.y, shot_->frame, stage_.furthest_frame()});
        if (ImGui::SliderInt("##frame", &frame, range.x, std::max(last, range.x + 1), "frame %d") &&
            frame != shot_->frame) {
            stage_.seek(frame);
        }
    }
}

void Window::status() {
    std::string line;
    if (!shot_) {
        line = stage_.error().empty() ? "opening ..." : stage_.error();
    } else {
        line = fmt::format("frame {}  simulated in {:.0f} ms", shot_->frame, 1e3 * shot_->seconds);
        if (picture_) {
            line += fmt::format("   {} {}x{}  {:.0f} ms", picture_->method, picture_->image.width,
                                picture_->image.height, 1e3 * picture_->seconds);
            if (!picture_->is_whole) line += "  (grows)";
        }
        if (stage_.is_busy()) line += "   working";
        const std::string wrong = stage_.error().empty() ? artist_.error(wish_) : stage_.error();
        if (!wrong.empty()) line += "\n" + wrong;
    }
    if (!note_.empty() && glfwGetTime() - noted_at_ < 5) line += "\n" + note_;
    ImGui::TextUnformatted(line.c_str());
    ImGui::End();
}

// The first name of this kind that is free, in the current folder.
std::string Window::free_name(const std::string& extension) const {
    for (int i = 1;; ++i) {
        const std::string name = fmt::format("{}-{}{}", shot_->scene->name, i, extension);
        if (!fs::exists(name)) return name;
    }
}

// The picture as a file, with what it shows.
void Window::write_picture(const std::string& name) const {
    const Scene& scene = shot_->scene->scene;
    Image image = picture_->image;
    image.metadata.set("scene", shot_->scene->name);
    image.metadata.set("method", picture_->method);
    image.metadata.set("frame", std::to_string(picture_->frame));
    WriteOptions options;
    options.display = {scene.film.tone, scene.film.exposure, true, false};
    write_image(name, image, options);
}

void Window::save_picture() {
    if (!picture_) return;
    try {
        const std::string name = free_name(".png");
        write_picture(name);
        write_picture(fs::path(name).replace_extension(".exr").string());
        note("saved " + name + " and .exr");
    } catch (const Error& e) {
        note(e.what());
    }
}

// The scene with all changes and the camera as it stands.
void Window::save_scene() {
    if (!shot_) return;
    try {
        LoadedScene now = *shot_->scene;
        now.scene.camera = orbit_.params();
        const std::string name = free_name(".toml"),
                          text = to_toml(to_value(now.scene, scene_table()));
        AtomicFile file(name);
        file.write(std::span<const char>(text));
        file.commit();
        note("saved " + name);
    } catch (const Error& e) {
        note(e.what());
    }
}

// Every frame that is shown becomes a file.
void Window::record() {
    if (!picture_ || picture_->frame == recorded_frame_) return;
    recorded_frame_ = picture_->frame;
    try {
        WriteOptions options;
        options.display = {shot_->scene->scene.film.tone, shot_->scene->scene.film.exposure};
        const std::string name = fmt::format("{}_{:04d}.png", shot_->scene->name, picture_->frame);
        write_image(name, picture_->image, options);
        note(fmt::format("recorded {}, {} in all", name, ++recorded_));
    } catch (const Error& e) {
        is_recording_ = false;
        note(e.what());
    }
}

// A volume or scene file dropped on the window.
void Window::dropped(const std::string& path) {
    const std::string extension = fs::path(path).extension().string();
    if (extension != ".vdb" && extension != ".ply" && extension != ".toml") {
        return note(path + ": neither a volume nor a scene");
    }
    camera_is_set_ = false;
    overrides_.clear();
    stage_.open([path, extension](const std::vector<std::string>& overrides, Job& job) {
        if (extension == ".toml") return load_scene(path, "", overrides);
        BareRequest request;
        request.file = path;
        request.overrides = overrides;
        return load_bare(request, job);
    });
}

}  // namespace gischt
