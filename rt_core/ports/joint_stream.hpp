// How the joint values of a real robot reach the gateway, whatever carries them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// What is known of the newest value of a source or of one joint.
enum class DataState : std::uint8_t {
  none,         // nothing was ever received (or the stream is off)
  fresh,        // younger than the cell file's stale_after_s; standing still but still sending is fresh
  stale,        // older than stale_after_s
  lost,         // older than lost_after_s, or the source itself said that it is gone
  invalid,      // the newest sample was refused (not finite, wrong length); the value is the last good one
  implausible,  // the newest sample cannot be true, or follows one that could not; the value is the last good one
  conflict,     // two senders give the value; it is the last good one
};
inline constexpr std::size_t kDataStates = 7;

// Joint values that one source sent for one robot at one instant. SI: rad, rad/s, Nm for revolute joints, m, m/s, N for
// prismatic ones, after scale, sign and offset of the cell file. Index = the joint's number in the robot.
struct JointSample {
  // Value of `sequence` after a restart of the source: the sample is not compared with earlier ones.
  static constexpr std::uint64_t kBeginsAnew = ~std::uint64_t{0};

  Timestamp receive_time;      // when its last byte was taken from the operating system
  Timestamp source_time;       // the source's own stamp, moved to our clock; "never" where the protocol has none
  std::uint64_t sequence = 0;  // counted by the source where it counts, else by the driver, from 1; or kBeginsAnew
  std::uint32_t present = 0;   // bit i: joint i has a valid new position
  std::uint32_t refused = 0;   // bit i: joint i was in the message but refused (NaN, ...); others stay usable
  std::uint32_t conflict = 0;  // bit i: two senders give joint i
  std::array<double, kMaxJointsPerRobot> position{};
  std::array<double, kMaxJointsPerRobot> velocity{};  // zero where not sent
  std::array<double, kMaxJointsPerRobot> effort{};    // zero where not sent
};

// Where a driver puts samples: the tick's side implements it. One driver thread calls push().
class JointSampleSink {
 public:
  virtual ~JointSampleSink() = default;
  // False where the queue was full: the sample was refused and counted there.
  virtual bool push(const JointSample& sample) noexcept = 0;
};

// Counters and words about a stream for people and for `status`. A copy; made on any thread.
struct JointStreamStatus {
  std::string kind;      // "can-cia402", "can-dbc", "dds", ...
  std::string endpoint;  // "socketcan:can0", "domain 0 topic rt/joint_states", ...
  bool open = false;
  std::uint64_t received = 0;  // samples passed to the sink
  std::uint64_t lost = 0;      // samples known to be missing (gaps in a sequence, overflow reported by the kernel)
  std::uint64_t rejected = 0;  // messages or values refused
  double rate_hz = 0;          // samples over the last second
  std::string condition;       // one line, e.g. "operational", "bus-off, waiting for the bus", "no publisher"
  std::string waits_for;       // missing resource of this machine, e.g. "can0"; the stream retries until it appears
  std::vector<std::pair<std::string, std::string>>
      details;                           // e.g. {"node 3", "operation enabled"}, {"last EMCY", "node 3 0x8611 ..."}
  std::vector<std::string> last_errors;  // newest last, bounded
};

// The stream of one robot. Life: made (closed) -> open() -> close() -> open() ... Destroying closes. It recovers from
// all faults of the bus or the network without a restart. All calls from one thread (the cell's owner), status() from
// any.
class JointStream {
 public:
  virtual ~JointStream() = default;
  // Starts receiving into `sink`, which outlives the open stream. Fails only on permanent errors (a name that does not
  // exist, no permission); a silent peer is not a failure.
  virtual Result<void> open(JointSampleSink& sink) = 0;
  // Stops; after it returns nothing is pushed any more. A CiA 402 stream leaves its nodes as they are.
  virtual void close() = 0;
  [[nodiscard]] virtual JointStreamStatus status() const = 0;
};

}  // namespace cellmirror
