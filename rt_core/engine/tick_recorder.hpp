// The tick's side of a recording of its inputs: composes a record a tick in memory that it was given.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/haptic_channels.hpp"
#include "rt_core/engine/input_tap.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/rt/cyclic_thread.hpp"

namespace cellmirror::engine {

class RobotSlot;

// Tick thread only. In the order of a tick: begin(), head(), what is taken, what is published, end(). All but begin()
// only where that was true.
class TickRecorder {
 public:
  explicit TickRecorder(InputTap& tap) : tap_(tap), out_({}) {}

  // Whether this tick is recorded. Where a start state is due, `write_start(writer)` writes it.
  template <class WriteStart>
  bool begin(std::uint64_t commands_done, const WriteStart& write_start) CELL_RT {
    if (tap_.wanted_.load(std::memory_order_relaxed) == 0) {
      generation_ = 0;
      return recording_ = false;
    }
    if (!may_record(commands_done)) return recording_ = false;
    if (needs_start_) {
      open(InputRecord::start);
      write_start(out_);
      if (!close()) return recording_ = false;
      forget_published();
      needs_start_ = false;
    }
    open(InputRecord::tick);
    return recording_ = true;
  }
  [[nodiscard]] bool recording() const CELL_RT { return recording_; }

  void head(const CycleContext& context, std::uint64_t commands_done, std::uint64_t commands_refused) CELL_RT;
  void sample(std::size_t slot, std::size_t joints, JointSample& sample) CELL_RT;
  // `moved`: what it gave the robot; null: nothing.
  void haptic(std::size_t channel, std::size_t slot, const HapticTaken& taken, std::size_t joints,
              JointSample* moved) CELL_RT;
  void robot(std::size_t slot, RobotSlot& robot) CELL_RT;
  void haptic_state(std::size_t channel, const HapticState& state) CELL_RT;
  void end() CELL_RT;

 private:
  bool may_record(std::uint64_t commands_done) CELL_RT;
  void open(InputRecord kind) CELL_RT;
  bool close() CELL_RT;
  void forget_published() CELL_RT;
  void tag(TickPart part, std::size_t number) CELL_RT;

  InputTap& tap_;
  InputTap::TickMemory* memory_ = nullptr;
  StateWriter out_;
  std::uint32_t generation_ = 0;
  bool needs_start_ = false;
  bool recording_ = false;
};

}  // namespace cellmirror::engine
