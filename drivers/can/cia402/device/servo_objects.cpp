#include "drivers/can/cia402/device/servo_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "drivers/can/canopen/slave.hpp"
#include "drivers/can/canopen/slave_pdos.hpp"
#include "drivers/can/cia402/device/homing.hpp"
#include "drivers/can/cia402/state.hpp"

namespace cellmirror::can {
namespace {

using enum DataType;

constexpr auto kServoRw = ObjectAccess::read_write;
constexpr auto kServoRo = ObjectAccess::read_only;
constexpr std::uint32_t kNotWatched = 0xFFFF'FFFF;  // 0x6065: no following error
constexpr std::array kModes{DriveMode::none,
                            DriveMode::profile_position,
                            DriveMode::profile_velocity,
                            DriveMode::profile_torque,
                            DriveMode::homing,
                            DriveMode::interpolated_position,
                            DriveMode::cyclic_sync_position,
                            DriveMode::cyclic_sync_velocity,
                            DriveMode::cyclic_sync_torque};

template <class Integer>
std::int64_t whole(double value) {
  return std::llround(
      std::clamp<double>(value, std::numeric_limits<Integer>::min(), std::numeric_limits<Integer>::max()));
}

struct Row {
  ObjectAddress address;
  DataType type;
  ObjectAccess access;
  bool mappable;
  std::int64_t value;
  const char* name;
};

// Object 0x6502: bit n - 1 for mode n.
std::int64_t supported_modes() {
  std::int64_t bits = 0;
  for (const DriveMode mode : kModes) {
    if (mode != DriveMode::none) bits |= std::int64_t{1} << (static_cast<int>(mode) - 1);
  }
  return bits;
}

void add_state_objects(std::vector<Row>& rows) {
  rows.insert(rows.end(), {
                              {{0x6007, 0}, integer16, kServoRw, false, 1, "abort connection option code"},
                              {{0x603F, 0}, unsigned16, kServoRo, true, 0, "error code"},
                              {{0x6040, 0}, unsigned16, kServoRw, true, 0, "controlword"},
                              {{0x6041, 0}, unsigned16, kServoRo, true, 0, "statusword"},
                              {{0x605A, 0}, integer16, kServoRw, false, 2, "quick stop option code"},
                              {{0x605B, 0}, integer16, kServoRw, false, 0, "shutdown option code"},
                              {{0x605C, 0}, integer16, kServoRw, false, 1, "disable operation option code"},
                              {{0x605D, 0}, integer16, kServoRw, false, 1, "halt option code"},
                              {{0x605E, 0}, integer16, kServoRw, false, 2, "fault reaction option code"},
                              {{0x6060, 0}, integer8, kServoRw, true, 0, "modes of operation"},
                              {{0x6061, 0}, integer8, kServoRo, true, 0, "modes of operation display"},
                              {{0x6502, 0}, unsigned32, kServoRo, false, supported_modes(), "supported drive modes"},
                              {{0x60FD, 0}, unsigned32, kServoRo, true, 0, "digital inputs"},
                              // The outputs are not connected.
                              {{0x60FE, 0}, unsigned8, kServoRo, false, 2, "digital outputs"},
                              {{0x60FE, 1}, unsigned32, kServoRw, true, 0, "physical outputs"},
                              {{0x60FE, 2}, unsigned32, kServoRw, true, 0, "bit mask"},
                              {{0x60B8, 0}, unsigned16, kServoRw, true, 0, "touch probe function"},
                              {{0x60B9, 0}, unsigned16, kServoRo, true, 0, "touch probe status"},
                          });
}

void add_position_objects(std::vector<Row>& rows, const DriveConfig& config) {
  const double scale = config.increments_per_unit();
  const auto increments = [scale](double units) { return whole<std::int32_t>(units * scale); };
  const auto position = [&](double joint) { return increments(config.sign * (joint - config.offset)); };
  // A continuous joint has no limits unless the cell file sets them.
  const DriveConfig unlimited;
  const bool turns = !config.stops && config.software_limits.lower <= unlimited.software_limits.lower &&
                     config.software_limits.upper >= unlimited.software_limits.upper;
  constexpr std::int64_t kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int32_t>::max();
  const std::int64_t a = turns ? kLowest : position(config.software_limits.lower);
  const std::int64_t b = turns ? kHighest : position(config.software_limits.upper);
  rows.insert(
      rows.end(),
      {
          {{0x6062, 0}, integer32, kServoRo, true, 0, "position demand value"},
          {{0x6063, 0}, integer32, kServoRo, true, 0, "position actual internal value"},
          {{0x6064, 0}, integer32, kServoRo, true, 0, "position actual value"},
          {{0x6065, 0}, unsigned32, kServoRw, true, increments(config.following_error), "following error window"},
          {{0x6066, 0}, unsigned16, kServoRw, true, 10, "following error time out"},
          {{0x6067, 0}, unsigned32, kServoRw, true, std::max<std::int64_t>(increments(0.001), 2), "position window"},
          {{0x6068, 0}, unsigned16, kServoRw, true, 5, "position window time"},
          {{0x607A, 0}, integer32, kServoRw, true, 0, "target position"},
          {{0x607C, 0}, integer32, kServoRw, true, 0, "home offset"},
          {{0x607B, 0}, unsigned8, kServoRo, false, 2, "position range limit"},
          {{0x607B, 1}, integer32, kServoRw, false, 0, "min position range limit"},
          {{0x607B, 2}, integer32, kServoRw, false, 0, "max position range limit"},
          {{0x607D, 0}, unsigned8, kServoRo, false, 2, "software position limit"},
          {{0x607D, 1}, integer32, kServoRw, true, std::min(a, b), "min position limit"},
          {{0x607D, 2}, integer32, kServoRw, true, std::max(a, b), "max position limit"},
          {{0x607E, 0}, unsigned8, kServoRw, false, 0, "polarity"},
          {{0x60F2, 0}, unsigned16, kServoRw, false, 0, "positioning option code"},
          {{0x60F4, 0}, integer32, kServoRo, true, 0, "following error actual value"},
          {{0x60C0, 0}, integer16, kServoRw, false, 0, "interpolation sub mode select"},
          {{0x60C1, 0}, unsigned8, kServoRo, false, 1, "interpolation data record"},
          {{0x60C1, 1}, integer32, kServoRw, true, 0, "interpolation set-point"},
          {{0x60C2, 0}, unsigned8, kServoRo, false, 2, "interpolation time period"},
          {{0x60C2, 1}, unsigned8, kServoRw, false, 1, "interpolation time period value"},
          {{0x60C2, 2}, integer8, kServoRw, false, -3, "interpolation time index"},
      });
}

void add_motion_objects(std::vector<Row>& rows, const DriveConfig& config) {
  const double scale = config.increments_per_unit();
  const auto rate = [scale](double units) { return std::max<std::int64_t>(1, whole<std::uint32_t>(units * scale)); };
  rows.insert(
      rows.end(),
      {
          {{0x606B, 0}, integer32, kServoRo, true, 0, "velocity demand value"},
          {{0x606C, 0}, integer32, kServoRo, true, 0, "velocity actual value"},
          {{0x606D, 0},
           unsigned16,
           kServoRw,
           true,
           std::min<std::int64_t>(rate(config.velocity / 100), 65535),
           "velocity window"},
          {{0x606E, 0}, unsigned16, kServoRw, true, 10, "velocity window time"},
          {{0x606F, 0},
           unsigned16,
           kServoRw,
           true,
           std::min<std::int64_t>(rate(config.velocity / 200), 65535),
           "velocity threshold"},
          {{0x6070, 0}, unsigned16, kServoRw, true, 10, "velocity threshold time"},
          {{0x607F, 0}, unsigned32, kServoRw, true, rate(config.velocity), "max profile velocity"},
          {{0x6081, 0}, unsigned32, kServoRw, true, rate(config.velocity / 4), "profile velocity"},
          {{0x6083, 0}, unsigned32, kServoRw, true, rate(config.acceleration), "profile acceleration"},
          {{0x6084, 0}, unsigned32, kServoRw, true, rate(config.acceleration), "profile deceleration"},
          {{0x6085, 0}, unsigned32, kServoRw, true, rate(2 * config.acceleration), "quick stop deceleration"},
          {{0x6086, 0}, integer16, kServoRw, true, 0, "motion profile type"},
          {{0x6098, 0}, integer8, kServoRw, true, 0, "homing method"},
          {{0x6099, 0}, unsigned8, kServoRo, false, 2, "homing speeds"},
          {{0x6099, 1}, unsigned32, kServoRw, true, rate(config.velocity / 10), "speed during search for switch"},
          {{0x6099, 2}, unsigned32, kServoRw, true, rate(config.velocity / 50), "speed during search for zero"},
          {{0x609A, 0}, unsigned32, kServoRw, true, rate(config.acceleration), "homing acceleration"},
          {{0x60B1, 0}, integer32, kServoRw, true, 0, "velocity offset"},
          {{0x60C5, 0}, unsigned32, kServoRw, true, std::numeric_limits<std::uint32_t>::max(), "max acceleration"},
          {{0x60C6, 0}, unsigned32, kServoRw, true, std::numeric_limits<std::uint32_t>::max(), "max deceleration"},
          {{0x60FF, 0}, integer32, kServoRw, true, 0, "target velocity"},
      });
}

void add_torque_objects(std::vector<Row>& rows, const DriveConfig& config) {
  const std::int64_t peak = std::min<std::int64_t>(whole<std::uint16_t>(1000 * config.peak_torque), 65535);
  rows.insert(rows.end(), {
                              {{0x6071, 0}, integer16, kServoRw, true, 0, "target torque"},
                              {{0x6072, 0}, unsigned16, kServoRw, true, peak, "max torque"},
                              {{0x6074, 0}, integer16, kServoRo, true, 0, "torque demand value"},
                              {{0x6076, 0},
                               unsigned32,
                               kServoRo,
                               false,
                               whole<std::uint32_t>(1000 * config.rated_torque),
                               "motor rated torque"},
                              {{0x6077, 0}, integer16, kServoRo, true, 0, "torque actual value"},
                              {{0x6078, 0}, integer16, kServoRo, true, 0, "current actual value"},
                              {{0x6079, 0}, unsigned32, kServoRo, true, 48'000, "DC link circuit voltage"},
                              {{0x6087, 0}, unsigned32, kServoRw, true, 10'000, "torque slope"},
                              {{0x6088, 0}, integer16, kServoRw, true, 0, "torque profile type"},
                              {{0x60B2, 0}, integer16, kServoRw, true, 0, "torque offset"},
                              {{0x60E0, 0}, unsigned16, kServoRw, true, peak, "positive torque limit value"},
                              {{0x60E1, 0}, unsigned16, kServoRw, true, peak, "negative torque limit value"},
                              {{0x2000, 0},
                               unsigned16,
                               kServoRw,
                               false,
                               whole<std::uint16_t>(1000 * config.blocked_after),
                               "motor blocked time out"},
                          });
}

void add_factor_objects(std::vector<Row>& rows, const DriveConfig& config) {
  const double per_shaft = static_cast<double>(config.encoder_increments) * config.gear_motor / config.gear_shaft;
  rows.insert(
      rows.end(),
      {
          {{0x608F, 0}, unsigned8, kServoRo, false, 2, "position encoder resolution"},
          {{0x608F, 1}, unsigned32, kServoRo, false, config.encoder_increments, "encoder increments"},
          {{0x608F, 2}, unsigned32, kServoRo, false, 1, "motor revolutions"},
          {{0x6091, 0}, unsigned8, kServoRo, false, 2, "gear ratio"},
          {{0x6091, 1}, unsigned32, kServoRo, false, config.gear_motor, "motor revolutions"},
          {{0x6091, 2}, unsigned32, kServoRo, false, config.gear_shaft, "shaft revolutions"},
          // Positions are in increments of the encoder: so many of them are the feed of one revolution of the shaft.
          {{0x6092, 0}, unsigned8, kServoRo, false, 2, "feed constant"},
          {{0x6092, 1}, unsigned32, kServoRo, false, whole<std::uint32_t>(per_shaft), "feed"},
          {{0x6092, 2}, unsigned32, kServoRo, false, 1, "shaft revolutions"},
      });
}

TpdoConfig pdo(std::uint8_t number, std::uint8_t transmission_type, std::vector<PdoEntryConfig> entries) {
  TpdoConfig config;
  config.number = number;
  config.transmission_type = transmission_type;
  config.entries = std::move(entries);
  return config;
}

}  // namespace

ObjectDictionary make_servo_objects(const DriveConfig& config, std::uint16_t heartbeat_ms) {
  ObjectDictionary objects;
  // Device type: profile 402, servo drive (bit 17).
  add_communication_objects(objects, config.node_id, {0x0002'0192, "cellmirror servo drive", heartbeat_ms});
  std::vector<Row> rows;
  add_state_objects(rows);
  add_position_objects(rows, config);
  add_motion_objects(rows, config);
  add_torque_objects(rows, config);
  add_factor_objects(rows, config);
  for (const Row& row : rows) {
    objects.set_integer(row.address, row.type, row.access, row.value, row.name, row.mappable);
  }
  constexpr std::array<ObjectAddress, 11> kPositive{{{0x607F, 0},
                                                     {0x6081, 0},
                                                     {0x6083, 0},
                                                     {0x6084, 0},
                                                     {0x6085, 0},
                                                     {0x609A, 0},
                                                     {0x60C5, 0},
                                                     {0x60C6, 0},
                                                     {0x6099, 1},
                                                     {0x6099, 2},
                                                     {0x60C2, 1}}};
  for (const ObjectAddress& address : kPositive) objects.find(address)->low_limit = 1;
  objects.find({0x60C2, 2})->low_limit = -6;
  objects.find({0x60C2, 2})->high_limit = 0;
  constexpr std::uint8_t kEverySync = 1;
  constexpr std::uint8_t kEvents = 255;
  const std::array rpdos{pdo(1, kEvents, {{0x6040, 0, 16}}), pdo(2, kEverySync, {{0x6040, 0, 16}, {0x607A, 0, 32}}),
                         pdo(3, kEverySync, {{0x6040, 0, 16}, {0x60FF, 0, 32}})};
  const std::array tpdos{pdo(1, kEvents, {{0x6041, 0, 16}}), pdo(2, kEverySync, {{0x6041, 0, 16}, {0x6064, 0, 32}}),
                         pdo(3, kEverySync, {{0x606C, 0, 32}, {0x6077, 0, 16}})};
  add_pdo_objects(objects, config.node_id, rpdos, tpdos);
  return objects;
}

std::optional<SdoAbort> check_servo_object(ObjectAddress address, std::int64_t value) {
  const auto among = [value](std::initializer_list<std::int64_t> known) -> std::optional<SdoAbort> {
    return std::ranges::find(known, value) != known.end() ? std::nullopt : std::optional(SdoAbort::invalid_value);
  };
  switch (address.index) {
    case 0x6007:
      return among({0, 1, 2, 3});
    case 0x605A:
      return among({0, 1, 2, 5, 6});
    case 0x605B:
    case 0x605C:
      return among({0, 1});
    case 0x605D:
      return among({1, 2});
    case 0x605E:
      return among({0, 1, 2});
    case 0x6060: {
      const bool known =
          std::ranges::any_of(kModes, [value](DriveMode mode) { return value == static_cast<int>(mode); });
      return known ? std::nullopt : std::optional(SdoAbort::invalid_value);
    }
    case 0x60F2:
      return among({0, 0x40, 0x80, 0xC0});
    // The cell file sets the directions; there is no touch probe.
    case 0x607E:
    case 0x60B8:
    case 0x6086:
    case 0x6088:
    case 0x60C0:
      return among({0});
    case 0x6098:
      return value == 0 || homing_method(static_cast<int>(value)) ? std::nullopt
                                                                  : std::optional(SdoAbort::invalid_value);
    default:
      return {};
  }
}

bool is_servo_command(ObjectAddress address) {
  switch (address.index) {
    case 0x6040:
    case 0x6060:
    case 0x6071:
    case 0x607A:
    case 0x60B1:
    case 0x60B2:
    case 0x60C1:
    case 0x60FF:
      return true;
    default:
      return false;
  }
}

ServoParameters read_servo_parameters(const ObjectDictionary& objects) {
  const auto number = [&](std::uint16_t index, std::uint8_t subindex = 0) {
    return static_cast<double>(objects.integer({index, subindex}).value_or(0));
  };
  const auto at_least_one = [&](std::uint16_t index, std::uint8_t subindex = 0) {
    return std::max(1.0, number(index, subindex));
  };
  const auto code = [&](std::uint16_t index) { return static_cast<int>(number(index)); };
  constexpr double kMilli = 1e-3;
  ServoParameters out;
  out.fastest = at_least_one(0x607F);
  const double most_acceleration = at_least_one(0x60C5);
  const double most_deceleration = at_least_one(0x60C6);
  out.profile = {std::min(at_least_one(0x6081), out.fastest), std::min(at_least_one(0x6083), most_acceleration),
                 std::min(at_least_one(0x6084), most_deceleration)};
  out.quick_deceleration = std::min(at_least_one(0x6085), most_deceleration);
  out.lower = number(0x607D, 1);
  out.upper = std::max(out.lower, number(0x607D, 2));
  // The lowest and the highest value of 32 bits mean no limit.
  constexpr double kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr double kHighest = std::numeric_limits<std::int32_t>::max();
  if (out.lower <= kLowest) out.lower = -std::numeric_limits<double>::infinity();
  if (out.upper >= kHighest) out.upper = std::numeric_limits<double>::infinity();
  const bool has_range = number(0x607B, 1) < number(0x607B, 2);
  out.range_lower = has_range ? number(0x607B, 1) : kLowest;
  out.range_span = (has_range ? number(0x607B, 2) : kHighest) - out.range_lower + 1;
  out.rotary_option = (code(0x60F2) >> 6) & 3;
  const double window = number(0x6065);
  out.following_window = window == kNotWatched ? -1.0 : window;
  out.following_time = kMilli * number(0x6066);
  out.position_window = number(0x6067);
  out.position_time = kMilli * number(0x6068);
  out.velocity_window = number(0x606D);
  out.velocity_time = kMilli * number(0x606E);
  out.standstill = number(0x606F);
  out.standstill_time = kMilli * number(0x6070);
  out.torque_slope = kMilli * at_least_one(0x6087);
  out.torque_limit = kMilli * number(0x6072);
  out.positive_torque_limit = kMilli * number(0x60E0);
  out.negative_torque_limit = kMilli * number(0x60E1);
  out.blocked_time = kMilli * number(0x2000);
  out.period = at_least_one(0x60C2, 1) * std::pow(10.0, number(0x60C2, 2));
  out.home_offset = number(0x607C);
  out.homing_fast = std::min(at_least_one(0x6099, 1), out.fastest);
  out.homing_slow = std::min(at_least_one(0x6099, 2), out.fastest);
  out.homing_acceleration = at_least_one(0x609A);
  out.homing_method = code(0x6098);
  out.quick_stop_option = code(0x605A);
  out.shutdown_option = code(0x605B);
  out.disable_option = code(0x605C);
  out.halt_option = code(0x605D);
  out.fault_option = code(0x605E);
  out.connection_option = code(0x6007);
  return out;
}

}  // namespace cellmirror::can
