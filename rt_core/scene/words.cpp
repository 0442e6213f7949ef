#include "rt_core/scene/words.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cellmirror::scene {

std::string distance_text(double distance_m) {
  if (!std::isfinite(distance_m)) return "?";
  // 0.9996 m would be rounded to 1000 mm.
  if (std::abs(distance_m) < 0.9995) return fmt::format("{:.0f} mm", 1e3 * distance_m);
  return fmt::format("{:.2f} m", distance_m);
}

std::string age_text(double age_s) {
  if (!std::isfinite(age_s)) return "?";
  if (age_s < 9.95) return fmt::format("{:.1f} s", age_s);
  if (age_s < 119.5) return fmt::format("{:.0f} s", age_s);
  if (age_s < 7170.0) return fmt::format("{:.0f} min", age_s / 60.0);
  return fmt::format("{:.0f} h", age_s / 3600.0);
}

std::string_view state_text(DataState state) {
  switch (state) {
    case DataState::none:
      return "no data";
    case DataState::fresh:
      return "";
    case DataState::stale:
      return "stale";
    case DataState::lost:
      return "lost";
    case DataState::invalid:
      return "invalid";
    case DataState::implausible:
      return "implausible";
    case DataState::conflict:
      return "two senders";
  }
  return "";
}

std::string quantity_text(double value, std::string_view unit) {
  if (std::abs(value) >= 1000.0) return fmt::format("{:g} k{}", 1e-3 * value, unit);
  if (std::abs(value) > 0.0 && std::abs(value) < 0.01) return fmt::format("{:g} m{}", 1e3 * value, unit);
  return fmt::format("{:g} {}", value, unit);
}

}  // namespace cellmirror::scene
