// Frames, lines, traces, cones, arrows and sparks of a scene as what the passes draw, for one pane: their thickness
// goes by pixels. Private to this folder.
#pragma once

#include <vector>

#include "drivers/display/internal/body_pass.hpp"
#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/ribbons.hpp"

namespace cellmirror::display {

struct Marks {
  Ribbons hidden_by_bodies;
  Ribbons on_top;
  std::vector<DrawnBody> solids;       // heads and shafts of arrows
  std::vector<DrawnBody> see_through;  // cones, the farthest first

  // Bounded in number; what is not finite is left out.
  void gather(const Frame& frame, MeshStore& meshes);

 private:
  void add_axes(const Frame& frame, MeshStore& meshes, const SceneAxes& axes);
  void add_trace(const Frame& frame, const SceneTrace& trace);
  void add_cone(const Frame& frame, MeshStore& meshes, const SceneCone& cone);
  void add_arrow(const Frame& frame, MeshStore& meshes, const SceneArrow& arrow);
  void add_plane_frames(const Frame& frame, const SceneVolume& shown);
  void add_spark(const Frame& frame, const SceneSpark& spark);
};

}  // namespace cellmirror::display
