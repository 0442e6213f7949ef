// The gateway's side of an RTDE connection: asks for the joints of the robot, and turns its packages into joint
// samples. No I/O, no clock: bytes and times are pushed in, bytes and samples come out. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/rtde/rtde_messages.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::rtde {

// Where samples and remarks go.
class SessionOutput {
 public:
  virtual ~SessionOutput() = default;
  virtual void send(std::span<const std::uint8_t> bytes) = 0;
  virtual void sample(const JointSample& sample) = 0;
  // A data package as it came, without its head, before it is looked into.
  virtual void data(std::span<const std::uint8_t> /*payload*/, Timestamp /*now*/) {}
  virtual void rejected(const std::string& why) = 0;
  virtual void message(const std::string& text) = 0;  // of the controller
};

struct SessionCounters {
  std::uint64_t samples = 0;
  std::uint64_t rejected = 0;  // packages or values
  std::uint64_t lost = 0;      // by the controller's time stamps
};

class RtdeSession {
 public:
  enum class Phase : std::uint8_t { asking_version, asking_outputs, starting, running, refused };

  // `output` outlives the session.
  RtdeSession(const RtdeStreamConfig& config, SessionOutput& output) : config_(config), output_(output) {}

  // A new connection: what was under way is forgotten, counters stay.
  void begin(Timestamp now);
  void receive(std::span<const std::uint8_t> bytes, Timestamp now);

  [[nodiscard]] Phase phase() const { return phase_; }
  // True where the connection cannot go on: to be closed and made again.
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] const SessionCounters& counters() const { return counters_; }
  [[nodiscard]] std::int32_t robot_mode() const { return robot_mode_; }
  [[nodiscard]] std::int32_t safety_mode() const { return safety_mode_; }
  [[nodiscard]] Timestamp last_sample() const { return last_sample_; }
  // No value if the controller does not send it.
  [[nodiscard]] std::optional<double> speed_scaling() const { return speed_scaling_; }
  [[nodiscard]] std::optional<std::uint32_t> runtime_state() const { return runtime_state_; }
  // Receive time of the newest package if it made no sample, and the reason; unknown: it made a sample.
  [[nodiscard]] Timestamp last_refused() const { return last_refused_; }
  [[nodiscard]] const std::string& why_refused() const { return why_refused_; }

 private:
  void take(const Package& package, Timestamp now);
  void take_version(std::span<const std::uint8_t> payload);
  void take_outputs(std::span<const std::uint8_t> payload);
  void take_start(std::span<const std::uint8_t> payload);
  void take_data(std::span<const std::uint8_t> payload, Timestamp now);
  // Returns true if the stamp follows the previous one. Refuses other stamps until three of them follow each other:
  // then the controller's time has restarted.
  [[nodiscard]] bool is_in_time(double timestamp_s, Timestamp now);
  void count_lost(double timestamp_s);
  void note_sender(const RobotData& data);
  // Rejects an unreadable package. Too many in a row end the session: the bytes may be divided in the wrong places.
  void reject_package(std::string_view why);
  void refuse(std::string_view why);
  void reject(std::string_view why);

  const RtdeStreamConfig config_;
  SessionOutput& output_;
  PackageSplitter splitter_;
  Phase phase_ = Phase::asking_version;
  bool failed_ = false;
  std::uint8_t recipe_ = 0;
  bool asked_for_all_ = true;                // false: asked for kVariables
  std::optional<double> controller_time_s_;  // of the newest package
  std::optional<double> other_time_s_;       // of the newest refused package
  unsigned others_ = 0;                      // refused packages in a row that follow each other
  unsigned unreadable_ = 0;                  // packages in a row
  std::optional<double> speed_scaling_;
  std::optional<std::uint32_t> runtime_state_;
  Timestamp last_refused_;
  std::string why_refused_;
  Timestamp now_;  // receive time of the bytes being processed
  SessionCounters counters_;
  std::int32_t robot_mode_ = 7;
  std::int32_t safety_mode_ = 1;
  Timestamp last_sample_;
};

}  // namespace cellmirror::rtde
