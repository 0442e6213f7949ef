#include "rt_core/haptics/re_engagement.hpp"

#include "rt_core/haptics/nearest_point.hpp"

namespace cellmirror::haptics {

bool passes_by_itself(HapticFault fault) CELL_RT {
  switch (fault) {
    case HapticFault::stale:
    case HapticFault::vanished:
    case HapticFault::torn:
    case HapticFault::late_tick:
    case HapticFault::stale_model:
      return true;
    case HapticFault::none:
    case HapticFault::not_finite:
    case HapticFault::invalid:
    case HapticFault::jump:
    case HapticFault::two_writers:
    case HapticFault::not_passive:
      break;
  }
  return false;
}

bool ReEngagement::rests(Timestamp now, const Eigen::Vector3d& hand) CELL_RT {
  // Not "farther", so that a place that is no number is no rest.
  const bool stays = since_.known() && (hand - place_).norm() <= kRestRadius;
  if (!stays) {
    place_ = hand;
    since_ = now;
  }
  return now - since_ >= kAtRest;
}

HapticAwaited ReEngagement::awaits(const FaultedTick& tick) CELL_RT {
  if (!tick.by_itself || !passes_by_itself(tick.fault)) return HapticAwaited::reset;
  const bool rest = rests(tick.now, tick.hand);
  if (tick.now - tick.last_bad < kQuiet) return HapticAwaited::device;
  if (tick.model == nullptr) return HapticAwaited::surroundings;
  const bool outside = violation(*tick.model, tick.hand) <= kDeepest && violation(*tick.model, tick.tip) <= kDeepest;
  if (!outside) return HapticAwaited::outside;
  return rest ? HapticAwaited::nothing : HapticAwaited::rest;
}

}  // namespace cellmirror::haptics
