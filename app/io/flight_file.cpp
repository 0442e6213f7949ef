#include "app/io/flight_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

namespace {

const char* word(engine::FlightEvent event) {
  switch (event) {
    case engine::FlightEvent::sample:
      return "sample";
    case engine::FlightEvent::setpoint:
      return "setpoint";
    case engine::FlightEvent::refused_command:
      return "refused_command";
  }
  return "sample";
}

std::string header_line(const FlightFileHeader& header) {
  const nlohmann::json line = {{"kind", "header"},       {"format", "cellmirror-flight-1"}, {"reason", header.reason},
                               {"cell", header.cell},    {"instance", header.instance},     {"rate_hz", header.rate_hz},
                               {"robots", header.robots}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void append_tick(std::string& out, const engine::FlightTick& record) {
  JsonWriter line;
  line.begin_object()
      .member("kind", "tick")
      .member("tick", record.tick)
      .member("time_ns", record.time.ns)
      .fixed_member("wakeup_latency_us", record.wakeup_latency_ns * 1e-3, 3)
      .fixed_member("compute_us", record.compute_ns * 1e-3, 3)
      .member("missed", record.missed_periods)
      .member("commands", record.commands)
      .member("samples", record.samples)
      .end_object();
  out += line.take() + "\n";
}

void append_robot(std::string& out, const engine::FlightRobot& record, const FlightFileHeader& header) {
  constexpr int kDigitsOfFloat = 7;
  JsonWriter line(kDigitsOfFloat);
  line.begin_object()
      .member("kind", "robot")
      .member("event", word(record.event))
      .member("robot", record.slot < header.robots.size() ? header.robots[record.slot] : std::string())
      .member("tick", record.tick)
      .member("time_ns", record.time.ns)
      .member("sequence", record.sequence)
      .key("position")
      .begin_array();
  for (std::size_t i = 0; i < record.joint_count; ++i) line.value(double{record.position[i]});
  line.end_array().end_object();
  out += line.take() + "\n";
}

}  // namespace

Result<void> write_flight_file(const std::filesystem::path& path, const FlightFileHeader& header,
                               const std::vector<engine::FlightTick>& ticks,
                               const std::vector<engine::FlightRobot>& robots) {
  std::filesystem::path temporary = path;
  temporary += ".part";
  const auto failed = [&] {
    return fail(fmt::format("{} cannot be written: {}", temporary.string(), std::strerror(errno)));
  };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "we"), std::fclose);
  if (!file) return failed();
  std::string out;
  const auto flush = [&](std::size_t at_least) {
    if (out.size() < at_least) return true;
    const bool written = std::fwrite(out.data(), 1, out.size(), file.get()) == out.size();
    out.clear();
    return written;
  };
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  out += header_line(header) + "\n";
  for (const engine::FlightTick& record : ticks) {
    append_tick(out, record);
    if (!flush(kChunk)) return failed();
  }
  for (const engine::FlightRobot& record : robots) {
    append_robot(out, record, header);
    if (!flush(kChunk)) return failed();
  }
  if (!flush(1) || std::fclose(file.release()) != 0) return failed();
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) return fail(fmt::format("{} cannot be renamed: {}", temporary.string(), error.message()));
  return {};
}

}  // namespace cellmirror::app
