#include "drivers/dds/dds_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/internal/findings_writer.hpp"
#include "drivers/dds/internal/tissue_writer.hpp"
#include "drivers/dds/internal/wrench_writer.hpp"
#include "drivers/dds/robot_state_messages.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

namespace {

// A transform takes some 120 bytes: so many stay within one UDP datagram.
constexpr std::size_t kTransformsInMessage = 256;
// Readers confirm some milliseconds after a heartbeat. At higher rates there is always a sample on its way, so that one
// cannot distinguish a reader that stands still from one that follows.
constexpr double kMostCountedRateHz = 100;
constexpr int kLeastDepth = 32;
constexpr int kMostDepth = 400;
// As ROS 2's robot_state_publisher offers it: readers that come later get the newest one. A URDF is larger than a
// datagram.
constexpr CountingWriter::Options kDescriptionOptions{
    .depth = 1, .counts_overwritten = true, .large = true, .transient_local = true};

class Output final : public DdsOutput {
 public:
  Output(const DdsOutputConfig& config, std::unique_ptr<CountingWriter> joint_states,
         std::unique_ptr<CountingWriter> transforms, std::unique_ptr<FindingsWriter> findings,
         std::unique_ptr<WrenchWriter> wrenches, std::unique_ptr<TissueWriter> tissue,
         std::unique_ptr<CountingWriter> description)
      : name_(fmt::format("dds domain {} on {}", config.domain, config.interface_address)),
        joint_states_(std::move(joint_states)),
        transforms_(std::move(transforms)),
        findings_(std::move(findings)),
        wrenches_(std::move(wrenches)),
        tissue_(std::move(tissue)),
        description_(std::move(description)) {}

  void publish(Timestamp time, std::span<const RobotState> robots, std::span<const FramePose> frames) override {
    const RosTime stamp = ros_time(to_wall_clock_ns(time));
    if (!robots.empty()) {
      names_.see(robots);
      left_out_.add(fill_joint_state(stamp, robots, names_, joint_state_));
      encode(joint_state_, joint_states_->payload());
      joint_states_->write();
    }
    publish_frames(stamp, frames);
  }

  void publish_proximity(const ProximityState& state) override { findings_->publish_proximity(state); }

  void publish_ranges(std::span<const RangeReading> readings, RangeSendMode /*mode*/) override {
    findings_->publish_ranges(readings);
    if (readings.empty()) return;
    beams_.clear();
    for (const RangeReading& reading : readings) beams_.push_back(beam_frame_pose(reading));
    publish_frames(ros_time(to_wall_clock_ns(readings.front().posture_time)), beams_);
  }

  void publish_forces(const ForceState& state) override { wrenches_->publish(state); }

  [[nodiscard]] Nanoseconds tissue_period() const override { return tissue_->period(); }
  void publish_tissue_shapes(Timestamp time, const TissueView& view,
                             std::span<const TissueForceArrow> forces) override {
    tissue_->publish(time, view, forces);
  }

  void publish_description(const std::string& urdf) override {
    if (!description_) return;
    encode(urdf, description_->payload());
    description_->write();
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override {
    std::uint64_t sent = joint_states_->sent() + transforms_->sent();
    std::uint64_t dropped = joint_states_->dropped() + transforms_->dropped();
    std::vector<std::pair<std::string, std::uint64_t>> counters = {{"joint_states_sent", joint_states_->sent()},
                                                                   {"joint_states_dropped", joint_states_->dropped()},
                                                                   {"joint_states_readers", joint_states_->readers()},
                                                                   {"tf_sent", transforms_->sent()},
                                                                   {"tf_dropped", transforms_->dropped()},
                                                                   {"tf_readers", transforms_->readers()},
                                                                   {"not_finite", left_out_.get()}};
    findings_->add_counters(counters, sent, dropped);
    wrenches_->add_counters(counters, sent, dropped);
    tissue_->add_counters(counters, sent, dropped);
    if (description_) {
      counters.insert(counters.end(),
                      {{"description_sent", description_->sent()}, {"description_readers", description_->readers()}});
      sent += description_->sent();
      dropped += description_->dropped();
    }
    counters.insert(counters.begin(), {{"sent", sent}, {"dropped", dropped}});
    return counters;
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  void publish_frames(RosTime stamp, std::span<const FramePose> frames) {
    for (; !frames.empty(); frames = frames.subspan(std::min(frames.size(), kTransformsInMessage))) {
      left_out_.add(fill_transforms(stamp, frames.first(std::min(frames.size(), kTransformsInMessage)), tf_));
      encode(tf_, transforms_->payload());
      transforms_->write();
    }
  }

  std::string name_;
  std::unique_ptr<CountingWriter> joint_states_;
  std::unique_ptr<CountingWriter> transforms_;
  std::unique_ptr<FindingsWriter> findings_;
  std::unique_ptr<WrenchWriter> wrenches_;
  std::unique_ptr<TissueWriter> tissue_;
  std::unique_ptr<CountingWriter> description_;  // null: not published
  JointNames names_;
  JointState joint_state_;        // reused
  TfMessage tf_;                  // reused
  std::vector<FramePose> beams_;  // reused
  Counter left_out_;
};

}  // namespace

Result<std::unique_ptr<DdsOutput>> make_dds_output(const DdsOutputConfig& config) {
  if (!std::isfinite(config.rate_hz) || config.rate_hz <= 0) {
    return fail(fmt::format("an output rate of {} Hz", config.rate_hz), "give a rate above zero");
  }
  auto participant = Participant::shared(config.domain, config.interface_address, config.security, config.partition);
  if (!participant) return std::unexpected(participant.error());
  const bool counts = config.rate_hz <= kMostCountedRateHz;
  // About a second of history, for repetition to readers that missed something.
  const int depth = static_cast<int>(std::clamp(config.rate_hz, double{kLeastDepth}, double{kMostDepth}));
  auto joint_states = CountingWriter::make(*participant, config.joint_states_topic, kJointStateType, {depth, counts});
  if (!joint_states) return std::unexpected(joint_states.error());
  // Many frames make many messages a time.
  auto transforms = CountingWriter::make(*participant, config.tf_topic, kTfMessageType, {kMostDepth, counts});
  if (!transforms) return std::unexpected(transforms.error());
  auto findings = FindingsWriter::make(*participant, config, {kLeastDepth, counts});
  if (!findings) return std::unexpected(findings.error());
  auto wrenches = std::make_unique<WrenchWriter>(*participant, config.wrench_topic_prefix,
                                                 CountingWriter::Options{kLeastDepth, counts});
  std::unique_ptr<CountingWriter> description;
  if (!config.robot_description_topic.empty()) {
    auto made = CountingWriter::make(*participant, config.robot_description_topic, kStringType, kDescriptionOptions);
    if (!made) return std::unexpected(made.error());
    description = std::move(*made);
  }
  return std::make_unique<Output>(config, std::move(*joint_states), std::move(*transforms), std::move(*findings),
                                  std::move(wrenches), std::make_unique<TissueWriter>(*participant, config),
                                  std::move(description));
}

}  // namespace cellmirror::dds
