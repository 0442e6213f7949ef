// The parts of the picture: the six displays of STDP and the views in them (manual 1.2.3), or one view alone.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/cameras.hpp"

namespace cellmirror::scene {

struct PaneInput {
  const CompiledCell& cell;
  const CellPoses& poses;
  const DisplayState& display;
  Timestamp now;
  std::uint64_t updates = 0;  // of the picture so far, for sequences by STEPS
};

// A view where it is now: at its camera (COVW) if that is there, else on its sequence, else as set.
[[nodiscard]] View view_now(const PaneInput& input, int id);
// The camera's view: twist included, so that a view sequence may start there. A camera has no clipping planes: they are
// those of `clipped_as`, the nearer one not farther than 50 mm, or than its own housing needs.
[[nodiscard]] View view_of_camera(const CameraNow& camera, const View& clipped_as);
[[nodiscard]] Eye eye_of(const View& view);
[[nodiscard]] bool ended(const ViewSequence& sequence, Timestamp now, std::uint64_t updates);
// At `part` 0 to 1 of the way: all parameters evenly.
[[nodiscard]] View between(const View& from, const View& to, double part);

// Of the current display, as the layout has it: its views with their titles. FULL: the same without titles.
// CAM_MAINVIEW: the current camera (the first where none was named) with the clipping planes of the bird's eye view,
// whose number the pane carries; without any camera the display as is.
[[nodiscard]] std::vector<Pane> panes_of_display(const PaneInput& input);
// One pane with this view, 0 to 6; without title.
[[nodiscard]] std::vector<Pane> panes_of_view(const PaneInput& input, int id);
// One pane, of no view, without title. Refused where there is no such camera; names the nearest.
[[nodiscard]] Result<std::vector<Pane>> panes_of_camera(const PaneInput& input, std::string_view camera);

}  // namespace cellmirror::scene
