// OSMesa: a context whose default framebuffer is memory of ours. We draw into framebuffer objects and only lend it a
// small piece, since a context cannot be current without one.
#include <GL/osmesa.h>

#include <array>
#include <cstdint>

#include "drivers/display/internal/gl_context.hpp"
#include "drivers/display/internal/shared_library.hpp"

namespace cellmirror::display {

namespace {

struct OsMesa {
  SharedLibrary library{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
  decltype(OSMesaCreateContextAttribs)* create = nullptr;
  decltype(OSMesaDestroyContext)* destroy = nullptr;
  decltype(OSMesaMakeCurrent)* make_current = nullptr;
  decltype(OSMesaGetCurrentContext)* current = nullptr;
  decltype(OSMesaGetProcAddress)* find = nullptr;
  bool complete = library.find(create, "OSMesaCreateContextAttribs") && library.find(destroy, "OSMesaDestroyContext") &&
                  library.find(make_current, "OSMesaMakeCurrent") && library.find(current, "OSMesaGetCurrentContext") &&
                  library.find(find, "OSMesaGetProcAddress");
};

const OsMesa& osmesa() {
  static const OsMesa library;
  return library;
}

class OsMesaContext final : public GlContext {
 public:
  explicit OsMesaContext(OSMesaContext context) : context_(context) {}
  ~OsMesaContext() override {
    forget();
    osmesa().destroy(context_);
  }
  OsMesaContext(const OsMesaContext&) = delete;
  OsMesaContext& operator=(const OsMesaContext&) = delete;

  // Returns pointers for unknown names, too: gl_api requests only functions of OpenGL 3.3.
  [[nodiscard]] GlProcedure find(const char* name) const override { return osmesa().find(name); }
  [[nodiscard]] const char* backend() const override { return "OSMesa"; }

 private:
  bool bind() override {
    return osmesa().make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, kEdge, kEdge) == GL_TRUE;
  }
  [[nodiscard]] bool bound() const override { return osmesa().current() == context_; }
  void release() override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }

  static constexpr int kEdge = 16;
  OSMesaContext context_;
  std::array<std::uint8_t, std::size_t{4} * kEdge * kEdge> buffer_{};
};

}  // namespace

Result<std::unique_ptr<GlContext>> make_osmesa_context() {
  if (!osmesa().library.open()) return fail("libOSMesa is not installed", "apt-get install libosmesa6");
  if (!osmesa().complete) return fail("libOSMesa is older than 11.2", "apt-get install libosmesa6");
  constexpr std::array<int, 11> kAttributes = {OSMESA_FORMAT,
                                               OSMESA_RGBA,
                                               OSMESA_PROFILE,
                                               OSMESA_CORE_PROFILE,
                                               OSMESA_CONTEXT_MAJOR_VERSION,
                                               3,
                                               OSMESA_CONTEXT_MINOR_VERSION,
                                               3,
                                               OSMESA_DEPTH_BITS,
                                               0,
                                               0};
  const OSMesaContext handle = osmesa().create(kAttributes.data(), nullptr);
  if (handle == nullptr) return fail("libOSMesa makes no OpenGL 3.3 core context", "apt-get install libosmesa6");
  auto context = std::make_unique<OsMesaContext>(handle);
  if (!context->make_current()) return fail("libOSMesa cannot make its context current", "apt-get install libosmesa6");
  return context;
}

}  // namespace cellmirror::display
