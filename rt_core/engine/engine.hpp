// The tick: in, update, limit, out.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/engine/flight_record.hpp"
#include "rt_core/engine/robot_slot.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/latest.hpp"
#include "rt_core/rt/ring.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::engine {

inline constexpr std::size_t kCommandQueue = 4096;
inline constexpr std::size_t kSampleQueue = 128;  // of each robot: a quarter of a second at 500 Hz
inline constexpr int kCommandsPerTick = 256;      // keeps the tick bounded while a script floods it
inline constexpr int kSamplesPerTick = 64;        // of each robot

struct QueueStatus {
  std::string name;
  std::uint64_t capacity = 0;
  std::uint64_t high_water = 0;
  std::uint64_t passed = 0;
  std::uint64_t dropped = 0;
};

// Made with all the memory it will ever use. Threads: run() belongs to the tick; send() to the owner of the cell;
// owner_view() to the owner; publisher_view() to the publisher; status_view() to the thread that answers questions;
// each inlet() to the one driver thread of its stream; the rest to any thread.
class Engine final : public Cycle {
 public:
  // `watchdog` (not owned, outlives the engine) gets a beat a tick.
  explicit Engine(Watchdog& watchdog);

  void run(const CycleContext& context) CELL_RT override;

  // Hands a command to the tick and gives it its id. 0 where the queue is full: wait a tick and try again.
  std::uint64_t send(Command command);
  // Where the stream of the robot in this slot puts its samples.
  [[nodiscard]] JointSampleSink& inlet(std::size_t slot);

  // The newest published state. The reference stays valid and unchanged until the same reader asks again.
  [[nodiscard]] const TickState& owner_view() { return for_owner_.read().value; }
  [[nodiscard]] const TickState& publisher_view() { return for_publisher_.read().value; }
  [[nodiscard]] const TickState& status_view() { return for_status_.read().value; }

  [[nodiscard]] std::vector<FlightTick> flight_ticks() const;
  [[nodiscard]] std::vector<FlightRobot> flight_robots() const;
  [[nodiscard]] QueueStatus command_queue() const;
  [[nodiscard]] QueueStatus sample_queue(std::size_t slot) const;

 private:
  class Inlet final : public JointSampleSink {
   public:
    bool push(const JointSample& sample) noexcept override { return queue.push(sample); }
    Fifo<JointSample, kSampleQueue> queue;
  };

  int take_commands(Timestamp now) CELL_RT;
  int take_samples() CELL_RT;
  void publish(Latest<TickState>& edge) CELL_RT;
  void record_tick(const CycleContext& context, int commands, int samples) CELL_RT;
  void record_robot(FlightEvent event, std::size_t slot, Timestamp time, std::uint64_t sequence) CELL_RT;

  std::array<RobotSlot, kMaxRobots> slots_;
  TickState head_;                  // everything of the published state but the robots
  std::uint64_t next_command_ = 1;  // owner's
  Fifo<Command, kCommandQueue> commands_;
  std::vector<std::unique_ptr<Inlet>> inlets_;
  Latest<TickState> for_owner_;
  Latest<TickState> for_publisher_;
  Latest<TickState> for_status_;
  Watchdog& watchdog_;
  Ring<FlightTick, kFlightTicks> flight_ticks_;
  Ring<FlightRobot, kFlightRobots> flight_robots_;
};

}  // namespace cellmirror::engine
