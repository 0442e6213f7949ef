#include "app/subcommands/status_table_forces.hpp"

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/counted.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

std::string joint_text(const json& joint) {
  const bool slides = joint.contains("effort_n");
  std::string out = fmt::format(" {} {:.1f} {}", text(joint.at("name")),
                                joint.at(slides ? "effort_n" : "effort_nm").get<double>(), slides ? "N" : "Nm");
  if (joint.at("beyond_limit").get<bool>()) {
    out += fmt::format(" (BEYOND {:.1f})", joint.at(slides ? "max_effort_n" : "max_effort_nm").get<double>());
  }
  return out;
}

std::string robot_lines(const json& robot) {
  std::string out = fmt::format("  {}", text(robot.at("id")));
  if (robot.at("computed").get<bool>()) {
    out += fmt::format(" {:.1f} kg", robot.at("model_kg").get<double>());
    const double payload = robot.at("payload_kg").get<double>();
    if (payload > 0.0) out += fmt::format(" and {:.1f} kg attached", payload);
    out += ":";
    for (const json& joint : robot.at("joints")) out += joint_text(joint);
  }
  const json& tcp = robot.at("tcp");
  if (tcp.is_object()) {
    const json& force = tcp.at("force_n");
    const double size = std::hypot(force.at(0).get<double>(), force.at(1).get<double>(), force.at(2).get<double>());
    // A robot that holds nothing has none worth a word.
    if (size > 0.0 || !robot.at("computed").get<bool>()) out += fmt::format(" TCP {:.2f} N", size);
  }
  return out + "\n";
}

}  // namespace

std::string forces_table(const json& status) {
  if (!status.contains("forces")) return {};
  const json& forces = status.at("forces");
  if (!forces.at("active").get<bool>() && forces.at("not_computed").empty()) return {};
  const json& median = forces.at("compute_us").at("p50");
  const std::string cost = median.is_number() ? fmt::format("{:.1f}", median.get<double>()) : std::string("-");
  std::string out =
      fmt::format("\nforces  {:.0f} Hz, computed in p50 {} us; limits passed {}\n", forces.at("rate_hz").get<double>(),
                  cost, number_of(forces.at("limit_warnings").get<std::uint64_t>(), "time"));
  for (const json& robot : forces.at("robots")) out += robot_lines(robot);
  for (const json& robot : forces.at("not_computed"))
    out += fmt::format("  {} not computed: {}\n", text(robot.at("id")), text(robot.at("why")));
  return out;
}

}  // namespace cellmirror::app
