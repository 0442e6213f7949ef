// Which robots follow which (MASTER_SLAVE, manual 1.2.4): the rules for couplings. Belongs to the thread that owns the
// cell; the engine carries out what was accepted (rt_core/engine/coupling.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ports/coupled_joint.hpp"

namespace cellmirror::planning {

// Of one slave.
struct RobotCoupling {
  std::string master;
  std::vector<CoupledJoint> joints;
};

class RobotCouplings {
 public:
  using BySlave = std::map<std::string, RobotCoupling, std::less<>>;
  static constexpr std::size_t kMaxSlaves = 5;  // of a master, manual 1.2.4

  // What a command makes of the slaves that it names, in its order; nothing has changed yet. A slave of the same master
  // gets these joints in place of those before. Refused, as a whole: a slave that is mirrored or follows another
  // master, circles, unknown robots and joints, one that is driven twice, joints of different kinds or without a
  // velocity limit, more slaves than the manual allows.
  using Changes = std::vector<std::pair<std::string, RobotCoupling>>;
  [[nodiscard]] Result<Changes> coupled(const Cell& cell, std::string_view master, std::span<const SlaveJoints> slaves,
                                        const std::function<bool(std::string_view robot)>& is_mirrored) const;
  // The same for freed joints: what is left; no joints: the slave is free. Refused, as a whole, where one of them is
  // not coupled so.
  [[nodiscard]] Result<Changes> freed(const Cell& cell, std::string_view master,
                                      std::span<const SlaveJoints> slaves) const;
  // Carries out one change.
  void apply(const std::string& slave, const RobotCoupling& coupling);
  void forget(std::string_view slave);

  [[nodiscard]] const BySlave& all() const { return by_slave_; }
  [[nodiscard]] const RobotCoupling* find(std::string_view slave) const;

 private:
  // Of one slave; `others`: as they will be.
  static Result<RobotCoupling> checked(const Cell& cell, const RobotModel& master, const SlaveJoints& slave,
                                       const BySlave& others,
                                       const std::function<bool(std::string_view robot)>& is_mirrored);

  BySlave by_slave_;
};

}  // namespace cellmirror::planning
