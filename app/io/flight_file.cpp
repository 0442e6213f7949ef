#include "app/io/flight_file.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "app/io/record_file.hpp"
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
  auto file = RecordFile::create(path);
  if (!file) return std::unexpected(file.error());
  std::string out;
  const auto flush = [&](std::size_t at_least) -> Result<void> {
    if (out.size() < at_least) return {};
    return file->write(std::exchange(out, {}));
  };
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  out += header_line(header) + "\n";
  for (const engine::FlightTick& record : ticks) {
    append_tick(out, record);
    if (auto written = flush(kChunk); !written) return written;
  }
  for (const engine::FlightRobot& record : robots) {
    append_robot(out, record, header);
    if (auto written = flush(kChunk); !written) return written;
  }
  if (auto written = flush(1); !written) return written;
  return file->finish();
}

}  // namespace cellmirror::app
