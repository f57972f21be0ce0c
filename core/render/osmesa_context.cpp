// OSMesa: Mesa's software renderer without a display (gone from Mesa 25.1 on).
#include <GL/osmesa.h>

#include <array>

#include "render/offscreen.h"

namespace probewarp {

namespace {

struct OSMesa final : Context {
    Library library{"libOSMesa.so.8"};
    OSMesaContext context = nullptr;
    // OSMesa insists on a colour buffer of its own; everything is drawn into framebuffers of ours instead.
    std::array<unsigned char, 16 * 16 * 4> unused{};

    OSMesa() {
        const auto create =
            library.function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
        const auto make_current = library.function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  3,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context = create(attributes, nullptr);
        if (!context) throw Error("OSMesa has no OpenGL 3.3 core");
        if (!make_current(context, unused.data(), GL_UNSIGNED_BYTE, 16, 16)) {
            destroy();
            throw Error("OSMesa's context cannot be made current");
        }
        try {
            load_gl(library.function<GlLookUp>("OSMesaGetProcAddress"));
        } catch (...) {
            destroy();
            throw;
        }
    }
    ~OSMesa() override { destroy(); }

    void destroy() { library.function<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")(context); }
};

}  // namespace

std::unique_ptr<Context> open_osmesa() { return std::make_unique<OSMesa>(); }

}  // namespace probewarp
