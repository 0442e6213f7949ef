#include "rt_core/engine/engine.hpp"

#include <algorithm>
#include <limits>
#include <utility>

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

}  // namespace

EngineCapacity capacity_for(std::size_t robots) { return {.robots = std::min(robots + kSpareRobots, kMaxRobots)}; }

Engine::Engine(Watchdog& watchdog, const EngineCapacity& capacity)
    : capacity_(capacity),
      slots_(capacity.robots),
      moves_(kMoveCommands),
      states_(TickState(capacity.robots)),
      haptics_(capacity.haptic_devices),
      couplings_(capacity.robots),
      watchdog_(watchdog) {
  CELLMIRROR_EXPECTS(capacity.robots <= kMaxRobots && capacity.haptic_devices <= kMaxHapticDevices);
  for (std::size_t i = 0; i < kMoveCommands; ++i) free_moves_.push(static_cast<std::uint16_t>(i));
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
  head_.tick = context.cycle;
  head_.time = context.now;
  head_.missed_periods += context.missed;
  const int commands = take_commands(context.now);
  const int samples = take_samples() + step_haptics(context);
  const double dt = passed_time(context);
  move_robots(context, dt);
  for (RobotSlot& slot : slots_) {
    if (slot.used()) slot.update(context.now);
  }
  follow_masters(context, dt);
  if (states_.has_readers()) publish();
  record_tick(context, commands, samples);
  watchdog_.beat();
}

int Engine::take_commands(Timestamp now) CELL_RT {
  int taken = 0;
  Command command;
  while (taken < kCommandsPerTick && commands_.pop(command)) {
    ++taken;
    const bool done = carry_out(command);
    head_.commands_done = command.id;
    if (!done) ++head_.commands_refused;
    if (!done || command.kind == CommandKind::set_positions) {
      record_robot(done ? FlightEvent::setpoint : FlightEvent::refused_command, command.slot, now, command.id);
    }
  }
  return taken;
}

bool Engine::carry_out(const Command& command) CELL_RT {
  if (HapticChannels::concerns(command)) return haptics_.apply(command, head_.time, slots_.size());
  if (command.kind != CommandKind::add_move) return is_slot(command.slot) && apply_to_robot(command);
  const bool done = slots_[command.slot].add_move(moves_[command.move]);
  free_moves_.push(command.move);
  return done;
}

bool Engine::apply_to_robot(const Command& command) CELL_RT {
  switch (command.kind) {
    case CommandKind::couple:
      return couplings_.couple({command.master, command.slot, command.joint_count, command.coupled, command.values},
                               slots_);
    case CommandKind::uncouple:
      return couplings_.uncouple(command.slot, slots_);
    case CommandKind::set_mode:
      if (command.mode == RobotMode::simulated) forget_samples(inlets_[command.slot]->queue);
      return slots_[command.slot].apply(command);
    case CommandKind::add_robot:
    case CommandKind::remove_robot:
      if (command.kind == CommandKind::remove_robot) forget_samples(inlets_[command.slot]->queue);
      couplings_.remove(command.slot, slots_);
      return slots_[command.slot].apply(command);
    default:
      return slots_[command.slot].apply(command);
  }
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
      slots_[slot].take(sample);
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
    if (!haptics_.step(channel, context, slots_[slot].state(), sample)) continue;
    ++taken;
    slots_[slot].take(sample);
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

std::uint64_t Engine::send(Command command) {
  CELLMIRROR_EXPECTS(command.kind != CommandKind::add_move);
  return enqueue(command);
}

std::uint64_t Engine::enqueue(Command command) {
  command.id = next_command_;
  if (!commands_.push(command)) return 0;
  return next_command_++;
}

std::uint64_t Engine::send_move(std::size_t slot, const motion::Move& move) {
  CELLMIRROR_EXPECTS(is_slot(slot));
  Command command;
  if (commands_.full() || !free_moves_.pop(command.move)) return 0;
  moves_[command.move] = move;
  command.kind = CommandKind::add_move;
  command.slot = static_cast<std::uint8_t>(slot);
  return enqueue(command);
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
