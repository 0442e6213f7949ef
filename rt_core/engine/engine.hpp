// The tick: in, update, limit, out.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/engine/coupling.hpp"
#include "rt_core/engine/flight_record.hpp"
#include "rt_core/engine/haptic_channels.hpp"
#include "rt_core/engine/input_tap.hpp"
#include "rt_core/engine/robot_slot.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/engine/tick_recorder.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/rt/broadcast.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/latest.hpp"
#include "rt_core/rt/lease.hpp"
#include "rt_core/rt/ring.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::engine {

inline constexpr std::size_t kCommandQueue = 4096;
inline constexpr std::size_t kSampleQueue = 128;  // of each robot: a quarter of a second at 500 Hz
inline constexpr int kCommandsPerTick = 256;      // keeps the tick bounded while a script floods it
inline constexpr int kSamplesPerTick = 64;        // of each robot
// After missed periods a move goes on by the time that has really passed, but by no more than this or one period, so
// that the robots make no leap after a pause of the machine: their paths last longer then.
inline constexpr Nanoseconds kLongestStep{10'000'000};

// What an engine takes memory for.
struct EngineCapacity {
  std::size_t robots = 64;  // slots 0 to robots - 1; at most kMaxRobots
  std::size_t haptic_devices = kMaxHapticDevices;
};
// For a cell that begins with so many robots: kSpareRobots more, at most kMaxRobots.
[[nodiscard]] EngineCapacity capacity_for(std::size_t robots);

// What who replays has to know of a recorded start state.
struct EngineStart {
  std::uint64_t commands_done = 0;
  std::array<std::uint64_t, kMaxHapticDevices> open_devices{};  // by channel, the id of the device; 0: closed
  std::array<bool, kMaxHapticDevices> restored{};  // open channels whose state was there: of older recordings none
};
// Who stands for what cannot be in a file, by the id that it had.
struct StartParts {
  std::function<std::shared_ptr<const kinematics::Chain>(std::uint64_t id)> chain;
  std::function<std::shared_ptr<const motion::Trajectory>(std::uint64_t id)> trajectory = {};  // may be empty
  // Not null.
  std::function<std::shared_ptr<HapticDevicePort>(std::size_t channel, std::uint64_t id)> device;
};

struct QueueStatus {
  std::string name;
  std::uint64_t capacity = 0;
  std::uint64_t high_water = 0;
  std::uint64_t passed = 0;
  std::uint64_t dropped = 0;
};

// Holds all the memory that it will ever use once its readers have subscribed. Threads: run() belongs to the tick;
// send() to the owner of the cell; subscribe() to the thread that sets up; each reader to a thread of its own;
// contact_inlet() to the worker that finds contacts; tissue_inlet() to the one that computes tissue; each inlet() to
// the one driver thread of its stream; the rest to any thread.
class Engine final : public Cycle {
 public:
  // `watchdog` (not owned, outlives the engine) gets a beat a tick. A robot takes about 90 kB: its queue of samples and
  // its moves that wait.
  explicit Engine(Watchdog& watchdog, const EngineCapacity& capacity = {});
  [[nodiscard]] const EngineCapacity& capacity() const { return capacity_; }

  // Before the first tick. The reader belongs to the engine. The tick publishes once for all readers, and not at all
  // where there are none. `name`: of the reader, for people and for the thread that reads.
  TickReader& subscribe(std::string name);

  void run(const CycleContext& context) CELL_RT override;

  // Hands a command to the tick and gives its id, which ascends. 0, and the command is untouched, where the queue is
  // full: try again after the next tick.
  std::uint64_t send(Command& command);
  std::uint64_t send(Command&& command) { return send(command); }
  // The owner's: the id of the newest command that was sent; 0: none.
  [[nodiscard]] std::uint64_t newest_sent() const { return next_command_ - 1; }
  // For a command. The tick uses the object until it gives it back; it is freed with a later call of send() or
  // free_returned(), or with the engine. Only the owner's thread frees.
  template <class T>
  [[nodiscard]] Lease<T> lend(std::shared_ptr<T> object) {
    if constexpr (requires { inputs_.note(object); }) inputs_.note(object);
    return lender_.lend(std::move(object));
  }
  void free_returned() { lender_.collect(); }
  [[nodiscard]] std::size_t lent() const { return lender_.outstanding(); }
  // Where the stream of the robot in this slot puts its samples.
  [[nodiscard]] JointSampleSink& inlet(std::size_t slot);
  // Where the surroundings of the instrument of a haptic channel are put.
  [[nodiscard]] Latest<haptics::ContactModel>& contact_inlet(std::size_t channel) { return haptics_.inlet(channel); }
  // Where the force of soft tissue on that instrument is put; none: the cell has no tissue.
  [[nodiscard]] Latest<haptics::TissueForce>& tissue_inlet(std::size_t channel) {
    return haptics_.tissue_inlet(channel);
  }

  // What the tick takes, for the one thread that records it.
  [[nodiscard]] InputTap& inputs() { return inputs_; }
  // Before the first tick and the first command: the state that another engine wrote into a recording
  // (InputRecord::start), with the same capacity or more. What does not fit is an error, and the engine is not to be
  // used then.
  Result<EngineStart> restore(std::span<const std::byte> start, const StartParts& parts);
  // Of a recorded start state, without its content: what an engine for it needs.
  [[nodiscard]] static Result<EngineCapacity> capacity_of(std::span<const std::byte> start);
  // What a recording has of a slot's state: transfer_part() (state_transfer.hpp).
  void write_published(StateWriter& out, std::size_t slot, std::size_t part);
  [[nodiscard]] const HapticState& haptic_state(std::size_t channel) const { return haptics_.state(channel); }

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

  struct Sent {
    std::uint64_t id = 0;
    Command command;
  };

  void write_start(StateWriter& out) CELL_RT;
  Result<void> restore_trajectories(std::span<const std::byte> tail, const StartParts& parts);
  Result<void> restore_haptics(StateReader& in, const StartParts& parts, EngineStart& out);
  void record_published() CELL_RT;
  int take_commands(Timestamp now) CELL_RT;
  // False where the command was refused.
  bool carry_out(AddRobot& command) CELL_RT;
  bool carry_out(const RemoveRobot& command) CELL_RT;
  bool carry_out(const SetMode& command) CELL_RT;
  bool carry_out(const SetPositions& command) CELL_RT;
  bool carry_out(const SetLimits& command) CELL_RT;
  bool carry_out(SetChain& command) CELL_RT;
  bool carry_out(const AddMove& command) CELL_RT;
  bool carry_out(const StopMotion& command) CELL_RT;
  bool carry_out(const SetPace& command) CELL_RT;
  bool carry_out(const HoldBehind& command) CELL_RT;
  bool carry_out(FollowTrajectory& command) CELL_RT;
  bool carry_out(const Couple& command) CELL_RT;
  bool carry_out(const Uncouple& command) CELL_RT;
  bool carry_out(OpenHaptic& command) CELL_RT;
  bool carry_out(const CloseHaptic& command) CELL_RT;
  bool carry_out(const ResetHaptic& command) CELL_RT;
  bool carry_out(const SetDeviceGone& command) CELL_RT;
  int take_samples() CELL_RT;
  int step_haptics(const CycleContext& context) CELL_RT;
  [[nodiscard]] bool is_slot(std::size_t slot) const CELL_RT { return slot < slots_.size(); }
  void move_robots(const CycleContext& context, double dt) CELL_RT;
  void follow_masters(const CycleContext& context, double dt) CELL_RT;
  void publish() CELL_RT;
  void record_tick(const CycleContext& context, int commands, int samples) CELL_RT;
  void record_robot(FlightEvent event, std::size_t slot, Timestamp time, std::uint64_t sequence) CELL_RT;

  const EngineCapacity capacity_;
  Lender lender_;  // before all that holds leases
  std::vector<RobotSlot> slots_;
  TickState head_;                  // everything of the published state but the robots
  std::uint64_t next_command_ = 1;  // owner's
  Fifo<Sent, kCommandQueue> commands_;
  std::vector<std::unique_ptr<Inlet>> inlets_;
  Broadcast<TickState> states_;
  std::deque<TickReader> readers_;
  std::atomic<bool> started_{false};  // by the first tick
  HapticChannels haptics_;
  Couplings couplings_;
  Watchdog& watchdog_;
  Ring<FlightTick, kFlightTicks> flight_ticks_;
  Ring<FlightRobot, kFlightRobots> flight_robots_;
  InputTap inputs_;
  TickRecorder recorder_;
};

}  // namespace cellmirror::engine
