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
#include "rt_core/engine/coupling.hpp"
#include "rt_core/engine/flight_record.hpp"
#include "rt_core/engine/haptic_channels.hpp"
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
inline constexpr std::size_t kSampleQueue = 128;   // of each robot: a quarter of a second at 500 Hz
inline constexpr std::size_t kMoveCommands = 256;  // moves on their way to the tick, of all robots together
inline constexpr int kCommandsPerTick = 256;       // keeps the tick bounded while a script floods it
inline constexpr int kSamplesPerTick = 64;         // of each robot
// After missed periods a move goes on by the time that has really passed, but by no more than this or one period, so
// that the robots make no leap after a pause of the machine: their paths last longer then.
inline constexpr Nanoseconds kLongestStep{10'000'000};

struct QueueStatus {
  std::string name;
  std::uint64_t capacity = 0;
  std::uint64_t high_water = 0;
  std::uint64_t passed = 0;
  std::uint64_t dropped = 0;
};

// Who is there to look at what the tick publishes.
enum class Readers : std::uint8_t {
  all,
  owner,  // off line: publishing to the others as well would take longer than all the rest of the tick
};

// Made with all the memory it will ever use. Threads: run() belongs to the tick; send() to the owner of the cell;
// owner_view() to the owner; publisher_view() to the publisher; status_view() to the thread that answers questions;
// collision_view(), ranging_view(), contact_view(), force_view(), tcp_force_view() and picture_view() to the workers of
// that name, contact_inlet() to that of contacts; each inlet() to the one driver thread of its stream; the rest to any
// thread.
class Engine final : public Cycle {
 public:
  // `watchdog` (not owned, outlives the engine) gets a beat a tick.
  explicit Engine(Watchdog& watchdog, Readers readers = Readers::all);

  void run(const CycleContext& context) CELL_RT override;

  // Hands a command (any but add_move) to the tick and gives it its id. 0 where the queue is full: wait a tick and try
  // again.
  std::uint64_t send(Command command);
  // The same for a move (kind add_move). 0 too where kMoveCommands are on their way.
  std::uint64_t send_move(std::size_t slot, const motion::Move& move);
  // Where the stream of the robot in this slot puts its samples.
  [[nodiscard]] JointSampleSink& inlet(std::size_t slot);
  // Where the surroundings of the instrument of a haptic channel are put.
  [[nodiscard]] Latest<haptics::ContactModel>& contact_inlet(std::size_t channel) { return haptics_.inlet(channel); }

  // The newest published state. The reference stays valid and unchanged until the same reader asks again.
  [[nodiscard]] const TickState& owner_view() { return for_owner_.read().value; }
  [[nodiscard]] const TickState& publisher_view() { return for_publisher_.read().value; }
  [[nodiscard]] const TickState& status_view() { return for_status_.read().value; }
  [[nodiscard]] const TickState& collision_view() { return for_collision_.read().value; }
  [[nodiscard]] const TickState& ranging_view() { return for_ranging_.read().value; }
  [[nodiscard]] const TickState& contact_view() { return for_contacts_.read().value; }
  [[nodiscard]] const TickState& force_view() { return for_forces_.read().value; }
  [[nodiscard]] const TickState& tcp_force_view() { return for_tcp_force_.read().value; }
  [[nodiscard]] const TickState& picture_view() { return for_pictures_.read().value; }

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

  std::uint64_t enqueue(Command command);
  int take_commands(Timestamp now) CELL_RT;
  bool carry_out(const Command& command) CELL_RT;
  int take_samples() CELL_RT;
  int step_haptics(const CycleContext& context) CELL_RT;
  bool apply_to_robot(const Command& command) CELL_RT;
  void move_robots(const CycleContext& context, double dt) CELL_RT;
  void follow_masters(const CycleContext& context, double dt) CELL_RT;
  void publish(Latest<TickState>& edge) CELL_RT;
  void publish_to_workers() CELL_RT;
  void record_tick(const CycleContext& context, int commands, int samples) CELL_RT;
  void record_robot(FlightEvent event, std::size_t slot, Timestamp time, std::uint64_t sequence) CELL_RT;

  std::vector<RobotSlot> slots_;    // with the moves that wait, some 2 MB
  TickState head_;                  // everything of the published state but the robots
  std::uint64_t next_command_ = 1;  // owner's
  Fifo<Command, kCommandQueue> commands_;
  // A move is too large for the command queue: the owner takes a free place, writes the move there and sends its
  // number; the tick gives the place back when it has taken the move.
  std::vector<motion::Move> moves_;
  Fifo<std::uint16_t, kMoveCommands> free_moves_;
  std::vector<std::unique_ptr<Inlet>> inlets_;
  Latest<TickState> for_owner_;
  Latest<TickState> for_publisher_;
  Latest<TickState> for_status_;
  Latest<TickState> for_collision_;
  Latest<TickState> for_ranging_;
  Latest<TickState> for_contacts_;
  Latest<TickState> for_forces_;
  Latest<TickState> for_tcp_force_;
  Latest<TickState> for_pictures_;
  HapticChannels haptics_;
  Couplings couplings_;
  Watchdog& watchdog_;
  Readers readers_;
  Ring<FlightTick, kFlightTicks> flight_ticks_;
  Ring<FlightRobot, kFlightRobots> flight_robots_;
};

}  // namespace cellmirror::engine
