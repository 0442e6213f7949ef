#include "rt_core/engine/tick_recorder.hpp"

#include <utility>

#include "rt_core/engine/robot_slot.hpp"
#include "rt_core/engine/state_transfer.hpp"

namespace cellmirror::engine {

namespace {

constexpr std::uint16_t kNeverWritten = 0xFFFF;

}  // namespace

bool TickRecorder::may_record(std::uint64_t commands_done) CELL_RT {
  // Acquire: pairs with the release in request_start().
  const std::uint32_t wanted = tap_.wanted_.load(std::memory_order_acquire);
  if (wanted == 0) return false;
  if (wanted != generation_) {
    // Commands that were sent before are unknown to the recording: they have to be done first.
    if (commands_done + 1 < tap_.first_command_.load(std::memory_order_relaxed)) return false;
    generation_ = wanted;
    needs_start_ = true;
    memory_ = tap_.memory_.get();
  }
  if (!needs_start_ || memory_->ring.room() >= memory_->ring.capacity() / 2) return true;
  // Relaxed: statistics, and only this thread writes them; so in close().
  tap_.lost_ticks_.store(tap_.lost_ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return false;
}

void TickRecorder::open(InputRecord kind) CELL_RT {
  out_ = StateWriter(memory_->scratch);
  auto number = std::to_underlying(kind);
  out_(number);
}

bool TickRecorder::close() CELL_RT {
  if (out_.ok() && memory_->ring.push(out_.written())) return true;
  needs_start_ = true;
  tap_.lost_ticks_.store(tap_.lost_ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return false;
}

void TickRecorder::forget_published() CELL_RT {
  for (InputTap::PublishedPart& part : memory_->published) part.size = kNeverWritten;
  for (HapticState& state : memory_->published_haptic) state = HapticState{};
}

void TickRecorder::tag(TickPart part, std::size_t number) CELL_RT {
  auto kind = std::to_underlying(part);
  auto place = static_cast<std::uint8_t>(number);
  out_(kind, place);
}

void TickRecorder::head(const CycleContext& context, std::uint64_t commands_done,
                        std::uint64_t commands_refused) CELL_RT {
  CycleContext copy = context;
  out_(copy.cycle, copy.now, copy.scheduled, copy.missed, copy.period, copy.last_compute, commands_done,
       commands_refused);
}

void TickRecorder::sample(std::size_t slot, std::size_t joints, JointSample& sample) CELL_RT {
  tag(TickPart::sample, slot);
  out_.bounded(joints, kMaxJointsPerRobot);
  transfer_sample(out_, sample, joints);
}

void TickRecorder::haptic(std::size_t channel, std::size_t slot, const HapticTaken& taken, std::size_t joints,
                          JointSample* moved) CELL_RT {
  tag(TickPart::haptic, channel);
  auto of_robot = static_cast<std::uint8_t>(slot);
  out_(of_robot);
  HapticRead outcome = taken.outcome;
  out_.choice(outcome, HapticRead::none);
  bool has_sample = taken.sample != nullptr;
  bool has_model = taken.model != nullptr;
  bool has_tissue = taken.tissue != nullptr;
  bool has_moved = moved != nullptr;
  out_(has_sample, has_model, has_tissue, has_moved);
  if (has_sample) out_(*taken.sample);
  if (has_model) {
    haptics::ContactModel model = *taken.model;
    out_(model);
  }
  if (has_tissue) {
    haptics::TissueForce tissue = *taken.tissue;
    out_(tissue);
  }
  if (!has_moved) return;
  out_.bounded(joints, kMaxJointsPerRobot);
  transfer_sample(out_, *moved, joints);
}

// Only the parts whose bytes are others than in the tick before.
void TickRecorder::robot(std::size_t slot, RobotSlot& robot) CELL_RT {
  InputTap::PublishedPart* const parts = &memory_->published[slot * kRobotStateParts];
  if (!robot.used() && parts[0].size == kNeverWritten) return;
  const std::size_t begin = out_.size();
  tag(TickPart::robot, slot);
  const std::size_t mask_at = out_.size();
  std::uint16_t mask = 0;
  out_(mask);
  const std::size_t used_parts = robot.used() ? kRobotStateParts : 1;
  for (std::size_t i = 0; i < used_parts; ++i) {
    const std::size_t before = out_.size();
    robot.transfer_published(out_, i);
    const std::size_t size = out_.size() - before;
    if (parts[i].size == size && std::memcmp(parts[i].bytes, out_.written().data() + before, size) == 0) {
      out_.rewind(before);
      continue;
    }
    if (size > sizeof(parts[i].bytes)) return out_.fail();
    parts[i].size = static_cast<std::uint16_t>(size);
    std::memcpy(parts[i].bytes, out_.written().data() + before, size);
    mask = static_cast<std::uint16_t>(mask | 1U << i);
  }
  if (mask == 0) {
    out_.rewind(begin);
  } else {
    out_.put_at(mask_at, mask);
  }
  if (robot.used()) return;
  for (std::size_t i = 0; i < kRobotStateParts; ++i) parts[i].size = kNeverWritten;
}

void TickRecorder::haptic_state(std::size_t channel, const HapticState& state) CELL_RT {
  // A closed one that is known as closed.
  HapticState& before = memory_->published_haptic[channel];
  if (state.phase == HapticPhase::closed && before.phase == HapticPhase::closed) return;
  before = state;
  HapticState copy = state.phase == HapticPhase::closed ? HapticState{} : state;
  tag(TickPart::haptic_state, channel);
  out_(copy);
}

void TickRecorder::end() CELL_RT {
  auto kind = std::to_underlying(TickPart::end);
  out_(kind);
  close();
}

}  // namespace cellmirror::engine
