// Display settings of SCRIPT (manual 1.2.1, 1.2.3, 1.2.4, 1.2.6): plain data published by the owner of the cell. SI.
// Immutable once shared.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/display_layout.hpp"
#include "rt_core/ports/view.hpp"

namespace cellmirror {

// SET_MODE, in the order of the manual.
enum class DisplayMode : std::uint8_t {
  workframes,            // WFRM_display: workframes drawn
  smear,                 // trace of the active robot's TCP
  backface_removal,      // BFRM, by the graphics system
  cpu_backface_removal,  // CPU_BFRM, computed before drawing
  camera_main_view,      // CAM_MAINVIEW: the current camera's view fills the display; the bird's eye view steers it
  two_sided_light,       // LGT_TWOSIDE
  tcp_frame,             // TCP_DRAW, of the active robot
  zero_point_frame,      // ZPF_DRAW, of the active robot
  floor,                 // FLDR
  visibility_test,       // GEO_VIS_TEST: objects outside the picture are culled
  shadows,               // SHAD; visible only with the floor
  bell,                  // BEEP with messages
  textures,              // TEXTURES: of the floor and, where a mesh has them, of bodies
  antialiasing,          // ANTIALIAS
};
inline constexpr std::size_t kDisplayModes = 14;
using DisplayModes = std::bitset<kDisplayModes>;

// RENDER of SET_FRAME and SET_ABSTRACT; the numbers are the manual's.
enum class DrawMode : std::uint8_t { wireframe = 2, flat = 3, gouraud = 4, transparent = 20 };

// In the order in which they were commanded: of those that concern a geometry the last one counts.
struct DrawRule {
  std::string path;     // dotted, of the node
  bool branch = false;  // SET_ABSTRACT: what is below it in the tree of names, too, loaded now or later
  DrawMode mode = DrawMode::gouraud;
};

struct CameraSetting {
  std::string name;       // of its workframe
  bool pyramid = false;   // CAM_VIEW_PYRAMID
  bool online = false;    // CAM_ONLINE
  bool mirrored = false;  // its workframe is moved by a robot that is online: it is shown as that robot holds it
  std::string tracks;     // dotted path of the tracked frame (CAM_TRACKING on); empty: none
  bool tracking = false;  // a direction exists; false if the frame coincides with the camera
};

// A view on its way (STVW with STEPS or TIME): the parameters go from `from` to `to` at once and evenly.
struct ViewSequence {
  View from;
  View to;
  Timestamp begin;
  Nanoseconds duration{0};       // TIME; 0: by steps
  std::uint64_t first_step = 0;  // count of the picture's updates at the beginning
  std::uint64_t steps = 0;       // STEPS; 0: by time
};

struct DisplayView {
  View view;                     // where no sequence runs: as it is; else as it will be
  std::string camera;            // COVW: the view is this camera's; empty: its own
  bool front_plane_set = false;  // STVW has set it since COVW: it cuts at the camera as far as it says
  std::optional<ViewSequence> sequence;
};

struct ShownText {
  std::string text;
  Timestamp time;
  std::uint64_t number = 0;  // counts from 1
  bool bell = false;         // BEEP was on: play a sound with the message
};

struct DisplayState {
  std::uint64_t revision = 0;
  int display = 1;  // STDP, 1 to 6
  bool full_screen = false;
  DisplayLayout layout;  // as the cell file has it; nothing changes it
  std::array<DisplayView, kViews> views;
  DisplayModes modes;
  std::uint64_t smear_ends =
      0;                       // number of times SMEAR was switched off, so that no reader misses the end of the traces
  double tag_length_m = 0.25;  // TAG_DRAWLEN; the manual's default
  std::vector<DrawRule> draw_rules;
  std::vector<CameraSetting> cameras;  // of all cameras of the cell, in its order
  std::string current_camera;          // of CAM_MAINVIEW: the one a command named last; empty: the first
  std::vector<std::string> arcs;       // robots whose ARC is on
  bool legend = true;                  // of ours (SET_MODE LEGEND)
  std::vector<ShownText> messages;     // hot_message, newest last; shown for about 5 s (manual 1.2.6)

  [[nodiscard]] bool on(DisplayMode mode) const { return modes.test(static_cast<std::size_t>(mode)); }
};

}  // namespace cellmirror
