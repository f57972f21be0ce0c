// The offscreen contexts, and how they open their libraries: at run time, since either may be missing.
#pragma once

#include <dlfcn.h>

#include <memory>

#include "render/context.h"

namespace probewarp {

std::unique_ptr<Context> open_osmesa();
std::unique_ptr<Context> open_egl();

/// A shared library that stays open for the life of the process: drivers do not survive being unloaded.
class Library {
  public:
    /// Throws Error naming the library.
    explicit Library(const char* name);

    /// The function of that name. Throws Error naming it.
    template <class Function>
    Function function(const char* name) const {
        return reinterpret_cast<Function>(symbol(name));
    }

  private:
    void* symbol(const char* name) const;
    void* handle_ = nullptr;
};

}  // namespace probewarp
