// Draws scenes into pictures without a display: OpenGL 3.3 core by OSMesa, or by EGL without a surface.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/renderer_counters.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

enum class Backend : std::uint8_t { automatic, osmesa, egl };  // automatic: OSMesa, then EGL

struct RendererOptions {
  Backend backend = Backend::automatic;
  int threads = 1;  // of a software renderer beside the calling one; 0: it draws in the calling thread alone. As many
                    // cast voxel volumes, in the idle class
};

// Belongs to the thread that made it. Not real time.
class Renderer {
 public:
  // Fails where no backend can be had, with what was tried and the package that brings it.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // "OSMesa: llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5": the backend and the renderer's own name and version.
  [[nodiscard]] std::string_view name() const;

  // Fails for sizes outside of 16..kLargestImageEdge and where memory does not suffice. What is not finite is left out.
  // `smooth`: with anti-aliasing where the scene's modes have it; false: without, where there is no time for it.
  // `volume_time`: how long casting voxel volumes may take while they look different in each picture of a pane (moved,
  // turned, clipped, hidden): their resolution follows. What has not changed since the last picture is cast at full
  // quality. 0: always at full quality.
  Result<void> draw(const Scene& scene, std::span<const Pane> panes, int width, int height, Image& picture,
                    bool smooth = true, Nanoseconds volume_time = Nanoseconds{0});
  // The object under each pixel, rows from the top; 0: none. Without anti-aliasing, overlays, floor. A voxel volume
  // where it is at least half opaque.
  Result<void> objects(const Scene& scene, std::span<const Pane> panes, int width, int height,
                       std::vector<std::uint32_t>& objects);
  [[nodiscard]] RendererCounters counters() const;

 private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::display
