#include "app/report/loop_health.hpp"

#include <fmt/format.h>

namespace cellmirror::app {

web::Health loop_health(Nanoseconds age, Nanoseconds stands_still_after, const FaultStatus& faults) {
  if (age > stands_still_after)
    return {false, fmt::format("the loop stands still: its newest tick is {:.2f} s old", seconds(age))};
  if (faults.latched) return {false, fmt::format("the loop has not been on time lately: {}", faults.reason)};
  return {true, "ok"};
}

}  // namespace cellmirror::app
