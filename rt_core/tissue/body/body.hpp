// One deformable object: tetrahedra with a total-Lagrangian explicit step, a surface embedded in them, and cuts by
// which elements are duplicated (virtual nodes), never split. SI, world frame. No threads, no clock, no files.
//
// A step of a body, in this order, all by its owner:
//   begin_step(dt)            internal forces; velocities as they would be at its end without contacts
//   velocities are changed    by contacts and constraints: add_velocity(), or impulses at surface points
//   end_step(dt)              positions follow velocities
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

// A point embedded in an element: x = sum of weight * node. Weights sum to 1.
struct EmbeddedPoint {
  std::array<std::uint32_t, 4> node{};
  std::array<float, 4> weight{};
  std::uint32_t tetrahedron = 0;  // at rest: see Body::follow_cuts()
};

// A blade's way in one step, in the world: a parallelogram at `corner` with the edges `along` and `across`. What it
// crosses is divided.
struct BladeSweep {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  Eigen::Vector3d across = Eigen::Vector3d::Zero();
  double min_burn = 0;  // only where both ends of a link are burnt at least so much
};

struct CutResult {
  std::uint32_t links = 0;     // divided
  std::uint32_t elements = 0;  // that came into being
  double area_m2 = 0;          // of new surface, one side
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

class Body {
 public:
  // Makes the lattice (or takes the tetrahedra of the description) and everything derived from it.
  static Result<Body> make(const ObjectDescription& description);
  Body(Body&&) noexcept;
  Body& operator=(Body&&) noexcept;
  ~Body();

  // --- a step ---
  void begin_step(double dt, const Eigen::Vector3d& gravity);
  void end_step(double dt);
  // Shape, cuts and burns as after make(), to the bit.
  void reset();
  void set_attributes(std::uint16_t attributes);
  [[nodiscard]] std::uint16_t attributes() const;

  // --- nodes ---
  [[nodiscard]] std::span<const Eigen::Vector3d> positions() const;
  [[nodiscard]] std::span<const Eigen::Vector3d> velocities() const;
  // 1/kg; 0: fixed. Nodes of elements that are deformed much are heavier for a while, for a stable step.
  [[nodiscard]] std::span<const double> inverse_masses() const;
  [[nodiscard]] std::span<const Eigen::Vector3d> internal_forces() const;  // N, of the last begin_step()
  void add_velocity(std::uint32_t node, const Eigen::Vector3d& change);
  // For the next begin_step() only.
  void add_force(std::uint32_t node, const Eigen::Vector3d& force);

  // --- embedded points ---
  [[nodiscard]] Eigen::Vector3d position(const EmbeddedPoint& point) const;
  [[nodiscard]] Eigen::Vector3d velocity(const EmbeddedPoint& point) const;
  [[nodiscard]] double inverse_mass(const EmbeddedPoint& point) const;  // sum of weight^2 / mass
  // Changes velocities as an impulse (N s) at the point does.
  void add_impulse(const EmbeddedPoint& point, const Eigen::Vector3d& impulse);
  void add_force(const EmbeddedPoint& point, const Eigen::Vector3d& force);
  // The element that holds p (in the world, at rest: before any step) or the nearest one.
  [[nodiscard]] EmbeddedPoint embed_at_rest(const Eigen::Vector3d& p) const;
  // A point that was kept while `revision` changed: the same material point in the elements that there are now.
  void follow_cuts(EmbeddedPoint& point) const;

  // --- surface ---
  // Points that no triangle uses have no weight. `revision` changes where triangles do.
  [[nodiscard]] std::uint64_t revision() const;
  [[nodiscard]] std::span<const EmbeddedPoint> surface_points() const;
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> surface_triangles() const;
  [[nodiscard]] std::span<const std::uint8_t> cut_faces() const;  // by triangle: 1: made by a cut
  // Positions of all surface points; valid until the next end_step(), cut or reset.
  [[nodiscard]] std::span<const Eigen::Vector3d> surface_positions() const;
  void fill(TissueSurface& surface) const;  // all but name, look and flags

  // --- cutting, tearing, heat ---
  CutResult cut(const BladeSweep& blade);
  // Where a link was stretched beyond tear_strain in the last begin_step(). At most `most` links.
  CutResult tear(std::uint32_t most);
  // Raises the burn of nodes near the segment from a to b by at most `dose`, less with the distance up to `radius`.
  // Elements become stiffer (up to five times) and shrink (up to 15 %). Returns the volume that changed, m3.
  double heat(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, double dose);
  [[nodiscard]] double burn(const EmbeddedPoint& point) const;

  // --- figures ---
  void describe(TissueObjectState& state) const;
  void network(TissueNetwork& network) const;  // appends
  [[nodiscard]] double kinetic_energy() const;
  [[nodiscard]] double elastic_energy() const;
  [[nodiscard]] double volume_at_rest() const;  // m3, of all parts
  [[nodiscard]] double largest_strain() const;  // of the last begin_step()
  [[nodiscard]] double largest_speed() const;   // m/s
  [[nodiscard]] double stable_step_s() const;   // before mass is added
  // Scales back velocities above the limit; returns how many nodes it concerned.
  std::uint32_t limit_speed(double limit_m_s);

 private:
  struct Parts;
  explicit Body(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace cellmirror::tissue
