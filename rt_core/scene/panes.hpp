// The parts of the picture: the six displays of STDP and the views in them (manual 1.2.3), or one view alone.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::scene {

struct PaneInput {
  const CompiledCell& cell;
  const CellPoses& poses;
  const DisplayState& display;
  Timestamp now;
  std::uint64_t updates = 0;  // of the picture so far, for sequences by STEPS
};

// A view where it is now: on its sequence, or at its camera (COVW), or as set.
[[nodiscard]] View view_now(const PaneInput& input, int id);
[[nodiscard]] Eye eye_of(const View& view);
[[nodiscard]] bool ended(const ViewSequence& sequence, Timestamp now, std::uint64_t updates);
// At `part` 0 to 1 of the way: all parameters evenly.
[[nodiscard]] View between(const View& from, const View& to, double part);

// Of the current display; of CAM_MAINVIEW one pane with the current camera.
[[nodiscard]] std::vector<Pane> panes_of_display(const PaneInput& input);
// One pane with this view, 0 to 6.
[[nodiscard]] std::vector<Pane> panes_of_view(const PaneInput& input, int id);
// Refused where there is no such camera; names the nearest.
[[nodiscard]] Result<std::vector<Pane>> panes_of_camera(const PaneInput& input, std::string_view camera);

}  // namespace cellmirror::scene
