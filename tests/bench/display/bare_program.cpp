#include "tests/bench/display/bare_program.hpp"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <GL/glcorearb.h>

#include <array>

namespace cellmirror::bench {

namespace {

constexpr const char* kVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 matrix;
out vec3 shade;
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  float light = 0.3 + 0.7 * max(dot(normalize(normal), vec3(-0.38, -0.45, 0.81)), 0.0);
  shade = vec3(0.7, 0.7, 0.72) * light;
}
)";

constexpr const char* kFragment = R"(#version 330 core
in vec3 shade;
layout(location = 0) out vec4 colour;
void main() { colour = vec4(shade, 1.0); }
)";

// Of the same library as the renderer's, but opened by itself.
template <class Function>
Function entry(const char* name) {
  static void* const kLibrary = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
  return kLibrary == nullptr ? nullptr : reinterpret_cast<Function>(dlsym(kLibrary, name));
}

class OsMesaProgram final : public BareProgram {
 public:
  OsMesaProgram(int width, int height) : width_(width), height_(height) {}

  bool start() {
    const auto create = entry<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    make_current_ = entry<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    if (create == nullptr || make_current_ == nullptr) return false;
    constexpr std::array<int, 9> kWanted = {OSMESA_FORMAT,
                                            OSMESA_RGBA,
                                            OSMESA_PROFILE,
                                            OSMESA_CORE_PROFILE,
                                            OSMESA_CONTEXT_MAJOR_VERSION,
                                            3,
                                            OSMESA_CONTEXT_MINOR_VERSION,
                                            3,
                                            0};
    context_ = create(kWanted.data(), nullptr);
    return context_ != nullptr && current();
  }

  void prepare(const BareMesh& mesh, int samples) {
    GLuint array = 0;
    call<PFNGLGENVERTEXARRAYSPROC>("glGenVertexArrays")(1, &array);
    call<PFNGLBINDVERTEXARRAYPROC>("glBindVertexArray")(array);
    fill(GL_ARRAY_BUFFER, mesh.vertices.data(), mesh.vertices.size() * sizeof(float));
    fill(GL_ELEMENT_ARRAY_BUFFER, mesh.corners.data(), mesh.corners.size() * sizeof(std::uint32_t));
    count_ = static_cast<GLsizei>(mesh.corners.size());
    for (GLuint i = 0; i < 2; ++i) {
      call<PFNGLENABLEVERTEXATTRIBARRAYPROC>("glEnableVertexAttribArray")(i);
      call<PFNGLVERTEXATTRIBPOINTERPROC>("glVertexAttribPointer")(i, 3, GL_FLOAT, GL_FALSE, 24,
                                                                  reinterpret_cast<const void*>(std::size_t{12} * i));
    }
    link();
    frame_ = frame(samples, true);
    if (samples > 0) resolved_ = frame(0, false);
    call<PFNGLENABLEPROC>("glEnable")(GL_DEPTH_TEST);
    call<PFNGLVIEWPORTPROC>("glViewport")(0, 0, width_, height_);
    bind_frame_ = call<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer");
    clear_color_ = call<PFNGLCLEARCOLORPROC>("glClearColor");
    clear_ = call<PFNGLCLEARPROC>("glClear");
    uniform_ = call<PFNGLUNIFORMMATRIX4FVPROC>("glUniformMatrix4fv");
    draw_ = call<decltype(&glDrawElements)>("glDrawElements");
    blit_ = call<PFNGLBLITFRAMEBUFFERPROC>("glBlitFramebuffer");
    read_ = call<PFNGLREADPIXELSPROC>("glReadPixels");
  }

  void draw(const float* matrix, std::vector<std::uint8_t>& rgba) override {
    current();
    bind_frame_(GL_FRAMEBUFFER, frame_);
    clear_color_(0.9F, 0.9F, 0.92F, 1);
    clear_(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    uniform_(0, 1, GL_FALSE, matrix);
    draw_(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    if (resolved_ != 0) {
      bind_frame_(GL_DRAW_FRAMEBUFFER, resolved_);
      blit_(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
      bind_frame_(GL_READ_FRAMEBUFFER, resolved_);
    }
    rgba.resize(std::size_t{4} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    read_(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }

 private:
  template <class Function>
  Function call(const char* name) {
    return reinterpret_cast<Function>(entry<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress")(name));
  }
  bool current() { return make_current_(context_, pixels_.data(), GL_UNSIGNED_BYTE, 16, 16) == GL_TRUE; }

  void fill(GLenum target, const void* data, std::size_t size) {
    GLuint buffer = 0;
    call<PFNGLGENBUFFERSPROC>("glGenBuffers")(1, &buffer);
    call<PFNGLBINDBUFFERPROC>("glBindBuffer")(target, buffer);
    call<PFNGLBUFFERDATAPROC>("glBufferData")(target, static_cast<GLsizeiptr>(size), data, GL_STATIC_DRAW);
  }

  void link() {
    const GLuint program = call<PFNGLCREATEPROGRAMPROC>("glCreateProgram")();
    const auto attach = [&](GLenum stage, const char* source) {
      const GLuint shader = call<PFNGLCREATESHADERPROC>("glCreateShader")(stage);
      call<PFNGLSHADERSOURCEPROC>("glShaderSource")(shader, 1, &source, nullptr);
      call<PFNGLCOMPILESHADERPROC>("glCompileShader")(shader);
      call<PFNGLATTACHSHADERPROC>("glAttachShader")(program, shader);
    };
    attach(GL_VERTEX_SHADER, kVertex);
    attach(GL_FRAGMENT_SHADER, kFragment);
    call<PFNGLLINKPROGRAMPROC>("glLinkProgram")(program);
    call<PFNGLUSEPROGRAMPROC>("glUseProgram")(program);
  }

  GLuint frame(int samples, bool depth) {
    GLuint made = 0;
    call<PFNGLGENFRAMEBUFFERSPROC>("glGenFramebuffers")(1, &made);
    call<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer")(GL_FRAMEBUFFER, made);
    const auto attach = [&](GLenum attachment, GLenum format) {
      GLuint buffer = 0;
      call<PFNGLGENRENDERBUFFERSPROC>("glGenRenderbuffers")(1, &buffer);
      call<PFNGLBINDRENDERBUFFERPROC>("glBindRenderbuffer")(GL_RENDERBUFFER, buffer);
      call<PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC>("glRenderbufferStorageMultisample")(GL_RENDERBUFFER, samples,
                                                                                        format, width_, height_);
      call<PFNGLFRAMEBUFFERRENDERBUFFERPROC>("glFramebufferRenderbuffer")(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER,
                                                                          buffer);
    };
    attach(GL_COLOR_ATTACHMENT0, GL_RGBA8);
    if (depth) attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24);
    return made;
  }

  int width_;
  int height_;
  OSMesaContext context_ = nullptr;
  decltype(&OSMesaMakeCurrent) make_current_ = nullptr;
  std::array<std::uint8_t, 1024> pixels_{};
  GLsizei count_ = 0;
  GLuint frame_ = 0;
  GLuint resolved_ = 0;
  PFNGLBINDFRAMEBUFFERPROC bind_frame_ = nullptr;
  PFNGLCLEARCOLORPROC clear_color_ = nullptr;
  PFNGLCLEARPROC clear_ = nullptr;
  PFNGLUNIFORMMATRIX4FVPROC uniform_ = nullptr;
  decltype(&glDrawElements) draw_ = nullptr;
  PFNGLBLITFRAMEBUFFERPROC blit_ = nullptr;
  PFNGLREADPIXELSPROC read_ = nullptr;
};

}  // namespace

std::unique_ptr<BareProgram> BareProgram::make(const BareMesh& mesh, int width, int height, int samples) {
  auto program = std::make_unique<OsMesaProgram>(width, height);
  if (!program->start()) return nullptr;
  program->prepare(mesh, samples);
  return program;
}

}  // namespace cellmirror::bench
