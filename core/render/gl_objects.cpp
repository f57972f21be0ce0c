#include "render/gl_objects.h"

#include <fmt/format.h>

#include <shaders/embedded.h>

namespace probewarp {

void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
void delete_program(GLuint name) { glDeleteProgram(name); }

namespace {

void delete_shader(GLuint name) { glDeleteShader(name); }
using GlShader = GlHandle<&delete_shader>;

GLuint generated(void (*generate)(GLsizei, GLuint*)) {
    GLuint name = 0;
    generate(1, &name);
    return name;
}

GlShader compiled(GLenum stage, const Shader& shader, const char* define) {
    GlShader handle(glCreateShader(stage));
    // GLSL wants #version in the first line, before any definition.
    const std::size_t line = shader.source.find('\n') + 1;
    const std::string defined = define ? fmt::format("#define {}\n", define) : std::string();
    const char* const texts[] = {shader.source.data(), defined.data(), shader.source.data() + line};
    const GLint lengths[] = {GLint(line), GLint(defined.size()), GLint(shader.source.size() - line)};
    glShaderSource(handle.name(), 3, texts, lengths);
    glCompileShader(handle.name());
    GLint good = GL_FALSE;
    glGetShaderiv(handle.name(), GL_COMPILE_STATUS, &good);
    if (good != GL_TRUE) {
        std::string log(4096, '\0');
        GLsizei written = 0;
        glGetShaderInfoLog(handle.name(), GLsizei(log.size()), &written, log.data());
        log.resize(std::size_t(written));
        throw Error(fmt::format("{}: the graphics driver cannot compile it: {}", shader.file, log));
    }
    return handle;
}

void link(const GlProgram& program, const std::string& files) {
    glLinkProgram(program.name());
    GLint good = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &good);
    if (good == GL_TRUE) return;
    std::string log(4096, '\0');
    GLsizei written = 0;
    glGetProgramInfoLog(program.name(), GLsizei(log.size()), &written, log.data());
    log.resize(std::size_t(written));
    throw Error(fmt::format("{}: the graphics driver cannot link: {}", files, log));
}

}  // namespace

GlBuffer make_buffer() { return GlBuffer(generated(glGenBuffers)); }
GlTexture make_texture() { return GlTexture(generated(glGenTextures)); }
GlVertexArray make_vertex_array() { return GlVertexArray(generated(glGenVertexArrays)); }

GlProgram make_program(const Shader& vertex, const Shader& fragment, const char* define) {
    const auto first = compiled(GL_VERTEX_SHADER, vertex, define);
    const auto second = compiled(GL_FRAGMENT_SHADER, fragment, define);
    GlProgram program(glCreateProgram());
    glAttachShader(program.name(), first.name());
    glAttachShader(program.name(), second.name());
    link(program, fmt::format("{} with {}", vertex.file, fragment.file));
    return program;
}

GlProgram make_feedback_program(const Shader& vertex, const char* captured) {
    const auto shader = compiled(GL_VERTEX_SHADER, vertex, nullptr);
    GlProgram program(glCreateProgram());
    glAttachShader(program.name(), shader.name());
    glTransformFeedbackVaryings(program.name(), 1, &captured, GL_INTERLEAVED_ATTRIBS);
    link(program, std::string(vertex.file));
    return program;
}

GLint uniform(const GlProgram& program, const char* name) {
    const GLint place = glGetUniformLocation(program.name(), name);
    if (place < 0) throw Error(fmt::format("a shader has no uniform named {}", name));
    return place;
}

void resize(Target& target, int width, int height, GLenum format) {
    if (target.width == width && target.height == height && target.format == format) return;
    const bool integer = format == GL_RGBA8UI || format == GL_RGBA16UI;
    target.texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, target.texture.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GLint(format), width, height, 0, integer ? GL_RGBA_INTEGER : GL_RGBA,
                 integer ? GL_UNSIGNED_BYTE : GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    target.framebuffer = GlFramebuffer(generated(glGenFramebuffers));
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture.name(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("the graphics driver cannot draw into a {} x {} target of format 0x{:x}",
                                width, height, format));
    target.width = width;
    target.height = height;
    target.format = format;
}

void check_gl(const char* what) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    while (glGetError() != GL_NO_ERROR) {
    }
    if (error == GL_OUT_OF_MEMORY)
        throw Error(fmt::format("{}: the graphics driver ran out of memory", what));
    throw Error(fmt::format("{}: the graphics driver reports error 0x{:x}", what, error));
}

}  // namespace probewarp
