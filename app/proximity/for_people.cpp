#include "app/proximity/for_people.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

std::vector<std::string> short_names(const std::vector<std::string>& paths) {
  constexpr std::size_t kMost = 200;  // characters
  const auto ends_of = [](const std::string& path) {
    const std::size_t first = path.find('.');
    const std::size_t last = path.rfind('.');
    return first == last ? path : path.substr(0, first) + path.substr(last);
  };
  std::map<std::string, int> uses;
  for (const std::string& path : paths) ++uses[ends_of(path)];
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const std::string& path : paths) {
    const std::string ends = ends_of(path);
    names.push_back(printable(uses[ends] == 1 ? ends : path, kMost));
  }
  return names;
}

std::string point_text(const Eigen::Vector3d& p) {
  const auto shown = [](double value) { return std::abs(value) < 5e-4 ? 0.0 : value; };
  return fmt::format("{:.3f} {:.3f} {:.3f}", shown(p.x()), shown(p.y()), shown(p.z()));
}

}  // namespace cellmirror::app
