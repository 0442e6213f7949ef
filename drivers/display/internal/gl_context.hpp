// A current OpenGL 3.3 core context without a window, and its functions by name. Private to this folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/display/renderer.hpp"

namespace cellmirror::display {

using GlProcedure = void (*)();

// Belongs to the thread that created it. The libraries are loaded with the first context, with private symbols, so that
// OSMesa and EGL can be in one program; they are never closed, since Mesa's threads and thread-local data outlive a
// context.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  // A context that another one of this thread has displaced is made current again. False where that fails.
  [[nodiscard]] bool make_current();
  [[nodiscard]] virtual GlProcedure find(const char* name) const = 0;
  [[nodiscard]] virtual const char* backend() const = 0;  // "OSMesa", "EGL"

 protected:
  virtual bool bind() = 0;
  // What the library itself says: another part of the program may use it, too.
  [[nodiscard]] virtual bool bound() const = 0;
  virtual void release() = 0;  // the thread has no current context of this library afterwards
  void forget();               // for destructors of derived classes, before they destroy what is bound
};

[[nodiscard]] Result<std::unique_ptr<GlContext>> make_osmesa_context();
[[nodiscard]] Result<std::unique_ptr<GlContext>> make_egl_context();
// By options.backend; says all that was tried where none can be had.
[[nodiscard]] Result<std::unique_ptr<GlContext>> make_context(const RendererOptions& options);

}  // namespace cellmirror::display
