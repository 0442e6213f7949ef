// Writes the flight recorder's histories to a file that people and programs can read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/engine/flight_record.hpp"

namespace cellmirror::app {

struct FlightFileHeader {
  std::string reason;  // "request", "loop stood still", ...
  std::string cell;
  std::string instance;
  double rate_hz = 0;
  std::vector<std::string> robots;  // by slot; empty where a slot is not used
};

// JSON Lines: a header, then a line a tick ("kind":"tick"), then a line a sample or set point ("kind":"robot"), each in
// the order of time; units in the keys (docs/flight-recorder.md). Compressed (gzip) where the path ends in .gz; whole
// or not there at all (record_file.hpp). Not for the tick.
Result<void> write_flight_file(const std::filesystem::path& path, const FlightFileHeader& header,
                               const std::vector<engine::FlightTick>& ticks,
                               const std::vector<engine::FlightRobot>& robots);

}  // namespace cellmirror::app
