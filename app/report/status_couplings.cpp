#include "app/report/status_couplings.hpp"

#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

const char* state_word(const engine::FollowTickState& follow) {
  if (!follow.follows()) return "free";  // the tick has not heard of it yet
  if (follow.holding) return "holding";
  return follow.limited != 0 ? "limited" : "following";
}

}  // namespace

json couplings_json(std::span<const CouplingSnapshot> couplings, const engine::TickState& tick) {
  json all = json::array();
  for (const CouplingSnapshot& coupling : couplings) {
    const engine::RobotTickState& master = tick.robots[coupling.master_slot];
    const engine::RobotTickState& slave = tick.robots[coupling.slave_slot];
    json joints = json::array();
    for (const CoupledJointSnapshot& joint : coupling.joints) {
      const double lag =
          master.joints[joint.joint.master_joint].position - slave.joints[joint.joint.slave_joint].position;
      joints.push_back({{"master", joint.master},
                        {"slave", joint.slave},
                        {"limited", (slave.follow.limited >> joint.joint.slave_joint & 1U) != 0},
                        {joint.kind == JointKind::prismatic ? "lag_m" : "lag_rad", lag}});
    }
    all.push_back({{"master", coupling.master},
                   {"slave", coupling.slave},
                   {"state", state_word(slave.follow)},
                   {"joints", std::move(joints)}});
  }
  return all;
}

}  // namespace cellmirror::app
