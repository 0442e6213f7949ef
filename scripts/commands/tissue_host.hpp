// Interface of SCRIPT to deformable objects and the instruments that act on them (manual 1.2.5, 1.2.6). As host.hpp.
// A done call may have a remark on what has no visible effect, e.g. because the cell has no deformable object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/tissue_settings.hpp"

namespace cellmirror {

// rob_ela_interact.
struct InstrumentTrigger {
  std::size_t joint = 0;  // index in the robot's joints, from 0
  InstrumentTest test = InstrumentTest::off;
  double value_1 = 0;  // rad or m
  double value_2 = 0;
  InstrumentKind kind = InstrumentKind::gripper;
};

// eladyn_geo_def with a geometry of the effector. The shaft's diameter and the effector's radius are positive.
struct EffectorCylinders {
  std::uint32_t flags = 0;  // without effect
  double shaft_diameter_m = 0;
  double effector_radius_m = 0;  // mean distance of the effector's surface from the axis
  double effector_length_m = 0;  // 0 or less: the default
  double fourth = 0;             // as given, without effect
};

// What concerns an instrument concerns the active robot and is refused where there is none.
class TissueHost {
 public:
  virtual ~TissueHost() = default;
  // `object`: its name, or ALL. Sets the attributes of the mask to those of the values (bits of TissueAttribute).
  virtual Result<std::string> set_attributes(std::string_view object, std::uint16_t mask, std::uint16_t values) = 0;
  virtual Result<std::string> set_cylinders(std::string_view geometry, const EffectorCylinders& cylinders) = 0;
  virtual Result<std::string> set_connections(std::string_view hyper_file) = 0;  // eladyn_hyper_name
  virtual Result<std::string> set_network_shown(bool on) = 0;                    // eladyn_show_def
  virtual Result<std::string> reset_model() = 0;                                 // eladyn_model_reset
  // eladyn_plaus_param: bits of TissueLimitAction, 0: off; m/s, m, N or 1.
  virtual Result<std::string> set_limit(TissueLimit limit, std::uint8_t actions, double value) = 0;
  // EFFECTS. Suction and irrigation go on with the robot that is active now.
  virtual Result<std::string> set_effect(TissueEffect effect, bool on) = 0;
  virtual Result<std::string> reset_pool() = 0;
  virtual Result<std::string> clean_lens() = 0;
  virtual Result<std::string> set_calculating(bool on) = 0;                           // eladyn_calc
  virtual Result<std::string> set_trigger(const InstrumentTrigger& trigger) = 0;      // rob_ela_interact
  virtual Result<std::string> set_clip(std::string_view file, const Pose& X_TC) = 0;  // ela_clip_def; C in the TCP
};

}  // namespace cellmirror
