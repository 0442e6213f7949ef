#include "app/subcommands/status_table_controllers.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/counted.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

std::string controller_lines(const json& controller) {
  std::string out = fmt::format(
      "controller {} of {}: {}, {} taken, {} refused", controller.at("name").get<std::string>(),
      controller.at("robot").get<std::string>(), number_of(count(controller.at("publishers")), "publisher"),
      number_of(count(controller.at("taken")), "trajectory", "trajectories"), count(controller.at("refused")));
  const json& trajectory = controller.at("trajectory");
  if (trajectory.is_object())
    out += fmt::format("; {} {}: {:.2f} of {:.2f} s", count(trajectory.at("number")),
                       trajectory.at("state").get<std::string>(), trajectory.at("elapsed_s").get<double>(),
                       trajectory.at("duration_s").get<double>());
  out += "\n  " + controller.at("endpoint").get<std::string>() + "\n";
  const json& last = controller.at("last_refusal");
  if (last.is_object())
    out +=
        fmt::format("  refused {:.0f} s ago: {}\n", last.at("age_s").get<double>(), last.at("text").get<std::string>());
  return out;
}

}  // namespace

std::string controllers_table(const json& status) {
  if (!status.contains("controllers")) return {};
  std::string out;
  for (const json& controller : status.at("controllers")) out += controller_lines(controller);
  return out;
}

}  // namespace cellmirror::app
