// All deformable objects of a cell, what connects them, the instruments that act on them and the effects. No threads,
// no clock, no files: the caller calls step() once a millisecond of simulated time. One thread at a time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/tissue/command.hpp"
#include "rt_core/tissue/description.hpp"
#include "rt_core/tissue/rigid_body.hpp"

namespace cellmirror::tissue {

inline constexpr double kStep_s = 0.001;

// An instrument in this step.
struct InstrumentPose {
  int slot = 0;                  // of its robot
  Pose X_WT = Pose::Identity();  // tool centre point, z forwards along the shaft, y the direction in which jaws open
  std::span<const double> q;     // rad or m, all joints
};

struct StepInput {
  Timestamp time;
  std::span<const InstrumentPose> instruments;
  std::span<const RigidBodyPose> bodies;
};

// Force of the tissue on an instrument near the pose for which it was computed: F(x) = force - stiffness (x - x_ref),
// for the tool centre point at x. A stiffness is symmetric and never negative; while nothing is held, a force never
// pulls the instrument into the tissue.
struct InstrumentResponse {
  int slot = 0;
  Eigen::Vector3d x_ref = Eigen::Vector3d::Zero();      // m, world
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();    // N, equivalent at the tool centre point
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();   // Nm about the tool centre point
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // N/m
  std::uint32_t contacts = 0;
  std::uint32_t held = 0;
};

class World {
 public:
  // Makes lattices and everything derived: seconds for large objects. An error names file and remedy.
  static Result<World> make(std::vector<ObjectDescription> objects, std::vector<Connection> connections);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  void apply(const Command& command);
  // One millisecond. Bounded; takes heap memory only where something is cut.
  void step(const StepInput& input);

  [[nodiscard]] std::span<const InstrumentResponse> responses() const;
  // Events of the last step.
  [[nodiscard]] std::span<const TissueEvent> events() const;
  void describe(TissueState& state) const;
  // `network`: also the nodes of eladyn_show_def.
  void view(TissueView& view, bool network) const;
  [[nodiscard]] std::size_t object_count() const;

 private:
  struct Parts;
  explicit World(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace cellmirror::tissue
