#include "app/subcommands/status_table_haptics.hpp"

#include "app/subcommands/status_words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

std::string age_in_ms(const json& age_s) {
  return age_s.is_number() ? fmt::format("{:.1f} ms", age_s.get<double>() * 1e3) : std::string("-");
}

double norm(const json& v) { return std::hypot(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()); }

std::string memory_text(const json& memory) {
  if (!memory.is_object()) return "no shared memory";
  return fmt::format("key {} ({} bytes, {} attached)", memory.at("key").get<std::int64_t>(),
                     memory.at("bytes").get<std::uint64_t>(), memory.at("attached").get<std::uint64_t>());
}

std::string way_out(const json& haptic) {
  if (text(haptic.at("awaits")) == "reset")
    return fmt::format("{}; then RESET_HAPTIC {}", text(haptic.at("remedy")), text(haptic.at("robot")));
  return fmt::format("engages again by itself, waits for {}", text(haptic.at("awaits_note")));
}

std::string device_lines(const json& haptic) {
  const json& device = haptic.at("device");
  const json& force = haptic.at("force");
  const json& latency = haptic.at("latency_us");
  std::string out = fmt::format("haptic {}  {}  {}\n", text(haptic.at("robot")),
                                haptic.at("online").get<bool>() ? text(haptic.at("phase")) : "offline",
                                memory_text(haptic.at("memory")));
  if (text(haptic.at("fault")) != "none") {
    out +=
        fmt::format("  FAULT {}: {}; {}\n", text(haptic.at("fault")), text(haptic.at("fault_note")), way_out(haptic));
  }
  if (!haptic.at("online").get<bool>()) return out;
  if (haptic.at("contact_model").at("awaited").get<bool>()) out += "  waits for the surroundings of its instrument\n";
  out += fmt::format("  device: process {}, sample {} of age {}; {} skipped, {} torn; force {:.2f} N, {} contacts\n",
                     device.at("process").get<std::uint64_t>(), device.at("sequence").get<std::uint64_t>(),
                     age_in_ms(device.at("age_s")), device.at("skipped").get<std::uint64_t>(),
                     device.at("torn").get<std::uint64_t>(), norm(force.at("world_n")),
                     force.at("contacts").get<std::uint64_t>());
  out += fmt::format("  pose to force p50 {:.0f} p99 {:.0f} max {:.0f} us; contact model of age {}; {} faults\n",
                     latency.at("p50").get<double>(), latency.at("p99").get<double>(), latency.at("max").get<double>(),
                     age_in_ms(haptic.at("contact_model").at("age_s")), haptic.at("faults").get<std::uint64_t>());
  return out;
}

std::string tcp_force_line(const json& force) {
  if (!force.is_object() || text(force.at("robot")).empty()) return {};  // no robot is active
  const bool valid = force.at("valid").get<bool>();
  const char* mark = force.at("beyond_limit").get<bool>() ? " BEYOND LIMIT" : "";
  return fmt::format(
      "TCP force of {}: {}{}{}\n", text(force.at("robot")),
      valid ? fmt::format("{:.2f} N, {:.3f} Nm", norm(force.at("force_n")), force.at("torque_nm").get<double>())
            : std::string("not known"),
      force.at("test").get<bool>() ? " (test values)" : "", mark);
}

}  // namespace

std::string haptics_table(const json& status) {
  if (!status.contains("haptics")) return {};
  const json& haptics = status.at("haptics");
  std::string out;
  for (const json& haptic : haptics.at("devices")) out += device_lines(haptic);
  out += tcp_force_line(haptics.at("tcp_force"));
  return out.empty() ? out : "\n" + out;
}

}  // namespace cellmirror::app
