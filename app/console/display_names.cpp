#include "app/console/display_names.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "rt_core/base/text.hpp"
#include "rt_core/cell/short_names.hpp"

namespace cellmirror::app {

std::vector<std::string> display_names(std::vector<std::string> names) {
  constexpr std::size_t kMost = 200;  // characters
  for (std::string& name : names) name = printable(name, kMost);
  return names;
}

std::vector<std::string> short_names(const std::vector<std::string>& paths) {
  const std::set<std::string> different(paths.begin(), paths.end());
  const std::vector<std::string> all(different.begin(), different.end());
  return display_names(cellmirror::short_names(paths, all));
}

std::string point_text(const Eigen::Vector3d& p) {
  const auto shown = [](double value) { return std::abs(value) < 5e-4 ? 0.0 : value; };
  return fmt::format("{:.3f} {:.3f} {:.3f}", shown(p.x()), shown(p.y()), shown(p.z()));
}

}  // namespace cellmirror::app
