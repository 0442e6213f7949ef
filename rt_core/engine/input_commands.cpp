#include "rt_core/engine/input_commands.hpp"

#include <utility>
#include <vector>

#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/instrument_bytes.hpp"
#include "rt_core/engine/state_transfer.hpp"
#include "rt_core/engine/trajectory_bytes.hpp"

namespace cellmirror {

template <class Archive>
void transfer(Archive& archive, engine::RobotSetup& value) {
  archive.bounded(value.joint_count, kMaxJointsPerRobot);
  archive(value.positions, value.limits);
}

}  // namespace cellmirror

namespace cellmirror::engine {

namespace {

using haptics::Instrument;

// One list of members for both directions; what is lent is copied, or made and lent.
template <class Archive>
struct Members {
  Archive& archive;
  const CommandParts* parts;  // null where it writes

  template <class T>
  void lent(Lease<const T>& lease) const {
    bool there = static_cast<bool>(lease);
    archive(there);
    if (!there || !archive.ok()) return;
    if constexpr (Archive::kReads) {
      const auto made = std::make_shared<T>();
      archive(*made);
      if (archive.ok()) lease = parts->engine.lend(std::shared_ptr<const T>(made));
    } else {
      T copy = *lease;
      archive(copy);
    }
  }

  void operator()(AddRobot& one) const {
    archive(one.slot);
    lent(one.robot);
  }
  void operator()(RemoveRobot& one) const { archive(one.slot); }
  void operator()(SetMode& one) const {
    archive(one.slot, one.given, one.ages.stale_after, one.ages.lost_after);
    archive.choice(one.mode, RobotMode::mirrored);
    lent(one.plausibility);
    if constexpr (Archive::kReads) {
      // A slot becomes unused by RemoveRobot alone.
      if (one.mode == RobotMode::absent) archive.fail();
    }
  }
  void operator()(SetPositions& one) const { archive(one.slot, one.positions); }
  void operator()(SetLimits& one) const {
    archive(one.slot);
    lent(one.limits);
  }
  void operator()(SetChain& one) const {
    archive(one.slot);
    bool there = static_cast<bool>(one.chain);
    archive(there);
    if (!there || !archive.ok()) return;
    if constexpr (Archive::kReads) {
      std::uint64_t id = 0;
      archive(id);
      if (auto chain = read_chain(archive)) one.chain = parts->engine.lend(parts->chain(id, *std::move(chain)));
    } else {
      const kinematics::Chain* chain = one.chain.get();
      archive.reference(chain);
      write_chain(archive, *chain);
    }
  }
  void operator()(AddMove& one) const {
    archive(one.slot);
    lent(one.move);
  }
  void operator()(StopMotion& one) const { archive(one.slot); }
  void operator()(SetPace& one) const { archive(one.slot, one.pace); }
  void operator()(HoldBehind& one) const { archive(one.slot, one.move); }
  void operator()(FollowTrajectory& one) const {
    archive(one.slot);
    bool there = static_cast<bool>(one.trajectory);
    archive(there);
    if (!there || !archive.ok()) return;
    if constexpr (Archive::kReads) {
      if (auto read = read_trajectory(archive))
        one.trajectory = parts->engine.lend(std::make_shared<const motion::Trajectory>(*std::move(read)));
    } else {
      write_trajectory(archive, *one.trajectory);
    }
  }
  void operator()(Couple& one) const { lent(one.coupling); }
  void operator()(Uncouple& one) const { archive(one.slot); }
  void operator()(OpenHaptic& one) const;
  void operator()(CloseHaptic& one) const { archive(one.channel); }
  void operator()(ResetHaptic& one) const { archive(one.channel); }
  void operator()(SetDeviceGone& one) const { archive(one.channel, one.gone); }
};

template <class Archive>
void Members<Archive>::operator()(OpenHaptic& one) const {
  bool there = one.instrument && one.device;
  archive(one.channel, there);
  if (!there || !archive.ok()) return;
  if constexpr (Archive::kReads) {
    std::uint64_t id = 0;
    archive(id);
    auto instrument = read_instrument(archive);
    if (!instrument) return;
    one.device = parts->engine.lend(parts->device(one.channel, id));
    one.instrument = parts->engine.lend(std::make_shared<const Instrument>(*std::move(instrument)));
  } else {
    const HapticDevicePort* device = one.device.get();
    archive.reference(device);
    write_instrument(archive, *one.instrument);
  }
}

template <std::size_t I = 0, class Variant>
bool choose(Variant& variant, std::size_t index) {
  if constexpr (I < std::variant_size_v<Variant>) {
    if (I != index) return choose<I + 1>(variant, index);
    variant.template emplace<I>();
    return true;
  } else {
    return false;
  }
}

}  // namespace

std::size_t most_bytes_of(const Command& command) {
  constexpr std::size_t kMostCommandBytes = std::size_t{64} << 10;
  const auto* const motion = std::get_if<MotionCommand>(&command);
  const auto* const follow = motion == nullptr ? nullptr : std::get_if<FollowTrajectory>(motion);
  if (follow == nullptr || !follow->trajectory) return kMostCommandBytes;
  return kMostCommandBytes + bytes_of(*follow->trajectory);
}

void write_command(StateWriter& out, Command& command) {
  auto group = static_cast<std::uint8_t>(command.index());
  out(group);
  with_alternative(command, [&out](auto& of_group) noexcept {
    auto kind = static_cast<std::uint8_t>(of_group.index());
    out(kind);
    return true;
  });
  const Members<StateWriter> members{out, nullptr};
  with_command(command, [&members](auto& one) noexcept {
    members(one);
    return true;
  });
}

std::optional<Command> read_command(StateReader& in, const CommandParts& parts) {
  std::uint8_t group = 0;
  std::uint8_t kind = 0;
  in(group, kind);
  Command command;
  const bool known = in.ok() && choose(command, group) &&
                     with_alternative(command, [kind](auto& of_group) noexcept { return choose(of_group, kind); });
  if (!known) {
    in.fail();
    return std::nullopt;
  }
  const Members<StateReader> members{in, &parts};
  with_command(command, [&members](auto& one) noexcept {
    members(one);
    return true;
  });
  if (!in.ok() || !in.at_end()) return std::nullopt;
  return command;
}

}  // namespace cellmirror::engine
