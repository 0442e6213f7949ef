#include "rt_core/engine/engine.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "rt_core/base/contract.hpp"

namespace cellmirror::engine {

namespace {

std::uint32_t saturated_ns(Nanoseconds d) CELL_RT {
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(d.count(), 0, std::numeric_limits<std::uint32_t>::max()));
}

// In seconds, since the tick before.
double passed_time(const CycleContext& context) CELL_RT {
  const auto longest = std::max(context.period, kLongestStep);
  // In doubles: a machine that slept for hours has missed more periods than fit into the nanoseconds.
  const double passed_ns = static_cast<double>(context.period.count()) * (1.0 + static_cast<double>(context.missed));
  return std::min(passed_ns, static_cast<double>(longest.count())) * 1e-9;
}

// What a stream left behind when it was closed: the next one that is opened for the slot shall not find it.
void forget_samples(Fifo<JointSample, kSampleQueue>& queue) CELL_RT {
  JointSample sample;
  for (std::size_t i = 0; i < kSampleQueue && queue.pop(sample); ++i) continue;
}

// For the flight recorder; 0 for haptic devices.
std::uint8_t slot_of(const Command& command) CELL_RT {
  std::uint8_t slot = 0;
  with_command(command, [&slot](const auto& one) CELL_RT {
    if constexpr (requires { one.slot; }) slot = one.slot;
    if constexpr (requires { one.coupling; }) slot = one.coupling ? one.coupling->slave : std::uint8_t{0};
    return true;
  });
  return slot;
}

bool sets_positions(const Command& command) CELL_RT {
  const RobotCommand* const robot = std::get_if<RobotCommand>(&command);
  return robot != nullptr && std::get_if<SetPositions>(robot) != nullptr;
}

}  // namespace

EngineCapacity capacity_for(std::size_t robots) { return {.robots = std::min(robots + kSpareRobots, kMaxRobots)}; }

Engine::Engine(Watchdog& watchdog, const EngineCapacity& capacity)
    : capacity_(capacity),
      slots_(capacity.robots),
      states_(TickState(capacity.robots)),
      haptics_(capacity.haptic_devices),
      couplings_(capacity.robots),
      watchdog_(watchdog),
      inputs_(capacity.robots, capacity.haptic_devices),
      recorder_(inputs_) {
  CELLMIRROR_EXPECTS(capacity.robots <= kMaxRobots && capacity.haptic_devices <= kMaxHapticDevices);
  inlets_.reserve(capacity.robots);
  for (std::size_t i = 0; i < capacity.robots; ++i) inlets_.push_back(std::make_unique<Inlet>());
}

TickReader& Engine::subscribe(std::string name) {
  CELLMIRROR_EXPECTS(!started_.load(std::memory_order_relaxed));
  return readers_.emplace_back(std::move(name), states_.subscribe());
}

void Engine::run(const CycleContext& context) CELL_RT {
  // Relaxed: only the check of a contract reads it.
  started_.store(true, std::memory_order_relaxed);
  recorder_.begin(head_.commands_done, [this](StateWriter& out) CELL_RT { write_start(out); });
  head_.tick = context.cycle;
  head_.time = context.now;
  head_.missed_periods += context.missed;
  const int commands = take_commands(context.now);
  if (recorder_.recording()) recorder_.head(context, head_.commands_done, head_.commands_refused);
  const int samples = take_samples() + step_haptics(context);
  const double dt = passed_time(context);
  move_robots(context, dt);
  for (RobotSlot& slot : slots_) {
    if (slot.used()) slot.update(context.now);
  }
  follow_masters(context, dt);
  if (states_.has_readers()) publish();
  if (recorder_.recording()) record_published();
  record_tick(context, commands, samples);
  watchdog_.beat();
}

int Engine::take_commands(Timestamp now) CELL_RT {
  int taken = 0;
  Sent sent;
  while (taken < kCommandsPerTick && commands_.pop(sent)) {
    ++taken;
    const std::uint8_t slot = slot_of(sent.command);
    const bool done = with_command(sent.command, [this](auto& command) CELL_RT { return carry_out(command); });
    head_.commands_done = sent.id;
    if (!done) ++head_.commands_refused;
    if (!done || sets_positions(sent.command))
      record_robot(done ? FlightEvent::setpoint : FlightEvent::refused_command, slot, now, sent.id);
  }
  return taken;
}

bool Engine::carry_out(AddRobot& command) CELL_RT {
  if (!is_slot(command.slot) || !command.robot) return false;
  if (!slots_[command.slot].add(*command.robot)) return false;
  couplings_.remove(command.slot, slots_);
  return true;
}

bool Engine::carry_out(const RemoveRobot& command) CELL_RT {
  if (!is_slot(command.slot)) return false;
  forget_samples(inlets_[command.slot]->queue);
  couplings_.remove(command.slot, slots_);
  slots_[command.slot].remove();
  return true;
}

bool Engine::carry_out(const SetMode& command) CELL_RT {
  if (!is_slot(command.slot)) return false;
  if (command.mode == RobotMode::simulated) forget_samples(inlets_[command.slot]->queue);
  slots_[command.slot].set_mode(command);
  return true;
}

bool Engine::carry_out(const SetPositions& command) CELL_RT {
  return is_slot(command.slot) && slots_[command.slot].set_positions(command.positions);
}

bool Engine::carry_out(const SetLimits& command) CELL_RT {
  if (!is_slot(command.slot) || !command.limits) return false;
  slots_[command.slot].set_limits(*command.limits);
  return true;
}

bool Engine::carry_out(SetChain& command) CELL_RT {
  return is_slot(command.slot) && slots_[command.slot].set_chain(std::move(command.chain));
}

bool Engine::carry_out(const AddMove& command) CELL_RT {
  return is_slot(command.slot) && command.move && slots_[command.slot].add_move(*command.move);
}

bool Engine::carry_out(const StopMotion& command) CELL_RT {
  return is_slot(command.slot) && slots_[command.slot].stop_motion();
}

bool Engine::carry_out(const SetPace& command) CELL_RT {
  return is_slot(command.slot) && slots_[command.slot].set_pace(command.pace);
}

bool Engine::carry_out(const HoldBehind& command) CELL_RT {
  return is_slot(command.slot) && slots_[command.slot].hold_behind(command.move);
}

bool Engine::carry_out(FollowTrajectory& command) CELL_RT {
  return is_slot(command.slot) && slots_[command.slot].follow_trajectory(std::move(command.trajectory));
}

bool Engine::carry_out(const Couple& command) CELL_RT {
  return command.coupling && couplings_.couple(*command.coupling, slots_);
}

bool Engine::carry_out(const Uncouple& command) CELL_RT { return couplings_.uncouple(command.slot, slots_); }

bool Engine::carry_out(OpenHaptic& command) CELL_RT {
  return command.instrument && is_slot(command.instrument->slot) && haptics_.open(command, head_.time);
}

bool Engine::carry_out(const CloseHaptic& command) CELL_RT { return haptics_.close(command.channel); }

bool Engine::carry_out(const ResetHaptic& command) CELL_RT { return haptics_.reset(command.channel); }

bool Engine::carry_out(const SetDeviceGone& command) CELL_RT {
  return haptics_.set_device_gone(command.channel, command.gone);
}

void Engine::follow_masters(const CycleContext& context, double dt) CELL_RT {
  for (const std::uint8_t slot : couplings_.step(dt, slots_)) record_robot(FlightEvent::setpoint, slot, context.now, 0);
}

void Engine::move_robots(const CycleContext& context, double dt) CELL_RT {
  // The slot of the period rather than when the thread woke up in it: the times of moves are whole periods apart.
  const Timestamp now = context.scheduled.known() ? context.scheduled : context.now;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].used() || !slots_[i].move(dt, now)) continue;
    record_robot(FlightEvent::setpoint, i, context.now, slots_[i].state().motion.running);
  }
}

int Engine::take_samples() CELL_RT {
  int taken = 0;
  JointSample sample;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    // A stream is opened before its robot is mirrored, since it may fail to open: what it brings until then waits.
    if (slots_[slot].state().mode == RobotMode::simulated) continue;
    int of_this_robot = 0;
    while (of_this_robot < kSamplesPerTick && inlets_[slot]->queue.pop(sample)) {
      ++of_this_robot;
      if (recorder_.recording()) recorder_.sample(slot, slots_[slot].state().joint_count, sample);
      slots_[slot].take(sample, head_.time);
      record_robot(FlightEvent::sample, slot, sample.receive_time, sample.sequence);
    }
    taken += of_this_robot;
  }
  return taken;
}

int Engine::step_haptics(const CycleContext& context) CELL_RT {
  int taken = 0;
  JointSample sample;
  for (std::size_t channel = 0; channel < haptics_.size(); ++channel) {
    if (!haptics_.used(channel)) continue;
    const std::size_t slot = haptics_.slot(channel);
    const bool moved = haptics_.step(channel, context, slots_[slot].state(), sample);
    if (recorder_.recording())
      recorder_.haptic(channel, slot, haptics_.taken(channel), slots_[slot].state().joint_count,
                       moved ? &sample : nullptr);
    if (!moved) continue;
    ++taken;
    slots_[slot].take(sample, head_.time);
    record_robot(FlightEvent::sample, slot, sample.receive_time, sample.sequence);
  }
  return taken;
}

void Engine::publish() CELL_RT {
  TickState& out = states_.writable();
  out.tick = head_.tick;
  out.time = head_.time;
  out.missed_periods = head_.missed_periods;
  out.commands_done = head_.commands_done;
  out.commands_refused = head_.commands_refused;
  // Each buffer holds an older state, so a slot that is no longer used is cleared in each of them.
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].used()) {
      slots_[i].publish(out.robots[i]);
    } else {
      out.robots[i].mode = RobotMode::absent;
    }
  }
  haptics_.publish(out.haptics);
  states_.publish();
}

void Engine::record_tick(const CycleContext& context, int commands, int samples) CELL_RT {
  FlightTick record;
  record.tick = context.cycle;
  record.time = context.now;
  record.wakeup_latency_ns = saturated_ns(context.now - context.scheduled);
  record.compute_ns = saturated_ns(context.last_compute);
  record.missed_periods =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(context.missed, std::numeric_limits<std::uint32_t>::max()));
  record.commands = static_cast<std::uint16_t>(std::min(commands, 0xffff));
  record.samples = static_cast<std::uint16_t>(std::min(samples, 0xffff));
  flight_ticks_.push(record);
}

void Engine::record_robot(FlightEvent event, std::size_t slot, Timestamp time, std::uint64_t sequence) CELL_RT {
  FlightRobot record;
  record.tick = head_.tick;
  record.time = time;
  record.sequence = sequence;
  record.event = event;
  record.slot = static_cast<std::uint8_t>(slot);
  if (is_slot(slot)) {
    const RobotTickState& state = slots_[slot].state();
    record.joint_count = state.joint_count;
    for (std::size_t i = 0; i < state.joint_count; ++i)
      record.position[i] = static_cast<float>(state.joints[i].position);
  }
  flight_robots_.push(record);
}

std::uint64_t Engine::send(Command& command) {
  free_returned();
  InputTap::Sending sending(inputs_, next_command_, command);
  Sent sent{next_command_, std::move(command)};
  if (!commands_.push_from(sent)) {
    command = std::move(sent.command);
    sending.refused();
    return 0;
  }
  return next_command_++;
}

JointSampleSink& Engine::inlet(std::size_t slot) {
  CELLMIRROR_EXPECTS(is_slot(slot));
  return *inlets_[slot];
}

std::vector<FlightTick> Engine::flight_ticks() const { return flight_ticks_.newest(); }

std::vector<FlightRobot> Engine::flight_robots() const { return flight_robots_.newest(); }

QueueStatus Engine::command_queue() const {
  return {"commands", commands_.capacity(), commands_.high_water(), commands_.pushed(), commands_.dropped()};
}

QueueStatus Engine::sample_queue(std::size_t slot) const {
  CELLMIRROR_EXPECTS(is_slot(slot));
  const auto& queue = inlets_[slot]->queue;
  return {"samples", queue.capacity(), queue.high_water(), queue.pushed(), queue.dropped()};
}

}  // namespace cellmirror::engine
