// Names and words behind the numbers in what the simulation of tissue publishes.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "app/snapshot/cell_state.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

// "" for -1, and for a number of an older state of the cell.
[[nodiscard]] inline std::string robot_name(const CellState& cell, std::int16_t slot) {
  const auto robot = std::ranges::find_if(
      cell.robots, [&](const RobotSnapshot& one) { return slot >= 0 && one.slot == static_cast<std::size_t>(slot); });
  return robot == cell.robots.end() ? std::string() : robot->id;
}

[[nodiscard]] inline std::string object_name(const TissueState& state, std::int16_t object) {
  const auto index = static_cast<std::size_t>(object);
  return object >= 0 && index < state.objects.size() ? state.objects[index].name : std::string();
}

[[nodiscard]] inline std::string_view vessel_word(const TissueVesselState& vessel) {
  constexpr std::array<std::string_view, 3> kWords = {"artery", "vein", "duct"};  // by tissue::VesselKind
  return vessel.kind < kWords.size() ? kWords.at(vessel.kind) : std::string_view("unknown");
}

}  // namespace cellmirror::app
