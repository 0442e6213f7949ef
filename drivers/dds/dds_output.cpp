#include "drivers/dds/dds_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "drivers/dds/internal/bytes_writer.hpp"
#include "drivers/dds/robot_state_messages.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

namespace {

// A transform takes some 120 bytes: so many stay within one UDP datagram.
constexpr std::size_t kTransformsInMessage = 256;
// Readers confirm some milliseconds after a heartbeat. At higher rates there is always a sample on its way, so that one
// cannot tell a reader that stands still from one that follows.
constexpr double kMostCountedRateHz = 100;
constexpr int kLeastDepth = 32;
constexpr int kMostDepth = 400;

// A writer that knows when it overwrites what a reliable reader has not confirmed yet.
class CountingWriter {
 public:
  CountingWriter(std::unique_ptr<BytesWriter> writer, int depth, bool counts_overwritten)
      : writer_(std::move(writer)), depth_(depth), counts_overwritten_(counts_overwritten) {}

  [[nodiscard]] std::vector<std::byte>& payload() { return writer_->payload(); }
  void write() {
    if (!counts_overwritten_ || writer_->all_confirmed()) {
      unconfirmed_ = 0;
    } else if (unconfirmed_ >= depth_) {
      add(dropped_);
    }
    if (writer_->write()) {
      add(sent_);
      unconfirmed_ = std::min(unconfirmed_ + 1, depth_);
    } else {
      add(dropped_);
    }
  }
  [[nodiscard]] std::uint64_t sent() const { return sent_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
  [[nodiscard]] int readers() const { return writer_->matched_readers(); }

 private:
  // Relaxed: counters for people, each on its own.
  static void add(std::atomic<std::uint64_t>& counter) { counter.fetch_add(1, std::memory_order_relaxed); }

  std::unique_ptr<BytesWriter> writer_;
  int depth_;
  bool counts_overwritten_;
  int unconfirmed_ = 0;
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

class DdsOutput final : public RobotStateOutput {
 public:
  DdsOutput(const DdsOutputConfig& config, std::unique_ptr<CountingWriter> joint_states,
            std::unique_ptr<CountingWriter> transforms)
      : name_(fmt::format("dds domain {} on {}", config.domain, config.interface_address)),
        joint_states_(std::move(joint_states)),
        transforms_(std::move(transforms)) {}

  void publish(Timestamp time, std::span<const RobotState> robots, std::span<const FramePose> frames) override {
    const RosTime stamp = ros_time(to_wall_clock_ns(time));
    std::size_t left_out = 0;
    if (!robots.empty()) {
      names_.see(robots);
      left_out += fill_joint_state(stamp, robots, names_, joint_state_);
      encode(joint_state_, joint_states_->payload());
      joint_states_->write();
    }
    for (; !frames.empty(); frames = frames.subspan(std::min(frames.size(), kTransformsInMessage))) {
      left_out += fill_transforms(stamp, frames.first(std::min(frames.size(), kTransformsInMessage)), tf_);
      encode(tf_, transforms_->payload());
      transforms_->write();
    }
    left_out_.fetch_add(left_out, std::memory_order_relaxed);
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override {
    return {{"sent", joint_states_->sent() + transforms_->sent()},
            {"dropped", joint_states_->dropped() + transforms_->dropped()},
            {"joint_states_sent", joint_states_->sent()},
            {"joint_states_dropped", joint_states_->dropped()},
            {"joint_states_readers", static_cast<std::uint64_t>(std::max(joint_states_->readers(), 0))},
            {"tf_sent", transforms_->sent()},
            {"tf_dropped", transforms_->dropped()},
            {"tf_readers", static_cast<std::uint64_t>(std::max(transforms_->readers(), 0))},
            {"not_finite", left_out_.load(std::memory_order_relaxed)}};
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::string name_;
  std::unique_ptr<CountingWriter> joint_states_;
  std::unique_ptr<CountingWriter> transforms_;
  JointNames names_;
  JointState joint_state_;  // reused
  TfMessage tf_;            // reused
  std::atomic<std::uint64_t> left_out_{0};
};

Result<std::unique_ptr<CountingWriter>> make_writer(const std::shared_ptr<Participant>& participant,
                                                    const std::string& topic, std::string_view type, int depth,
                                                    bool counts_overwritten) {
  auto writer = BytesWriter::make(participant, {topic, type, true, depth});
  if (!writer) return std::unexpected(writer.error());
  return std::make_unique<CountingWriter>(std::move(*writer), depth, counts_overwritten);
}

}  // namespace

Result<std::unique_ptr<RobotStateOutput>> make_dds_output(const DdsOutputConfig& config) {
  if (!std::isfinite(config.rate_hz) || config.rate_hz <= 0) {
    return fail(fmt::format("an output rate of {} Hz", config.rate_hz), "give a rate above zero");
  }
  auto participant = Participant::shared(config.domain, config.interface_address);
  if (!participant) return std::unexpected(participant.error());
  const bool counts = config.rate_hz <= kMostCountedRateHz;
  // About a second of history, for repetition to readers that missed something.
  const int depth = static_cast<int>(std::clamp(config.rate_hz, double{kLeastDepth}, double{kMostDepth}));
  auto joint_states = make_writer(*participant, config.joint_states_topic, kJointStateType, depth, counts);
  if (!joint_states) return std::unexpected(joint_states.error());
  // Many frames make many messages a time.
  auto transforms = make_writer(*participant, config.tf_topic, kTfMessageType, kMostDepth, counts);
  if (!transforms) return std::unexpected(transforms.error());
  return std::make_unique<DdsOutput>(config, std::move(*joint_states), std::move(*transforms));
}

}  // namespace cellmirror::dds
