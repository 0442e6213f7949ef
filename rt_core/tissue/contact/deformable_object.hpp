// A deformable object of a cell as the parts of the simulation see it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/tissue/body/body.hpp"
#include "rt_core/tissue/contact/surface_index.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

struct DeformableObject {
  ObjectDescription description;
  std::unique_ptr<Body> body;  // null: only a pool
  SurfaceIndex surface;
  std::vector<EmbeddedPoint> start_points;  // of the surface as made, and where they were, m
  std::vector<Eigen::Vector3d> start_positions;
  std::uint32_t substeps = 1;  // of a step: 1, 2, 4 or 8
  bool frozen = false;         // by a limit
  double speed = 0;            // m/s, of the fastest node at the step's start
  bool too_fast = false;       // in this step a node's speed was limited
  std::uint32_t contacts = 0;  // of the last step
  bool steps_now = true;       // in this substep; else it takes impulses only

  [[nodiscard]] bool has(TissueAttribute which) const { return body && cellmirror::has(body->attributes(), which); }
  [[nodiscard]] bool calculates() const { return !frozen && has(TissueAttribute::calculate); }
};

}  // namespace cellmirror::tissue
