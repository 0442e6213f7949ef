// Runs recorded inputs through an engine, without threads, and compares each tick with what was published. Takes any
// bytes. One thread; not for the tick.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/recording_layout/tick_inputs.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/input_commands.hpp"
#include "rt_core/motion/trajectory.hpp"

namespace cellmirror::app {

// The first value that is not the recorded one.
struct ReplayDifference {
  std::uint64_t tick = 0;
  Timestamp time;
  std::string robot;     // empty: of no robot
  std::string joint;     // empty: of the robot as a whole
  std::string what;      // "position", "motion", ...
  std::string recorded;  // values; of a position all digits
  std::string computed;
};

struct ReplayCounts {
  std::uint64_t ticks = 0;      // that were run and compared
  std::uint64_t skipped = 0;    // that are there, and could not be run: before a start state, or after a gap
  std::uint64_t starts = 0;     // start states that were taken
  std::uint64_t gaps = 0;       // places where ticks or commands are missing
  std::uint64_t not_sound = 0;  // records that could not be understood
  std::string first_problem;    // of a gap, or of what could not be understood
  double recorded_s = 0;        // of the ticks that were run
};

class EngineReplay {
 public:
  EngineReplay();
  ~EngineReplay();
  EngineReplay(const EngineReplay&) = delete;
  EngineReplay& operator=(const EngineReplay&) = delete;

  // Called after each tick that was run, with the engine's state.
  void on_tick(std::function<void(const engine::TickState& state)> function) { on_tick_ = std::move(function); }
  // A message of kInputsTopic; in the order of the file. Returns at the first difference.
  void take(ByteSpan message);
  // Behind the last message, or one that is missing: what follows needs a start state.
  void gap(const std::string& why);

  [[nodiscard]] const std::optional<ReplayDifference>& difference() const { return difference_; }
  [[nodiscard]] const ReplayCounts& counts() const { return counts_; }
  [[nodiscard]] const NamesBySlot& names() const { return names_; }
  // Channels of haptic devices whose state was not compared: open before the recording began, which is of a version
  // whose start states do not have it.
  [[nodiscard]] const std::vector<std::uint8_t>& channels_taken_over() const { return taken_over_; }

 private:
  struct Session;
  using ChainPtr = std::shared_ptr<const kinematics::Chain>;

  void take_record(engine::InputRecord kind, ByteSpan content);
  void take_chain(ByteSpan content);
  void take_trajectory(ByteSpan content);
  void begin(ByteSpan start);
  void begin_again_after_a_gap(ByteSpan record);
  void run(ByteSpan record);
  Result<void> send_commands(std::uint64_t up_to);
  Result<void> give(const TickInputs& inputs);
  void compare(const TickInputs& inputs);
  bool compare_robot(const TickInputs& inputs, std::size_t slot);
  void compare_haptics(const TickInputs& inputs);
  void note(const Error& error);
  ChainPtr chain_of(std::uint64_t object_id, kinematics::Chain&& chain, ByteSpan bytes);
  [[nodiscard]] ReplayDifference difference_in(const TickInputs& inputs, std::size_t slot, std::string what) const;

  std::function<void(const engine::TickState& state)> on_tick_;
  std::unique_ptr<Session> session_;
  std::map<std::uint64_t, std::vector<std::byte>> commands_;  // by id, that no tick has done yet
  struct KnownChain {
    std::vector<std::byte> bytes;
    ChainPtr chain;
  };
  std::map<std::uint64_t, KnownChain> chains_;  // by id
  std::vector<ChainPtr> all_chains_;            // as long as an engine may refer to them
  std::map<std::uint64_t, std::shared_ptr<const motion::Trajectory>> trajectories_;  // by id
  std::vector<std::byte> spare_start_;  // came while a replay went on; for a gap right before it
  NamesBySlot names_;
  std::optional<ReplayDifference> difference_;
  ReplayCounts counts_;
  std::vector<std::uint8_t> taken_over_;
};

}  // namespace cellmirror::app
