// Limits of plausibility: which values are beyond one, how often, and what is to be done then.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "rt_core/ports/tissue_settings.hpp"
#include "rt_core/tissue/description/event_log.hpp"

namespace cellmirror::tissue {

// Bits of TissueLimitAction.
class LimitActions {
 public:
  constexpr LimitActions() = default;
  constexpr explicit LimitActions(std::uint8_t bits) : bits_(bits) {}
  [[nodiscard]] constexpr bool any() const { return bits_ != 0; }
  [[nodiscard]] constexpr bool has(TissueLimitAction action) const {
    return (bits_ & static_cast<std::uint8_t>(action)) != 0;
  }
  constexpr void join(LimitActions other) { bits_ = static_cast<std::uint8_t>(bits_ | other.bits_); }

 private:
  std::uint8_t bits_ = 0;
};

class Limits {
 public:
  // As in kDefaultTissueLimits.
  Limits();

  void set(TissueLimit limit, std::uint8_t actions, double value);  // 0 or a value that is not positive: off
  [[nodiscard]] bool on(TissueLimit limit) const { return actions_[std::to_underlying(limit)].any(); }
  [[nodiscard]] double value(TissueLimit limit) const { return values_[std::to_underlying(limit)]; }
  [[nodiscard]] bool clamps(TissueLimit limit) const {
    return actions_[std::to_underlying(limit)].has(TissueLimitAction::clamp);
  }

  // Counts and reports an excess; what to do about it. None where the value is within its limit or the limit is off.
  LimitActions examine(TissueLimit limit, double value, EventLog& log, const EventLog::Source& source,
                       const Eigen::Vector3d& at);
  // Counts an excess whatever the limit is: of a value that cannot be compared.
  void count(TissueLimit limit) { ++excesses_[std::to_underlying(limit)]; }
  [[nodiscard]] const std::array<std::uint64_t, kTissueLimits>& excesses() const { return excesses_; }

 private:
  std::array<LimitActions, kTissueLimits> actions_{};
  std::array<double, kTissueLimits> values_{};
  std::array<std::uint64_t, kTissueLimits> excesses_{};
};

}  // namespace cellmirror::tissue
