#include "app/owner/tissue/effector_geometry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kListedGeometry = 8;  // names in a message

bool moves_with(const CompiledCell& cell, const CompiledRobot& robot, std::int32_t node) {
  for (; node >= 0; node = cell.parent[static_cast<std::size_t>(node)]) {
    const std::int32_t joint = cell.joint_of[static_cast<std::size_t>(node)];
    if (joint >= 0 && cell.joints[static_cast<std::size_t>(joint)].slot == robot.slot) return true;
  }
  return false;
}

std::string bare_name(const std::string& path) { return path.substr(path.rfind('.') + 1); }

}  // namespace

Result<void> check_effector_geometry(const CompiledCell& cell, const CompiledRobot& robot, std::string_view name) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& candidate) {
    if (!candidate.empty() && std::ranges::find(names, candidate) == names.end()) names.push_back(candidate);
  };
  for (const CompiledGeometry& geometry : cell.geometry) {
    if (!moves_with(cell, robot, geometry.node)) continue;
    const std::string& path = (*cell.paths)[static_cast<std::size_t>(geometry.node)];
    if (path == name || bare_name(path) == name || geometry.geometry->name == name) return {};
    add(bare_name(path));
    // SCRIPT cannot name what has a blank in its name.
    if (geometry.geometry->name.find(' ') == std::string::npos) add(geometry.geometry->name);
  }
  if (names.empty())
    return fail(fmt::format("{} has no geometry that moves with it", robot.id), "activate another robot with ROBACT");
  std::string remedy = did_you_mean(name, names);
  if (remedy.empty()) {
    // The effector is at the end of the chain.
    if (names.size() > kListedGeometry) names.erase(names.begin(), names.end() - kListedGeometry);
    remedy = fmt::format("it has {}", fmt::join(names, ", "));
  }
  return fail(fmt::format("{} is no geometry of {}", printable(name), robot.id), std::move(remedy));
}

}  // namespace cellmirror::app
