// EGL without a surface (EGL_KHR_surfaceless_context): Mesa's surfaceless platform, else the first device that can.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstring>
#include <string_view>

#include "drivers/display/internal/gl_context.hpp"
#include "drivers/display/internal/shared_library.hpp"

namespace cellmirror::display {

namespace {

constexpr const char* kRemedy = "apt-get install libegl1 libgl1-mesa-dri";

struct Egl {
  SharedLibrary library{"libEGL.so.1", "libEGL.so"};
  decltype(eglGetProcAddress)* find = nullptr;
  decltype(eglInitialize)* initialize = nullptr;
  decltype(eglBindAPI)* bind_api = nullptr;
  decltype(eglChooseConfig)* choose_config = nullptr;
  decltype(eglCreateContext)* create_context = nullptr;
  decltype(eglDestroyContext)* destroy_context = nullptr;
  decltype(eglMakeCurrent)* make_current = nullptr;
  decltype(eglGetCurrentContext)* current_context = nullptr;
  decltype(eglQueryString)* query_string = nullptr;
  bool complete = library.find(find, "eglGetProcAddress") && library.find(initialize, "eglInitialize") &&
                  library.find(bind_api, "eglBindAPI") && library.find(choose_config, "eglChooseConfig") &&
                  library.find(create_context, "eglCreateContext") &&
                  library.find(destroy_context, "eglDestroyContext") && library.find(make_current, "eglMakeCurrent") &&
                  library.find(current_context, "eglGetCurrentContext") && library.find(query_string, "eglQueryString");
};

const Egl& egl() {
  static const Egl library;
  return library;
}

template <class Function>
Function* extension(const char* name) {
  return reinterpret_cast<Function*>(egl().find(name));
}

bool has(const char* extensions, std::string_view name) {
  return extensions != nullptr && std::string_view(extensions).find(name) != std::string_view::npos;
}

// Displays are never terminated: another context may have come from the same one.
EGLDisplay initialized(EGLDisplay display) {
  EGLint major = 0;
  EGLint minor = 0;
  if (display == EGL_NO_DISPLAY || egl().initialize(display, &major, &minor) != EGL_TRUE) return EGL_NO_DISPLAY;
  return has(egl().query_string(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context") ? display : EGL_NO_DISPLAY;
}

EGLDisplay open_display() {
  auto* const get_display = extension<EGLDisplay(EGLenum, void*, const EGLint*)>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) return EGL_NO_DISPLAY;
  const char* const extensions = egl().query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (has(extensions, "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display = initialized(get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (display != EGL_NO_DISPLAY) return display;
  }
  auto* const query_devices = extension<EGLBoolean(EGLint, EGLDeviceEXT*, EGLint*)>("eglQueryDevicesEXT");
  std::array<EGLDeviceEXT, 8> devices{};
  EGLint count = 0;
  if (query_devices == nullptr || query_devices(EGLint{8}, devices.data(), &count) != EGL_TRUE) return EGL_NO_DISPLAY;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDisplay display =
        initialized(get_display(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    if (display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

class EglContext final : public GlContext {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~EglContext() override {
    forget();
    egl().destroy_context(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  [[nodiscard]] GlProcedure find(const char* name) const override { return egl().find(name); }
  [[nodiscard]] const char* backend() const override { return "EGL"; }

 private:
  bool bind() override { return egl().make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE; }
  [[nodiscard]] bool bound() const override { return egl().current_context() == context_; }
  void release() override { egl().make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

  EGLDisplay display_;
  EGLContext context_;
};

EGLContext create_context(EGLDisplay display) {
  constexpr std::array<EGLint, 5> kConfig = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  constexpr std::array<EGLint, 7> kContext = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (egl().bind_api(EGL_OPENGL_API) != EGL_TRUE) return EGL_NO_CONTEXT;
  if (egl().choose_config(display, kConfig.data(), &config, 1, &count) != EGL_TRUE || count == 0) return EGL_NO_CONTEXT;
  return egl().create_context(display, config, EGL_NO_CONTEXT, kContext.data());
}

}  // namespace

Result<std::unique_ptr<GlContext>> make_egl_context() {
  if (!egl().library.open()) return fail("libEGL is not installed", kRemedy);
  if (!egl().complete) return fail("libEGL lacks functions of EGL 1.4", kRemedy);
  const EGLDisplay display = open_display();
  if (display == EGL_NO_DISPLAY) return fail("EGL has no display without a surface", kRemedy);
  const EGLContext handle = create_context(display);
  if (handle == EGL_NO_CONTEXT) return fail("EGL makes no OpenGL 3.3 core context", kRemedy);
  auto context = std::make_unique<EglContext>(display, handle);
  if (!context->make_current()) return fail("EGL cannot make its context current", kRemedy);
  return context;
}

}  // namespace cellmirror::display
