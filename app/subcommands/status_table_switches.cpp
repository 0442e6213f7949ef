#include "app/subcommands/status_table_switches.hpp"

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/counted.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

std::string script_line(const json& switches) {
  const json& scripts = switches.at("scripts");
  std::string out =
      fmt::format("  scripts: {} run, {} wait", count(scripts.at("started")), count(scripts.at("waiting")));
  for (const char* what : {"missing", "refused", "dropped", "with_errors"}) {
    if (count(scripts.at(what)) > 0) out += fmt::format(", {} {}", count(scripts.at(what)), what);
  }
  const json& last = switches.at("last_script");
  if (last.is_object()) {
    out += fmt::format("; last {} {:.1f} s ago{}", last.at("file").get<std::string>(), last.at("age_s").get<double>(),
                       last.at("running").get<bool>() ? ", running" : "");
  }
  const json& first = switches.at("first_command_ms");
  out += fmt::format("; first command after p50 {} p99 {} ms\n", milliseconds(first.at("p50"), 2),
                     milliseconds(first.at("p99"), 2));
  return out;
}

std::string inputs_text(const json& inputs) {
  if (inputs.empty()) return "none";
  std::string out;
  for (const json& input : inputs) out += fmt::format("{}{}", out.empty() ? "" : " ", count(input));
  return out;
}

}  // namespace

std::string switches_table(const json& status) {
  if (!status.contains("foot_switches")) return {};
  const json& switches = status.at("foot_switches");
  if (!switches.at("key").is_number()) return {};
  const bool online = switches.at("online").get<bool>();
  std::string out = fmt::format("\nfoot switches  {}, key {}, {}, {} attached", online ? "online" : "offline",
                                count(switches.at("key")), number_of(count(switches.at("inputs")), "input"),
                                count(switches.at("attached")));
  if (online) out += fmt::format("; on: {}", inputs_text(switches.at("inputs_on")));
  out += fmt::format("; {}, {}", number_of(count(switches.at("edges")), "change"),
                     number_of(count(switches.at("bounces")), "bounce"));
  if (count(switches.at("edges_dropped")) > 0) out += fmt::format(", {} dropped", count(switches.at("edges_dropped")));
  out += "\n" + script_line(switches);
  for (const json& file : switches.at("missing_files"))
    out += fmt::format("  there is no scripts/{}\n", file.get<std::string>());
  const std::string trouble = switches.at("trouble").get<std::string>();
  if (!trouble.empty()) out += fmt::format("  trouble: {}\n", trouble);
  return out;
}

std::string couplings_table(const json& status) {
  if (!status.contains("couplings")) return {};
  std::string out;
  for (const json& coupling : status.at("couplings")) {
    out += fmt::format("{} follows {}: {};", coupling.at("slave").get<std::string>(),
                       coupling.at("master").get<std::string>(), coupling.at("state").get<std::string>());
    for (const json& joint : coupling.at("joints")) {
      out += fmt::format(" {}={}{}", joint.at("slave").get<std::string>(), joint.at("master").get<std::string>(),
                         joint.at("limited").get<bool>() ? " (limited)" : "");
    }
    out += "\n";
  }
  return out;
}

}  // namespace cellmirror::app
