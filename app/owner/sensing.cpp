#include "app/owner/sensing.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace cellmirror::app {

namespace {

// The rule's path as the cell knows it now; as it was written where it names nothing (any more).
std::string full_path(const Cell& cell, const std::string& path) { return cell.find_branch(path).value_or(path); }

bool concerns(const Cell& cell, const collision::PairRule& rule, const std::string& a, const std::string& b) {
  const std::string rule_a = full_path(cell, rule.a);
  const std::string rule_b = full_path(cell, rule.b);
  return (rule_a == a && rule_b == b) || (rule_a == b && rule_b == a);
}

}  // namespace

Result<void> CellSensing::set_sensor_active(std::string_view sensor, bool active) {
  return cell_.set_sensor_active(sensor, active);
}

Result<void> CellSensing::set_sensor_range(std::string_view sensor, double range_m) {
  return cell_.set_sensor_range(sensor, range_m);
}

Result<void> CellSensing::set_range_send_mode(RangeSendMode mode) {
  send_mode_ = mode;
  return {};
}

Result<void> CellSensing::set_collision_active(bool active) {
  if (collision_->active == active) return {};
  auto changed = std::make_shared<collision::Settings>(*collision_);
  changed->active = active;
  collision_ = std::move(changed);
  return {};
}

Result<void> CellSensing::set_collision_warning(double distance_m) {
  auto changed = std::make_shared<collision::Settings>(*collision_);
  changed->warning_distance_m = distance_m;
  collision_ = std::move(changed);
  return {};
}

Result<void> CellSensing::set_collision_pair(std::string_view a, std::string_view b, PairTreatment treatment) {
  const auto path_a = cell_.find_branch(a);
  if (!path_a) return std::unexpected(path_a.error());
  const auto path_b = cell_.find_branch(b);
  if (!path_b) return std::unexpected(path_b.error());
  auto changed = std::make_shared<collision::Settings>(*collision_);
  std::erase_if(changed->rules,
                [&](const collision::PairRule& rule) { return concerns(cell_, rule, *path_a, *path_b); });
  if (treatment != PairTreatment::derive) {
    if (changed->rules.size() >= kMaxRules)
      return fail(fmt::format("there are {} rules for pairs already", kMaxRules), "take some back with `derive`");
    using Kind = collision::PairRule::Kind;
    // The last rule that fits a pair counts, so the newest stands last.
    changed->rules.push_back(
        {*path_a, *path_b, treatment == PairTreatment::test ? Kind::test : Kind::ignore, "SET_COLLPAR"});
  }
  collision_ = std::move(changed);
  return {};
}

}  // namespace cellmirror::app
