// Takes the pictures of the running cell, in a thread of its own that never holds up anything: for the monitor page,
// for `cellmirror snapshot`, for DDS. Nobody looks: nothing is drawn.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "drivers/display/renderer.hpp"
#include "ipc/web/web_backend.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror::app {

struct StudioSettings {
  bool on = true;
  double rate_hz = 20;  // of updates of the picture, at most
  int width = 640;      // where nobody says otherwise
  int height = 480;
  display::RendererOptions renderer;
};

// How often the picture was updated: what STEPS of STVW counts. It goes on at the rate of the settings where nobody
// looks.
class PictureUpdates {
 public:
  [[nodiscard]] std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
  void add() { count_.fetch_add(1, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace cellmirror::app
