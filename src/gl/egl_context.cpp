// SPDX-License-Identifier: Apache-2.0
#include <epoxy/egl.h>

#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "gl/device.h"

namespace gischt {
namespace {

bool has_word(const char* list, const char* word) {
    if (!list) return false;
    const std::size_t n = std::strlen(word);
    for (const char* at = list; (at = std::strstr(at, word)); at += n) {
        const bool begins = at == list || at[-1] == ' ';
        if (begins && (at[n] == ' ' || at[n] == '\0')) return true;
    }
    return false;
}

// The displays that need no window system, graphics hardware first.
std::vector<EGLDisplay> displays() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    std::vector<EGLDisplay> hardware, software, all;
    if (has_word(client, "EGL_EXT_platform_device") && has_word(client, "EGL_EXT_device_base")) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (eglQueryDevicesEXT(16, devices, &count)) {
            for (int i = 0; i < count; ++i) {
                const char* words = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
                auto& list = has_word(words, "EGL_MESA_device_software") ? software : hardware;
                list.push_back(
                    eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
            }
        }
    }
    all = hardware;
    if (has_word(client, "EGL_MESA_platform_surfaceless")) {
        all.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    }
    all.insert(all.end(), software.begin(), software.end());
    return all;
}

// A context without a surface and its device.
class EglContext {
  public:
    EglContext() {
        if (!epoxy_has_egl()) fail("there is no EGL on this machine");
        for (const EGLDisplay display : displays()) {
            if (try_display(display)) return;
        }
        fail("no driver offers OpenGL 4.5 without a window");
    }
    ~EglContext() {
        make_current();
        device_.reset();
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    GlDevice& device() {
        if (eglGetCurrentContext() != context_) make_current();
        return *device_;
    }

  private:
    [[noreturn]] static void fail(const std::string& what) {
        throw Error(ErrorKind::Usage, "OpenGL", what,
                    "install libegl1 and libgl1-mesa-dri, which draw by the processor where there "
                    "is no graphics card");
    }
    bool make_current() {
        return eglBindAPI(EGL_OPENGL_API) &&
               eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    }
    bool try_display(EGLDisplay display) {
        if (!display || !eglInitialize(display, nullptr, nullptr)) return false;
        const char* words = eglQueryString(display, EGL_EXTENSIONS);
        if (!has_word(words, "EGL_KHR_surfaceless_context") || !eglBindAPI(EGL_OPENGL_API)) {
            return false;
        }
        EGLConfig config = nullptr;
        if (!has_word(words, "EGL_KHR_no_config_context")) {
            const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                     EGL_OPENGL_BIT, EGL_NONE};
            EGLint count = 0;
            if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) return false;
        }
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        display_ = display;
        context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
        if (!context_) return false;
        if (make_current()) device_ = device_of_current_context();
        if (!device_) eglDestroyContext(display, context_);
        return device_ != nullptr;
    }

    EGLDisplay display_ = nullptr;
    EGLContext context_ = nullptr;
    std::unique_ptr<GlDevice> device_;
};

}  // namespace

GlDevice& offscreen_device() {
    // Contexts belong to threads, so this is one.
    thread_local EglContext context;
    return context.device();
}

}  // namespace gischt
