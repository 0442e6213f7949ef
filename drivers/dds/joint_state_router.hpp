// From JointState messages to the samples of robots: who knows which joint, what is refused, what is counted. Pure: no
// DDS library, no lock, no clock; messages and times are pushed in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"
#include "drivers/dds/sender_conflict.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/payload_sink.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::dds {

struct FeedCounters {
  std::uint64_t received = 0;      // samples that the sink accepted
  std::uint64_t sink_full = 0;     // samples that the sink refused
  std::uint64_t lost = 0;          // messages missing in their publisher's sequence
  std::uint64_t rejected = 0;      // messages refused as a whole, and single values refused
  std::uint64_t malformed = 0;     // of these: payloads that are no JointState
  std::uint64_t wrong_length = 0;  // of these: arrays that do not fit together
  std::uint64_t unknown = 0;       // velocities and efforts that were NaN: ROS 2's way of saying "not measured"
  std::uint64_t conflicts = 0;     // values that two publishers give
  std::uint64_t bad_stamps = 0;    // stamps that are no time; the sample is used without one
};

// Who sent a message and its place in that publisher's sequence; zeros where unknown.
struct MessageOrigin {
  std::uint64_t publisher = 0;
  std::uint64_t sequence = 0;
  WriterGuid guid = {};
};

// What RobotFeed::report() returns: a copy as of the newest message.
struct FeedReport {
  FeedCounters counters;
  RateMeter rate;
  Timestamp last_receive_time;
  // The newest conflict of two publishers: when, about which joint (its number in the robot), and who.
  Timestamp last_conflict = {};
  std::size_t conflict_joint = 0;
  WriterGuid publisher = {};
  WriterGuid other_publisher = {};
  // How old the time stamp of the newest message was when it arrived: negative where it lies in the future. None: it
  // has no stamp.
  std::optional<Nanoseconds> stamp_age = {};
};

// One robot's share of a topic. Counters outlive closing and opening again.
// The router's thread publishes its state through `Latest` edges and waits for no reader.
class RobotFeed {
 public:
  static constexpr std::size_t kKeptErrors = 8;

  // Fails where a joint number is out of range, a number is not finite, or a name or joint occurs twice.
  // `conflict_window`: a publisher that was silent for longer has ended.
  [[nodiscard]] static Result<std::unique_ptr<RobotFeed>> make(
      const std::vector<DdsJointConfig>& joints, Nanoseconds conflict_window = Nanoseconds(1'000'000'000));
  // Is given the messages that the router takes for this robot, each message once: where several robots are named, by
  // the one that was added first. Before add().
  void set_payload_sink(std::shared_ptr<PayloadSink> sink) { payloads_ = std::move(sink); }
  // As the router names joints: the ROS 2 name of a joint of the robot; empty where there is none.
  [[nodiscard]] std::string_view ros_name(std::size_t joint) const;

  [[nodiscard]] const FeedCounters& counters() const { return counters_; }
  [[nodiscard]] const std::vector<std::string>& last_errors() const { return last_errors_; }

  // Any thread, one at a time, while messages arrive. Valid until the next call.
  [[nodiscard]] const FeedReport& report() { return published_.read().value; }
  [[nodiscard]] const std::vector<std::string>& reported_errors() { return published_errors_.read().value; }

 private:
  friend class JointStateRouter;
  RobotFeed(std::vector<DdsJointConfig> joints, Nanoseconds conflict_window)
      : joints_(std::move(joints)), senders_(joints_.size(), SenderConflict(conflict_window)) {}

  void begin(Timestamp receive_time, Timestamp source_time);
  void take(const DdsJointConfig& joint, const JointStateView& message, std::size_t i);
  // Whether the joint (index into joints_) has another publisher beside this one; then its value is not taken.
  bool is_in_conflict(std::size_t index, const MessageOrigin& origin);
  void refuse(const DdsJointConfig& joint, std::string_view why);
  [[nodiscard]] double derivative(const DdsJointConfig& joint, const DoubleSequenceView& values, std::size_t i,
                                  double factor, std::string_view what);
  void note_error(std::string text);
  void finish();
  void publish();

  std::vector<DdsJointConfig> joints_;
  std::vector<SenderConflict> senders_;    // by joints_
  FeedReport newest_;                      // its conflict counts; the rest is filled in when it is published
  JointSampleSink* sink_ = nullptr;        // set while it is part of a router
  std::shared_ptr<PayloadSink> payloads_;  // null: nobody wants them
  FeedCounters counters_;
  RateMeter rate_;
  std::vector<std::string> last_errors_;
  Timestamp last_receive_time_;
  std::uint64_t sequence_ = 0;
  JointSample sample_;    // the one being put together
  bool touched_ = false;  // by the message in work
  Latest<FeedReport> published_;
  Latest<std::vector<std::string>> published_errors_;
};

// All robots of one topic. Not synchronized.
class JointStateRouter {
 public:
  // `feed` and `sink` outlive their time here. A feed is added once.
  void add(RobotFeed& feed, JointSampleSink& sink);
  void remove(RobotFeed& feed);
  [[nodiscard]] bool empty() const { return feeds_.empty(); }

  // `payload`: the bytes of one sample, encapsulation included. Pushes one sample to each robot that the message names.
  // A message is refused as a whole where it is no JointState, where `position` is not as long as `name`, or where
  // `velocity` or `effort` are neither empty nor as long; a joint is refused alone where its position is not finite or
  // its name occurs twice. Messages that name none of the joints are ignored. Does not allocate for well-formed
  // messages once it has seen one of their size and publisher.
  void accept(std::span<const std::byte> payload, Timestamp receive_time, MessageOrigin origin = {});
  // The same for a sample of which only the length is known: it has more bytes than are taken.
  void refuse_too_long(std::size_t bytes, std::size_t most, MessageOrigin origin = {});
  // The publisher is gone; its sequence is forgotten.
  void forget(std::uint64_t publisher);

 private:
  struct Target {
    RobotFeed* feed;
    std::size_t joint;  // index into the feed's joints
  };
  struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };
  struct Name {
    std::vector<Target> targets;
    std::uint64_t message = 0;  // the last message that named it: finds names that occur twice
  };
  struct Publisher {
    std::uint64_t last_sequence = 0;
    std::uint64_t missing = 0;  // not yet counted by a robot
    bool feeds_us = false;
  };

  void rebuild();
  void refuse_message(const std::string& why);
  void give_payload(std::span<const std::byte> payload, Timestamp receive_time) const;
  [[nodiscard]] bool lengths_fit(const JointStateView& message) const;
  void touch(RobotFeed& feed, Timestamp receive_time);
  void route_values(const MessageOrigin& origin);
  void refuse_lengths();
  [[nodiscard]] std::uint64_t take_missing(MessageOrigin origin);

  std::vector<RobotFeed*> feeds_;
  std::unordered_map<std::string, Name, TextHash, std::equal_to<>> names_;
  std::unordered_map<std::uint64_t, Publisher> publishers_;
  std::uint64_t message_ = 0;
  JointStateView view_;              // reused
  std::vector<RobotFeed*> touched_;  // reused
};

}  // namespace cellmirror::dds
