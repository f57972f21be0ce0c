// EGL without a surface: the graphics card, or Mesa's software renderer, with no display server.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstring>
#include <vector>

#include "render/offscreen.h"

namespace probewarp {

namespace {

struct Egl final : Context {
    Library library{"libEGL.so.1"};
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    template <class Function>
    Function function(const char* name) const {
        return library.function<Function>(name);
    }

    /// Mesa's surfaceless platform, then the first device (which is how NVIDIA's driver offers it).
    std::vector<EGLDisplay> candidates() const {
        const auto look_up = function<decltype(&eglGetProcAddress)>("eglGetProcAddress");
        const auto query = function<decltype(&eglQueryString)>("eglQueryString");
        const char* known = query(EGL_NO_DISPLAY, EGL_EXTENSIONS);
        const auto has = [known](const char* name) { return known && std::strstr(known, name); };
        const auto platform =
            reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(look_up("eglGetPlatformDisplayEXT"));
        std::vector<EGLDisplay> found;
        if (!platform) return found;
        if (has("EGL_EXT_platform_device") && has("EGL_EXT_device_enumeration")) {
            const auto devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(look_up("eglQueryDevicesEXT"));
            EGLDeviceEXT device = nullptr;
            EGLint count = 0;
            if (devices && devices(1, &device, &count) && count > 0)
                found.push_back(platform(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
        }
        if (has("EGL_MESA_platform_surfaceless"))
            found.push_back(platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
        return found;
    }

    bool initialise(EGLDisplay candidate) {
        if (candidate == EGL_NO_DISPLAY) return false;
        EGLint major = 0, minor = 0;
        if (!function<decltype(&eglInitialize)>("eglInitialize")(candidate, &major, &minor)) return false;
        function<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API);
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        const EGLint any[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        function<decltype(&eglChooseConfig)>("eglChooseConfig")(candidate, any, &config, 1, &count);
        context = function<decltype(&eglCreateContext)>("eglCreateContext")(
            candidate, count > 0 ? config : nullptr, EGL_NO_CONTEXT, attributes);
        display = candidate;
        const auto make_current = function<decltype(&eglMakeCurrent)>("eglMakeCurrent");
        if (context != EGL_NO_CONTEXT && make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
            return true;
        close();
        return false;
    }

    void close() {
        if (display == EGL_NO_DISPLAY) return;
        function<decltype(&eglMakeCurrent)>("eglMakeCurrent")(display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                                                              EGL_NO_CONTEXT);
        if (context != EGL_NO_CONTEXT)
            function<decltype(&eglDestroyContext)>("eglDestroyContext")(display, context);
        function<decltype(&eglTerminate)>("eglTerminate")(display);
        display = EGL_NO_DISPLAY;
        context = EGL_NO_CONTEXT;
    }

    Egl() {
        bool open = false;
        for (EGLDisplay candidate : candidates())
            if ((open = initialise(candidate))) break;
        if (!open) throw Error("EGL has no display without a surface that offers OpenGL 3.3 core");
        try {
            load_gl(function<GlLookUp>("eglGetProcAddress"));
        } catch (...) {
            close();
            throw;
        }
    }
    ~Egl() override { close(); }
};

}  // namespace

std::unique_ptr<Context> open_egl() { return std::make_unique<Egl>(); }

}  // namespace probewarp
