// Reads [[stream.e2e]]: counters and CRCs of DBC messages.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/stream_reader.hpp"

namespace cellmirror {

namespace {

constexpr int kMostIdNumbers = 16;

// One number, or a list of them; what a profile needs is checked with the DBC.
std::vector<std::uint16_t> read_data_id(TableReader& reader, E2eProfile profile) {
  const bool one_number = profile == E2eProfile::p01 || profile == E2eProfile::p05;
  if (one_number) {
    reader.require("data_id");
    const auto number = reader.integer("data_id", 0, 0xFFFF);
    return number ? std::vector{static_cast<std::uint16_t>(*number)} : std::vector<std::uint16_t>{0};
  }
  std::vector<std::uint16_t> id;
  const bool listed = profile == E2eProfile::p02;
  if (listed) reader.require("data_ids");
  // A described format may do without.
  const auto count =
      static_cast<std::size_t>(listed ? kMostIdNumbers : reader.integer("data_id_bytes", 0, 16).value_or(0));
  if (count == 0) return id;
  const auto numbers = reader.numbers("data_ids", count, {0.0, 255.0});
  if (!numbers) return std::vector<std::uint16_t>(count, 0);
  for (const double number : *numbers) {
    if (number != std::floor(number)) reader.error("data_ids", "a data id is a whole number");
    id.push_back(static_cast<std::uint16_t>(number));
  }
  return id;
}

void read_described(TableReader& reader, E2eConfig& config) {
  for (const char* key : {"counter", "crc", "crc_polynomial"}) reader.require(key);
  config.counter_signal = reader.text("counter").value_or("");
  config.crc_signal = reader.text("crc").value_or("");
  config.crc.width = static_cast<std::uint8_t>(reader.integer("crc_bits", 8, 16).value_or(8));
  if (config.crc.width != 8 && config.crc.width != 16) reader.error("crc_bits", "crc_bits is 8 or 16");
  const long long most = config.crc.width == 8 ? 0xFF : 0xFFFF;
  config.crc.polynomial = static_cast<std::uint16_t>(reader.integer("crc_polynomial", 1, most).value_or(1));
  config.crc.initial = static_cast<std::uint16_t>(reader.integer("crc_initial", 0, most).value_or(0));
  config.crc.final_xor = static_cast<std::uint16_t>(reader.integer("crc_xor", 0, most).value_or(0));
  config.last_counter = static_cast<std::uint16_t>(reader.integer("last_counter", 2, 0xFFFF).value_or(0));
  config.data_id_first = reader.boolean("data_id_first").value_or(false);
}

}  // namespace

std::vector<E2eConfig> read_protections(TableReader& stream) {
  constexpr std::size_t kMostProtections = 256;
  std::vector<E2eConfig> protections;
  for (TableReader& reader : stream.tables("e2e", kMostProtections)) {
    E2eConfig config;
    config.place = reader.place();
    reader.require("message");
    reader.require("profile");
    config.message = reader.text("message").value_or("");
    const auto profile = reader.choice<E2eProfile>("profile", {{"p01", E2eProfile::p01},
                                                               {"p02", E2eProfile::p02},
                                                               {"p05", E2eProfile::p05},
                                                               {"described", E2eProfile::described}});
    if (!profile) continue;  // which keys belong here depends on it
    config.profile = *profile;
    config.data_id = read_data_id(reader, *profile);
    config.max_delta = static_cast<std::uint8_t>(reader.integer("max_delta", 1, 255).value_or(1));
    if (*profile == E2eProfile::p01) {
      config.data_id_mode = reader
                                .choice<E2eDataIdMode>("data_id_mode", {{"both", E2eDataIdMode::both},
                                                                        {"alternating", E2eDataIdMode::alternating},
                                                                        {"low", E2eDataIdMode::low},
                                                                        {"nibble", E2eDataIdMode::nibble}})
                                .value_or(E2eDataIdMode::both);
    }
    if (*profile == E2eProfile::described) read_described(reader, config);
    reader.finish();
    protections.push_back(std::move(config));
  }
  return protections;
}

}  // namespace cellmirror
