// A point on the surface of an object that stays with its triangle, and a cell's deformable objects as the parts of the
// simulation see them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "rt_core/tissue/body.hpp"
#include "rt_core/tissue/constraint_system.hpp"
#include "rt_core/tissue/description.hpp"
#include "rt_core/tissue/surface_index.hpp"

namespace cellmirror::tissue {

// A sum of the corners of a triangle, as they were embedded when it was made: cuts give the numbers of surface points
// to other ones.
struct SurfacePoint {
  std::uint32_t object = 0;
  std::array<std::uint32_t, 3> corner{};  // surface points of the body
  std::array<EmbeddedPoint, 3> embedded{};
  Eigen::Vector3d share = Eigen::Vector3d::Zero();  // of each; sum 1
};

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

// Where p lies in a triangle: shares of its corners. Clamped to the triangle.
[[nodiscard]] Eigen::Vector3d barycentric(const Eigen::Vector3d& p, const geometry::Triangle& triangle);

[[nodiscard]] SurfacePoint surface_point(const DeformableObject& object, std::uint32_t number, std::uint32_t triangle,
                                         const Eigen::Vector3d& share);
// False where a cut has changed the surface there.
[[nodiscard]] bool attached(const DeformableObject& object, const SurfacePoint& point);
[[nodiscard]] Eigen::Vector3d position(const DeformableObject& object, const SurfacePoint& point);
[[nodiscard]] double burn(const DeformableObject& object, const SurfacePoint& point);
// The surface's point nearest to p, if it is nearer than reach. Of the step's start.
[[nodiscard]] std::optional<SurfacePoint> nearest_surface_point(DeformableObject& object, std::uint32_t number,
                                                                const Eigen::Vector3d& p, double reach);
// After a cut: the point of the surface that is now where this one is; it stays as it was embedded if there is none.
void attach_again(DeformableObject& object, SurfacePoint& point);
[[nodiscard]] Eigen::Vector3d velocity(const DeformableObject& object, const SurfacePoint& point);

// Terms of the next constraint.
void add_terms(ConstraintSystem& system, const DeformableObject& object, const SurfacePoint& point, double sign);
void add_terms(ConstraintSystem& system, const DeformableObject& object, std::uint32_t number,
               const EmbeddedPoint& point, double sign);

}  // namespace cellmirror::tissue
