// An instrument as tissue meets it: where it is and how it moves in this step, its two virtual cylinders, whether its
// condition is true, and what it holds.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/tissue/contact/surface_point.hpp"
#include "rt_core/tissue/description/command.hpp"
#include "rt_core/tissue/description/event_log.hpp"
#include "rt_core/tissue/description/limits.hpp"
#include "rt_core/tissue/description/step.hpp"

namespace cellmirror::tissue {

inline constexpr int kMostInstrumentSlots = 1024;  // slots are below
inline constexpr double kCutBurn = 1.2;            // a hot hook goes through what is burnt so much

// A segment with a radius, in the world.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double radius = 0;
};

// A point of a surface that jaws hold.
struct HeldPoint {
  SurfacePoint point;
  Eigen::Vector3d p_T = Eigen::Vector3d::Zero();      // m, where the jaws hold it
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  // N s, of the last substep
  double force = 0;                                   // N, largest of the step
  bool limited = false;                               // it was not enough to hold the point
  std::size_t row = 0;                                // in the constraint system of this substep
  bool has_row = false;
};

struct Instrument {
  int slot = 0;
  InstrumentShape shape;
  InstrumentAction action;
  std::optional<InstrumentAction> next_action;  // once the stroke of `action` has ended
  ClipDefinition clip;
  std::shared_ptr<const std::vector<Eigen::Vector3f>> clip_vertices;
  std::shared_ptr<const std::vector<std::array<std::uint32_t, 3>>> clip_triangles;

  // --- in this step ---
  bool tracked = false;                               // X_start is known
  bool effective = false;                             // it acts on tissue in this step
  bool acting = false;                                // its condition is true
  bool acted = false;                                 // it was in the last step
  Pose X_start = Pose::Identity();                    // world, at the start of the step
  Pose X_end = Pose::Identity();                      // at its end
  Eigen::Vector3d speed = Eigen::Vector3d::Zero();    // m/s, of the tool centre point
  Eigen::Vector3d turning = Eigen::Vector3d::Zero();  // rad/s

  // --- what it does ---
  std::vector<HeldPoint> held;
  bool slipping = false;
  double cut_front_m = 0;     // of scissors: from the pivot
  double stroke_area_m2 = 0;  // cut since the condition became true
  Eigen::Vector3d stroke_at = Eigen::Vector3d::Zero();
  int stroke_object = -1;
  double heated_m3 = 0;  // since the condition became true
  bool heating = false;
  bool swept = false;                                    // a hook: swept_from is known
  Eigen::Vector3d swept_from = Eigen::Vector3d::Zero();  // the effector's upper end when it last cut
  bool discard_next = false;                             // by a limit: no effect in the next step
  bool release_requested = false;                        // by a limit

  // --- what it feels ---
  Eigen::Vector3d force = Eigen::Vector3d::Zero();       // N, of this step, on the instrument
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();        // N, of this step, part of `force`: by the tissue in the jaws
  double held_by = 0;                                    // N, magnitude of the pull in the last completed step
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();      // Nm about the tool centre point
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();  // sum of n n^T weighted with force, N
  double depth = 0;                                      // m, of the deepest contact
  std::uint32_t contacts = 0;

  // In force with the next step; while it heats or cuts, one step later, so that the stroke ends and is reported.
  void set_action(const InstrumentAction& action);
  void set_shape(const InstrumentShape& shape);
  void set_clip(const ClipDefinition& definition);
  // Forgets where it was and what it does; keeps what commands have set.
  void reset();
  // Its pose at the end of this step. A pose that is not finite or not a rotation, and a jump: no effect, and counted.
  // Returns what the limit of speed asks for.
  LimitActions move_to(const InstrumentPose& pose, Limits& limits, EventLog& log);
  // It is not there in this step.
  void absent();

  // Radius with which the effector touches.
  [[nodiscard]] double contact_radius() const;
  // What touches, at the step's start. 0: the shaft. 1: the effector; where jaws take tissue between them (scissors,
  // clip applicator, forceps), 1 and 2: the open jaws. Ends are rounded and end where the cylinders do.
  static constexpr std::size_t kMostCapsules = 3;
  [[nodiscard]] std::size_t capsules() const { return has_jaws() ? 3 : 2; }
  [[nodiscard]] Capsule capsule(std::size_t which) const;
  // The effector's cylinder, with its whole radius.
  [[nodiscard]] Capsule effector() const;
  [[nodiscard]] bool has_jaws() const {
    return action.kind == InstrumentKind::scissors || action.kind == InstrumentKind::clip_applicator ||
           action.kind == InstrumentKind::forceps;
  }
  [[nodiscard]] Eigen::Vector3d velocity_at(const Eigen::Vector3d& p) const {
    return speed + turning.cross(p - X_start.translation());
  }
  [[nodiscard]] bool started() const { return acting && !acted; }
  [[nodiscard]] bool stopped() const { return !acting && acted; }

 private:
  void begin_action(const InstrumentAction& wanted);
};

}  // namespace cellmirror::tissue
