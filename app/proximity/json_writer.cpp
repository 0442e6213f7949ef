#include "app/proximity/json_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace cellmirror::app {

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string json_point(const Eigen::Vector3d& p) {
  return fmt::format("[{},{},{}]", json_number(p.x()), json_number(p.y()), json_number(p.z()));
}

}  // namespace cellmirror::app
