// What the tick takes and what comes of it, as bytes for a recording that can be run again to the bit: the edge between
// the tick, the owner of the cell, and the thread that records. docs/recording.md describes the records.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "rt_core/base/real_time.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/trajectory.hpp"
#include "rt_core/rt/byte_ring.hpp"

namespace cellmirror::engine {

// Kinds of records. A message of a recording is kInputsVersion, then records: kind (8 bits), length (32 bits), content.
inline constexpr std::uint8_t kInputsVersion = 1;
enum class InputRecord : std::uint8_t {
  command = 1,     // id, command (input_commands.hpp)
  chain = 2,       // id, chain: what a start state refers to
  robots = 3,      // names of slots and joints (written by who records)
  start = 4,       // the state of the engine before a tick (engine_state.cpp)
  tick = 5,        // what it took, and what has changed in what it publishes (tick_recorder.hpp)
  trajectory = 6,  // id, trajectory: what a start state refers to
};
// Within a record of a tick: what follows its head.
enum class TickPart : std::uint8_t { end = 0, sample = 1, haptic = 2, robot = 3, haptic_state = 4 };

// Where nothing records, the tick reads one atomic and the owner takes a lock that nobody else wants. A record that
// finds no room is left out whole and counted; then the tick writes its whole state again, from which a replay goes on.
class InputTap {
 public:
  InputTap(std::size_t robots, std::size_t haptic_devices) : robots_(robots), haptic_devices_(haptic_devices) {}

  // The recorder's thread.
  // Begins, or asks for another start state while it goes on. Takes memory the first time: some 50 kB a robot.
  void request_start();
  void end();
  [[nodiscard]] bool on() const { return wanted_.load(std::memory_order_relaxed) != 0; }
  // Appends the records that came since the last call, what others refer to first. True where there are some.
  bool drain(std::vector<std::byte>& out);
  // Ticks that were left out, since there was no room.
  [[nodiscard]] std::uint64_t lost_ticks() const { return lost_ticks_.load(std::memory_order_relaxed); }

  // The owner's thread. While one lives, a command is being sent under the next id.
  class Sending {
   public:
    Sending(InputTap& tap, std::uint64_t id, Command& command);
    Sending(const Sending&) = delete;
    Sending& operator=(const Sending&) = delete;
    ~Sending() = default;
    void refused();  // the command was not sent

   private:
    InputTap& tap_;
    std::scoped_lock<std::mutex> lock_;
    std::size_t pending_before_;
    std::uint64_t newest_before_;
  };
  // Of what is lent: start states may refer to it as long as it is used.
  void note(const std::shared_ptr<const kinematics::Chain>& chain);
  void note(const std::shared_ptr<const motion::Trajectory>& trajectory);

  // What the tick writes with.
  struct PublishedPart {
    std::uint16_t size = 0;
    std::byte bytes[8 * kMaxJointsPerRobot] = {};
  };
  struct TickMemory {
    TickMemory(std::size_t robots, std::size_t haptic_devices);
    ByteRing ring;
    std::vector<std::byte> scratch;             // one record
    std::vector<PublishedPart> published;       // of each slot its parts, as they were written last
    std::vector<HapticState> published_haptic;  // of each channel
  };

 private:
  friend class TickRecorder;
  static constexpr std::size_t kMostPending = std::size_t{16} << 20;

  // An object that start states may refer to.
  template <class T>
  struct Lent {
    std::weak_ptr<const T> object;       // until nobody uses it
    std::shared_ptr<const T> kept = {};  // while something records
  };
  template <class T>
  void note(std::vector<Lent<T>>& all, const std::shared_ptr<const T>& object);
  // Calls `function` with each list of them.
  template <class Function>
  void with_lent(const Function& function) {
    function(chains_);
    function(trajectories_);
  }
  void append_chains(std::vector<std::byte>& out) const;
  void append_trajectories(std::vector<std::byte>& out) const;

  const std::size_t robots_;
  const std::size_t haptic_devices_;

  // To the tick. Number of the request, 0: nothing is wanted. Release: what is below was set before.
  std::atomic<std::uint32_t> wanted_{0};
  std::atomic<std::uint64_t> first_command_{0};  // commands from this one on are recorded
  // From the tick.
  std::atomic<std::uint64_t> lost_ticks_{0};

  std::unique_ptr<TickMemory> memory_;  // made before the first request, and never changed
  std::uint32_t requests_ = 0;          // the recorder's
  std::vector<std::byte> from_tick_;    // likewise
  std::vector<std::byte> one_;

  std::mutex mutex_;  // of what follows: owner and recorder
  bool takes_commands_ = false;
  bool commands_lost_ = false;
  std::uint64_t newest_sent_ = 0;
  std::vector<std::byte> pending_;  // records of commands
  std::vector<std::byte> encoding_;
  std::vector<Lent<kinematics::Chain>> chains_;
  std::vector<Lent<motion::Trajectory>> trajectories_;
};

}  // namespace cellmirror::engine
