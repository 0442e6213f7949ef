// SCRIPT's commands for deformable objects and the instruments that act on them (manual 1.2.5, 1.2.6): checks names,
// keeps what was asked for, and hands it on to the simulation of tissue. Belongs to the thread that owns the cell.
//
// In a cell without deformable objects a command that names one is refused; every other is a setting, which is done,
// with a remark that it has no effect there: a script may serve several cells.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/owner/tissue/tissue_objects.hpp"
#include "app/owner/tissue/tissue_parts.hpp"
#include "app/snapshot/tissue_port.hpp"
#include "app/snapshot/tissue_snapshot.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/tissue_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

class TissueService final : public TissueHost {
 public:
  // What is referred to outlives this.
  TissueService(const Cell& cell, const NameDirectory& names, TissueParts parts);

  Result<std::string> set_attributes(std::string_view object, std::uint16_t mask, std::uint16_t values) override;
  Result<std::string> set_cylinders(std::string_view geometry, const EffectorCylinders& cylinders) override;
  Result<std::string> set_connections(std::string_view hyper_file) override;
  Result<std::string> set_network_shown(bool on) override;
  Result<std::string> reset_model() override;
  Result<std::string> set_limit(TissueLimit limit, std::uint8_t actions, double value) override;
  Result<std::string> set_effect(TissueEffect effect, bool on) override;
  Result<std::string> reset_pool() override;
  Result<std::string> clean_lens() override;
  Result<std::string> set_calculating(bool on) override;
  Result<std::string> set_trigger(const InstrumentTrigger& trigger) override;
  Result<std::string> set_clip(std::string_view file, const Pose& X_TC) override;

  // The same object as long as nothing changes.
  [[nodiscard]] const std::shared_ptr<const TissueSettings>& settings() const { return settings_; }

 private:
  // The active robot, if it is an instrument or may become one.
  [[nodiscard]] Result<const RobotModel*> instrument() const;
  // Hands the commands on and, where that is done, makes `change` to the settings. The answer is the remark.
  Result<std::string> apply(std::vector<tissue::Command> commands, const std::function<void(TissueSettings&)>& change,
                            std::string remark = {});
  // Why the effect has nothing to act on; empty: it has.
  [[nodiscard]] std::string effect_remark(TissueEffect effect) const;
  // Why a trigger never acts, or does nothing when it does; empty: it does.
  [[nodiscard]] std::string trigger_remark(const InstrumentTrigger& trigger, const RobotModel& robot) const;

  const Cell& cell_;
  const NameDirectory& names_;
  TissueObjects objects_;
  TissueReaders readers_;
  TissuePort* port_;
  std::shared_ptr<const TissueSettings> settings_;
};

}  // namespace cellmirror::app
