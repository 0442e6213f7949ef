// The faults that are injected into one CANopen node: what it sends passes through here. Pure: frames and times come
// in, frames go out. Without a fault a frame passes at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "drivers/can/canopen/frame_output.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/io_image.hpp"
#include "rt_core/ports/node_fault.hpp"

namespace cellmirror::can {

class FaultGate final : public FrameOutput {
 public:
  static constexpr std::size_t kMostFaults = 16;
  static constexpr std::size_t kMostWaiting = 256;  // delayed frames; more are dropped

  explicit FaultGate(FrameOutput& output) : output_(&output) {}

  // In force from `now` on. False where so many are that another one has no room.
  bool add(const NodeFault& fault, Timestamp now);
  // Delayed frames leave at once.
  void end_all();

  // What has ended since the call before.
  struct Ended {
    bool death = false;
    bool emergency = false;
  };
  // Ends faults and sends delayed frames; `now` is the time of the frames that are sent until the next call.
  Ended advance(Timestamp now);
  [[nodiscard]] Timestamp next_due() const;  // "never" while nothing is timed

  void send(const CanFrame& frame) override;
  [[nodiscard]] bool is_dead() const { return has(NodeFaultKind::death); }
  // The inputs of an I/O node with those that are stuck.
  [[nodiscard]] IoInputs seen(IoInputs inputs) const;
  // Bit i: a fault of the kind i is in force.
  [[nodiscard]] std::uint8_t kinds() const;

 private:
  struct Active {
    NodeFault fault;
    Timestamp until;  // never: until it is ended
  };

  [[nodiscard]] bool has(NodeFaultKind kind) const;

  FrameOutput* output_;
  std::vector<Active> faults_;
  std::multimap<Timestamp, CanFrame> waiting_;
  Timestamp now_;
  Ended ended_;              // by end_all()
  std::minstd_rand chance_;  // the same in each run
};

}  // namespace cellmirror::can
