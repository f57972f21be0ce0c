// The OpenGL context: one a process. Offscreen ones are opened here; the window brings its own and only
// loads.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "model/error.h"

namespace probewarp {

/// An offscreen context, current from its making to its end.
struct Context {
    virtual ~Context() = default;
};

struct Backend {
    std::string_view name;  ///< "osmesa": what --backend and PROBEWARP_BACKEND call it
    /// Opens and makes current. Throws Error: a clause on what was lacking.
    std::unique_ptr<Context> (*open)();
};

/// In the order in which `auto` tries them.
std::span<const Backend> backends();

/// Opens the backend of that name, or the first that works for "auto" and loads GL.
/// Throws Error that says what each one lacked.
std::unique_ptr<Context> open_context(std::string_view name);

using GlFunction = void (*)();
using GlLookUp = GlFunction (*)(const char* name);

/// Loads OpenGL into the current context. Throws Error unless it is 3.3 or later.
void load_gl(GlLookUp look_up);

/// The driver's name, in a few words: "llvmpipe", "NVIDIA H200". Needs a loaded context.
std::string renderer_name();

}  // namespace probewarp
