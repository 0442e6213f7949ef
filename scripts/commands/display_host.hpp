// Interface of SCRIPT to picture, views and cameras. Rules as in host.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/view_change.hpp"

namespace cellmirror {

// How a view gets to its new parameters (STVW).
struct AtOnce {};
struct InSteps {
  std::uint64_t updates = 1;  // of the picture
};
struct InTime {
  Nanoseconds time{0};
};
using ViewPace = std::variant<AtOnce, InSteps, InTime>;

class DisplayHost {
 public:
  virtual ~DisplayHost() = default;
  virtual Result<void> set_display(int display, bool full_screen) = 0;                          // STDP, 1 to 6
  virtual Result<void> set_view(int view, const ViewChange& change, const ViewPace& pace) = 0;  // STVW, 0 to 6
  virtual Result<void> connect_view(int view, std::string_view camera) = 0;                     // COVW
  virtual Result<void> load_views(std::string_view file) = 0;                                   // LOAD_VIEWS
  virtual Result<void> save_views(std::string_view file) = 0;                                   // SAVE_VIEWS, ours
  virtual Result<void> set_mode(DisplayMode mode, bool on) = 0;  // SET_MODE, BFRM, FLDR, SHAD
  virtual Result<void> set_legend(bool on) = 0;                  // ours
  // RENDER. Done with a remark if it has no visible effect.
  virtual Result<std::string> set_draw_mode(std::string_view node, bool branch, DrawMode mode) = 0;
  virtual Result<void> set_tag_length(double length_m) = 0;  // TAG_DRAWLEN
  virtual Result<void> set_camera(std::string_view camera, double focal_distance_m, double fovy_rad) = 0;  // SET_CAMPAR
  virtual Result<void> track(std::string_view camera,
                             std::optional<std::string_view> frame) = 0;         // CAM_TRACKING; none: off
  virtual Result<void> show_pyramid(std::string_view camera, bool on) = 0;       // CAM_VIEW_PYRAMID
  virtual Result<void> set_camera_online(std::string_view camera, bool on) = 0;  // CAM_ONLINE
  virtual Result<void> set_arc(bool on) = 0;                                     // ARC, of the active robot
  virtual Result<void> show_message(std::string_view text) = 0;                  // hot_message
};

}  // namespace cellmirror
