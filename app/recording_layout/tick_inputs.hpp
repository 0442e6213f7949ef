// Records of a recording's inputs (rt_core/engine/input_tap.hpp) as plain data. From any bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/input_tap.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/tissue_force.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/rt/cyclic_thread.hpp"

namespace cellmirror::app {

using ByteSpan = std::span<const std::byte>;

struct TakenSample {
  std::uint8_t slot = 0;
  JointSample sample;
};

struct TakenHaptic {
  std::uint8_t channel = 0;
  std::uint8_t slot = 0;  // of the instrument's robot
  HapticRead outcome = HapticRead::none;
  std::optional<HapticSample> sample;
  std::optional<haptics::ContactModel> model;
  std::optional<haptics::TissueForce> tissue;
  std::optional<JointSample> moved;  // what the channel gave the robot
};

struct PublishedHaptic {
  std::uint8_t channel = 0;
  HapticState state;
};

// What is not the robots'.
struct TickInputs {
  CycleContext context;
  std::uint64_t commands_done = 0;
  std::uint64_t commands_refused = 0;
  std::vector<TakenSample> samples;
  std::vector<TakenHaptic> haptics;
  std::vector<PublishedHaptic> haptic_states;
};

// What each robot published: the parts of its state as bytes (transfer_part(), rt_core/engine/state_transfer.hpp), and
// as values.
class PublishedRobots {
 public:
  struct Robot {
    engine::RobotTickState state;
    std::array<engine::InputTap::PublishedPart, 11> parts{};
  };

  explicit PublishedRobots(std::size_t slots) : robots_(slots) {}
  // Of one robot in the record of a tick.
  void read(StateReader& in);
  [[nodiscard]] const std::vector<Robot>& robots() const { return robots_; }

 private:
  std::vector<Robot> robots_;
};

// Instants of recordings are before it, and UTC is less than this from each, so that sums of both do not overflow.
inline constexpr Timestamp kLatestInstant{std::int64_t{1} << 62};

// The record of a tick; changes of robots go into `robots`.
[[nodiscard]] Result<TickInputs> read_tick(ByteSpan record, PublishedRobots& robots);

struct RobotNames {
  std::string robot;
  std::vector<std::string> joints;
};
using NamesBySlot = std::map<std::uint8_t, RobotNames>;

// InputRecord::robots.
[[nodiscard]] std::vector<std::byte> names_record(const NamesBySlot& names);
[[nodiscard]] Result<NamesBySlot> read_names(ByteSpan record);

// A message of a recording, record by record. Fails where the message is of another version, or a length is wrong;
// `take` may end it.
[[nodiscard]] Result<void> for_each_record(ByteSpan message,
                                           const std::function<bool(engine::InputRecord kind, ByteSpan content)>& take);

}  // namespace cellmirror::app
