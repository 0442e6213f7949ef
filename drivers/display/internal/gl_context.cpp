#include "drivers/display/internal/gl_context.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "drivers/display/internal/leaks_of_others.hpp"

namespace cellmirror::display {

namespace {

// OSMesa and EGL are independent, and each assumes its own context to be current after the other has bound another one.
thread_local GlContext* current = nullptr;

// llvmpipe reads its number of threads only when its screen is created.
void limit_threads(int threads) {
  static std::once_flag once;
  static constexpr int kMostThreads = 16;
  std::call_once(
      once, [threads] { setenv("LP_NUM_THREADS", std::to_string(std::clamp(threads, 0, kMostThreads)).c_str(), 0); });
}

}  // namespace

bool GlContext::make_current() {
  if (current == this && bound()) return true;
  if (current != nullptr && current != this) current->release();
  current = nullptr;
  if (!bind()) return false;
  current = this;
  return true;
}

void GlContext::forget() {
  if (current != this) return;
  release();
  current = nullptr;
}

Result<std::unique_ptr<GlContext>> make_context(const RendererOptions& options) {
  tolerate_leaks_of_others();
  limit_threads(options.threads);
  std::string tried;
  std::string remedies;
  const auto note = [&](const char* backend, const Error& error) {
    tried += (tried.empty() ? "" : "; ") + std::string(backend) + ": " + error.what;
    remedies += (remedies.empty() ? "" : ", or ") + error.remedy;
  };
  if (options.backend != Backend::egl) {
    auto context = make_osmesa_context();
    if (context) return context;
    note("OSMesa", context.error());
  }
  if (options.backend != Backend::osmesa) {
    auto context = make_egl_context();
    if (context) return context;
    note("EGL", context.error());
  }
  return fail("no OpenGL 3.3 without a display (" + tried + ")", remedies);
}

}  // namespace cellmirror::display
