#include "app/subcommands/status_table_programs.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

std::string word(const json& value) { return value.get<std::string>(); }

// "12.3 of 45.6 s", "12.3 s"; empty before the first run.
std::string times(const json& program) {
  if (program.at("runs").get<std::uint64_t>() == 0 && program.at("elapsed_s").get<double>() == 0) return {};
  const double elapsed = program.at("elapsed_s").get<double>();
  const json& expected = program.at("expected_s");
  return expected.is_number() ? fmt::format("  {:.1f} of {:.1f} s", elapsed, expected.get<double>())
                              : fmt::format("  {:.1f} s", elapsed);
}

std::string program_line(const json& program) {
  std::string out = fmt::format("  {} of {}  {} {}", word(program.at("program")), word(program.at("robot")),
                                word(program.at("language")), word(program.at("state")));
  if (!word(program.at("waits_for")).empty()) out += " for " + word(program.at("waits_for"));
  if (word(program.at("direction")) == "backward") out += ", backward";
  if (!word(program.at("step")).empty()) out += ", at " + word(program.at("step"));
  out += times(program) + "\n";
  if (!word(program.at("error")).empty()) out += "    " + word(program.at("error")) + "\n";
  return out;
}

std::string numbers(const json& list) {
  std::string out;
  for (const json& number : list) out += fmt::format(" {}", number.get<std::uint64_t>());
  return out;
}

std::string values(const json& list) {
  std::string out;
  for (const json& entry : list)
    out += fmt::format(" {}={:g}", entry.at("number").get<std::uint64_t>(), entry.at("value").get<double>());
  return out;
}

std::string signals_line(const json& robot) {
  std::string out = "  signals of " + word(robot.at("robot")) + ":";
  const auto group = [&out](const char* title, const std::string& list) {
    if (!list.empty()) out += fmt::format("  {}{}", title, list);
  };
  group("inputs on", numbers(robot.at("inputs_on")));
  group("outputs on", numbers(robot.at("outputs_on")));
  group("analogue inputs", values(robot.at("analogue_inputs")));
  group("analogue outputs", values(robot.at("analogue_outputs")));
  return out + "\n";
}

std::string semaphores_line(const json& semaphores) {
  std::string out;
  for (const auto& [name, count] : semaphores.items()) out += fmt::format(" {}={}", name, count.get<std::uint64_t>());
  return out.empty() ? out : "  semaphores" + out + "\n";
}

}  // namespace

std::string programs_table(const json& status) {
  if (!status.contains("programs")) return {};  // an older gateway
  const json& programs = status.at("programs");
  const json& loaded = programs.at("loaded");
  const json loading = programs.value("loading", json::array());  // an older gateway has none
  if (loaded.empty() && loading.empty() && programs.at("recordings").empty() && programs.at("signals").empty())
    return {};
  std::string out =
      fmt::format("\nprograms  {} loaded, {} failures\n", loaded.size(), programs.at("failures").get<std::uint64_t>());
  for (const json& program : loaded) out += program_line(program);
  for (const json& load : loading)
    out += fmt::format("  loading {} of {}\n", word(load.at("program")), word(load.at("robot")));
  for (const json& recording : programs.at("recordings")) {
    out += fmt::format("  recording {} of {}, {} check points\n", word(recording.at("program")),
                       word(recording.at("robot")), recording.at("points").get<std::uint64_t>());
  }
  for (const json& robot : programs.at("signals")) out += signals_line(robot);
  out += semaphores_line(programs.at("semaphores"));
  if (programs.at("deadlock").is_object()) out += "  " + word(programs.at("deadlock").at("text")) + "\n";
  return out;
}

}  // namespace cellmirror::app
