// A point on the surface of an object that stays with its triangle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "rt_core/tissue/contact/constraint_system.hpp"
#include "rt_core/tissue/contact/deformable_object.hpp"

namespace cellmirror::tissue {

// A sum of the corners of a triangle, as they were embedded when it was made: cuts give the numbers of surface points
// to other ones.
struct SurfacePoint {
  std::uint32_t object = 0;
  std::array<std::uint32_t, 3> corner{};  // surface points of the body
  std::array<EmbeddedPoint, 3> embedded{};
  Eigen::Vector3d share = Eigen::Vector3d::Zero();  // of each; sum 1
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
