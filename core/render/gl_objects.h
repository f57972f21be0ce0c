// OpenGL's objects as move-only values. They must die before their context.
#pragma once

#include <glad/gl.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "model/error.h"

namespace probewarp {

/// Owns the name of one GL object; `Delete` gives it back.
template <void (*Delete)(GLuint)>
class GlHandle {
  public:
    GlHandle() = default;
    explicit GlHandle(GLuint name) : name_(name) {}
    GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlHandle& operator=(GlHandle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlHandle(const GlHandle&) = delete;
    GlHandle& operator=(const GlHandle&) = delete;
    ~GlHandle() {
        if (name_ != 0) Delete(name_);
    }
    GLuint name() const { return name_; }

  private:
    GLuint name_ = 0;
};

void delete_buffer(GLuint name);
void delete_texture(GLuint name);
void delete_framebuffer(GLuint name);
void delete_vertex_array(GLuint name);
void delete_program(GLuint name);

using GlBuffer = GlHandle<&delete_buffer>;
using GlTexture = GlHandle<&delete_texture>;
using GlFramebuffer = GlHandle<&delete_framebuffer>;
using GlVertexArray = GlHandle<&delete_vertex_array>;
using GlProgram = GlHandle<&delete_program>;

GlBuffer make_buffer();
GlTexture make_texture();
GlVertexArray make_vertex_array();

struct Shader;

/// Compiles and links; `define`, where given, is a name that both shaders see as #defined. Throws Error with
/// the shader's file and the driver's log.
GlProgram make_program(const Shader& vertex, const Shader& fragment, const char* define = nullptr);

/// A program without fragments, whose vertices' output `captured` goes into a buffer. Throws Error likewise.
GlProgram make_feedback_program(const Shader& vertex, const char* captured);

/// A program that is made when it is first wanted: compiling takes its time, and many a run wants few.
class LazyProgram {
  public:
    explicit LazyProgram(GlProgram (*make)()) : make_(make) {}
    /// Throws Error as `make` does.
    const GlProgram& get() {
        if (program_.name() == 0) program_ = make_();
        return program_;
    }

  private:
    GlProgram (*make_)();
    GlProgram program_;
};

/// The place of a uniform; throws Error where the program has none of that name.
GLint uniform(const GlProgram& program, const char* name);

/// A texture that can be drawn into.
struct Target {
    int width = 0, height = 0;
    GLenum format = 0;  ///< internal format: GL_RGBA32F, GL_RGBA8UI, ...
    GlTexture texture;
    GlFramebuffer framebuffer;
};

/// Makes `target` the size and format asked for, keeping it where it already is. Throws Error where the
/// driver cannot draw into it.
void resize(Target& target, int width, int height, GLenum format);

/// Throws Error naming `what` where GL reports one.
void check_gl(const char* what);

}  // namespace probewarp
