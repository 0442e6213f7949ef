#include "rt_core/tissue/description/limits.hpp"

#include <cmath>

namespace cellmirror::tissue {

Limits::Limits() {
  for (std::size_t i = 0; i < kTissueLimits; ++i) {
    const TissueLimitSetting& start = kDefaultTissueLimits.at(i);
    set(static_cast<TissueLimit>(i), start.actions, start.value);
  }
}

void Limits::set(TissueLimit limit, std::uint8_t actions, double value) {
  const bool usable = std::isfinite(value) && value > 0;
  actions_[std::to_underlying(limit)] = LimitActions(usable ? actions : std::uint8_t{0});
  values_[std::to_underlying(limit)] = usable ? value : 0.0;
}

LimitActions Limits::examine(TissueLimit limit, double value, EventLog& log, const EventLog::Source& source,
                             const Eigen::Vector3d& at) {
  const LimitActions actions = actions_[std::to_underlying(limit)];
  if (!actions.any() || !(value > values_[std::to_underlying(limit)])) return {};
  ++excesses_[std::to_underlying(limit)];
  if (actions.has(TissueLimitAction::report)) log.add_limit(limit, source, at, value);
  return actions;
}

}  // namespace cellmirror::tissue
