#include "render/context.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <array>

#include "render/offscreen.h"

namespace probewarp {

Library::Library(const char* name) : handle_(dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
    if (!handle_) throw Error(fmt::format("{} is not installed", name));
}

void* Library::symbol(const char* name) const {
    void* found = dlsym(handle_, name);
    if (!found) throw Error(fmt::format("the library has no {}", name));
    return found;
}

std::span<const Backend> backends() {
    static constexpr std::array<Backend, 2> all{{{"osmesa", &open_osmesa}, {"egl", &open_egl}}};
    return all;
}

std::unique_ptr<Context> open_context(std::string_view name) {
    std::string lacks;
    for (const Backend& backend : backends()) {
        if (name != "auto" && name != backend.name) continue;
        try {
            return backend.open();
        } catch (const Error& error) {
            lacks += fmt::format("{}{}: {}", lacks.empty() ? "" : "; ", backend.name, error.what());
        }
    }
    if (lacks.empty())
        throw Error(fmt::format("there is no backend named {}; expected auto, osmesa or egl", name));
    throw Error(fmt::format("cannot render without a display ({})", lacks));
}

void load_gl(GlLookUp look_up) {
    // OSMesa's look-up finds a function for any name, so that the version is what counts, not the pointers.
    const int version = gladLoadGL(look_up);
    if (version == 0) throw Error("OpenGL cannot be loaded");
    if (version < GLAD_MAKE_VERSION(3, 3))
        throw Error(fmt::format("OpenGL {}.{} is too old; expected 3.3 or later", GLAD_VERSION_MAJOR(version),
                                GLAD_VERSION_MINOR(version)));
}

std::string renderer_name() {
    const auto* text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    std::string name = text ? text : "unknown";
    return name.substr(
        0, name.find_first_of("(/") == std::string::npos ? name.size() : name.find_first_of("(/") - 1);
}

}  // namespace probewarp
