// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "artist.h"
#include "orbit.h"
#include "panel.h"
#include "stage.h"

struct GLFWwindow;

namespace gischt {

struct WindowOptions {
    Vec2i size{1280, 720};
    std::string method;  // of the moving picture; empty: chosen by the scene
    std::vector<std::string> overrides;
};

// The window: shows what Stage and Artist make, and hands them what the user wants. It never waits
// for them, so that it answers at once whatever they do.
class Window {
  public:
    // Throws Error{Usage} where there is no display.
    Window(Stage& stage, Artist& artist, WindowOptions options);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Until the user closes it.
    void run();

  private:
    void frame();
    void take_news();
    void keys();
    void act_on(int key, bool with_control);
    void mouse();
    void stir(Vec2d from, Vec2d to);
    void ask_for_picture();
    void show_picture();
    void controls();
    void time_line();
    void status();
    void fly_home();
    void write_picture(const std::string& name) const;
    void save_picture();
    void save_scene();
    void record();
    void dropped(const std::string& path);
    std::string free_name(const std::string& extension) const;
    Vec2i drawing_size(bool is_moving) const;
    void note(std::string text);

    Stage& stage_;
    Artist& artist_;
    WindowOptions options_;
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<GlDevice> device_;
    ParameterPanel panel_;

    std::shared_ptr<const Snapshot> shot_;
    Value values_;  // of all parameters of the scene
    std::vector<std::string> overrides_;
    Orbit orbit_;
    bool camera_is_set_ = false, has_moved_ = true;
    std::string method_ = "slices", final_method_ = "path";
    bool wants_final_ = true, is_final_asked_ = false, is_sharp_asked_ = false;
    bool is_panel_open_ = true, is_recording_ = false, is_stirring_ = false;
    float brush_ = 0.08f, smoke_ = 0;
    int recorded_ = 0, recorded_frame_ = -1;
    double moved_at_ = 0, cost_ = 0.03;  // s; cost of a picture per million pixels is cost_/pixels_
    double pixels_ = 1e5;

    std::uint64_t wish_ = 0;
    std::shared_ptr<const Picture> picture_;
    GlTexture texture_;
    std::string note_;
    double noted_at_ = 0;
    Vec2d mouse_;
    bool is_down_ = false;  // a button was, in the last frame
    struct Key {
        int key = 0;
        bool with_control = false;
    };
    std::vector<Key> pressed_;  // since the last frame
};

}  // namespace gischt
