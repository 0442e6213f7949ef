#include "rt_core/engine/input_tap.hpp"

#include <algorithm>
#include <utility>

#include "rt_core/engine/input_commands.hpp"
#include "rt_core/engine/instrument_bytes.hpp"
#include "rt_core/engine/state_transfer.hpp"
#include "rt_core/engine/trajectory_bytes.hpp"

namespace cellmirror::engine {

namespace {

// A move as it is written, and what a robot has beside moves.
constexpr std::size_t kMostMoveBytes = 1200;
constexpr std::size_t kMostRobotBytes = 12'000 + motion::kMoveQueue * kMostMoveBytes;
constexpr std::size_t kMostOtherBytes = std::size_t{64} << 10;
// An open haptic channel: its instrument with a chain whose variables have long names, two contact models, its state.
constexpr std::size_t kMostHapticBytes = std::size_t{24} << 10;
constexpr std::size_t kLeastRing = std::size_t{4} << 20;
constexpr std::size_t kMostChainBytes = std::size_t{64} << 10;

void append(std::vector<std::byte>& out, InputRecord kind, std::span<const std::byte> content) {
  const auto length = static_cast<std::uint32_t>(content.size());
  out.push_back(static_cast<std::byte>(kind));
  const auto* const bytes = reinterpret_cast<const std::byte*>(&length);
  out.insert(out.end(), bytes, bytes + sizeof(length));
  out.insert(out.end(), content.begin(), content.end());
}

// Of a record of the tick.
constexpr std::size_t most_bytes(std::size_t robots, std::size_t haptic_devices) {
  return robots * kMostRobotBytes + haptic_devices * kMostHapticBytes + kMostOtherBytes;
}

}  // namespace

// A robot's parts are written once more than they are in the state itself, in each tick.
InputTap::TickMemory::TickMemory(std::size_t robots, std::size_t haptic_devices)
    : ring(std::max(kLeastRing, 2 * most_bytes(robots, haptic_devices))),
      scratch(most_bytes(robots, haptic_devices)),
      published(robots * kRobotStateParts),
      published_haptic(haptic_devices) {}

void InputTap::request_start() {
  if (!memory_) memory_ = std::make_unique<TickMemory>(robots_, haptic_devices_);
  {
    const std::scoped_lock lock(mutex_);
    if (!takes_commands_ || commands_lost_) first_command_.store(newest_sent_ + 1, std::memory_order_relaxed);
    takes_commands_ = true;
    commands_lost_ = false;
    with_lent([](auto& all) {
      for (auto& one : all) one.kept = one.object.lock();
    });
  }
  requests_ = requests_ + 1 == 0 ? 1 : requests_ + 1;
  wanted_.store(requests_, std::memory_order_release);
}

void InputTap::end() {
  wanted_.store(0, std::memory_order_relaxed);
  const std::scoped_lock lock(mutex_);
  takes_commands_ = false;
  pending_.clear();
  with_lent([](auto& all) {
    for (auto& one : all) one.kept.reset();
  });
}

bool InputTap::drain(std::vector<std::byte>& out) {
  if (!memory_) return false;
  // What nobody but this list has now, the tick gave back before what is taken from the ring below was written.
  std::vector<const void*> unused;
  {
    const std::scoped_lock lock(mutex_);
    with_lent([&unused](auto& all) {
      for (const auto& one : all)
        if (one.kept.use_count() == 1) unused.push_back(one.kept.get());
    });
  }
  from_tick_.clear();
  bool has_start = false;
  for (one_.clear(); memory_->ring.pop(one_); one_.clear()) {
    const auto kind = static_cast<InputRecord>(one_.front());
    has_start = has_start || kind == InputRecord::start;
    append(from_tick_, kind, std::span(one_).subspan(1));
  }
  const std::size_t before = out.size();
  bool lost = false;
  {
    const std::scoped_lock lock(mutex_);
    if (has_start) {
      append_chains(out);
      append_trajectories(out);
    }
    with_lent([&unused](auto& all) {
      for (auto& one : all) {
        const void* const kept = one.kept.get();
        if (one.kept.use_count() == 1 && std::ranges::find(unused, kept) != unused.end()) one.kept.reset();
      }
    });
    out.insert(out.end(), pending_.begin(), pending_.end());
    pending_.clear();
    lost = commands_lost_;
  }
  out.insert(out.end(), from_tick_.begin(), from_tick_.end());
  if (lost && on()) request_start();
  return out.size() > before;
}

void InputTap::append_chains(std::vector<std::byte>& out) const {
  std::vector<std::byte> buffer(kMostChainBytes);
  for (const auto& one : chains_) {
    if (!one.kept) continue;
    StateWriter writer(buffer);
    const kinematics::Chain* chain = one.kept.get();
    writer.reference(chain);
    write_chain(writer, *one.kept);
    if (writer.ok()) append(out, InputRecord::chain, writer.written());
  }
}

void InputTap::append_trajectories(std::vector<std::byte>& out) const {
  std::vector<std::byte> buffer;
  for (const auto& one : trajectories_) {
    if (!one.kept) continue;
    buffer.resize(sizeof(std::uint64_t) + bytes_of(*one.kept));
    StateWriter writer(buffer);
    const motion::Trajectory* trajectory = one.kept.get();
    writer.reference(trajectory);
    write_trajectory(writer, *one.kept);
    if (writer.ok()) append(out, InputRecord::trajectory, writer.written());
  }
}

template <class T>
void InputTap::note(std::vector<Lent<T>>& all, const std::shared_ptr<const T>& object) {
  if (!object) return;
  const std::scoped_lock lock(mutex_);
  std::erase_if(all, [](const Lent<T>& one) { return one.object.expired(); });
  const auto known = std::ranges::find_if(all, [&](const Lent<T>& one) { return one.object.lock() == object; });
  Lent<T>& lent = known == all.end() ? all.emplace_back(Lent<T>{object}) : *known;
  if (takes_commands_) lent.kept = object;
}

void InputTap::note(const std::shared_ptr<const kinematics::Chain>& chain) { note(chains_, chain); }

void InputTap::note(const std::shared_ptr<const motion::Trajectory>& trajectory) { note(trajectories_, trajectory); }

InputTap::Sending::Sending(InputTap& tap, std::uint64_t id, Command& command)
    : tap_(tap), lock_(tap.mutex_), pending_before_(tap.pending_.size()), newest_before_(tap.newest_sent_) {
  tap_.newest_sent_ = id;
  if (!tap_.takes_commands_) return;
  if (tap_.pending_.size() > kMostPending) {
    tap_.commands_lost_ = true;
    return;
  }
  tap_.encoding_.resize(most_bytes_of(command));
  StateWriter writer(tap_.encoding_);
  writer(id);
  write_command(writer, command);
  if (writer.ok()) append(tap_.pending_, InputRecord::command, writer.written());
  if (!writer.ok()) tap_.commands_lost_ = true;
}

void InputTap::Sending::refused() {
  tap_.newest_sent_ = newest_before_;
  tap_.pending_.resize(pending_before_);
}

}  // namespace cellmirror::engine
