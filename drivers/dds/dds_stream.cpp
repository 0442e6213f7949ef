#include "drivers/dds/dds_stream.hpp"

#include <fmt/core.h>

#include <mutex>
#include <utility>

#include "drivers/dds/internal/joint_state_topic.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

std::string publishers_in_words(int n) { return fmt::format("{} publisher{}", n, n == 1 ? "" : "s"); }

class DdsStream final : public JointStream {
 public:
  DdsStream(DdsStreamConfig config, std::unique_ptr<RobotFeed> feed, const Clock& clock)
      : config_(std::move(config)), feed_(std::move(feed)), clock_(clock) {}
  ~DdsStream() override { close(); }
  DdsStream(const DdsStream&) = delete;
  DdsStream& operator=(const DdsStream&) = delete;

  Result<void> open(JointSampleSink& sink) override {
    const std::scoped_lock lock(status_mutex_);
    CELLMIRROR_EXPECTS(topic_ == nullptr);
    auto topic = JointStateTopic::shared(config_, clock_);
    if (!topic) return std::unexpected(topic.error());
    topic_ = std::move(*topic);
    topic_->add(*feed_, sink);
    log_info("dds.stream", "reading {}", endpoint());
    return {};
  }

  void close() override {
    const std::scoped_lock lock(status_mutex_);
    if (topic_ == nullptr) return;
    topic_->remove(*feed_);
    topic_.reset();
  }

  [[nodiscard]] JointStreamStatus status() const override {
    const std::scoped_lock lock(status_mutex_);
    const Timestamp now = clock_.now();
    const FeedReport& feed = feed_->report();
    const FeedCounters& counters = feed.counters;
    RateMeter rate = feed.rate;
    JointStreamStatus status;
    status.kind = "dds";
    status.endpoint = endpoint();
    status.open = topic_ != nullptr;
    status.received = counters.received;
    status.lost = counters.lost;
    status.rejected = counters.rejected;
    status.rate_hz = rate.per_second(now);
    status.condition = condition(feed, now);
    status.details = details(counters);
    status.last_errors = feed_->reported_errors();
    return status;
  }

 private:
  [[nodiscard]] std::string endpoint() const {
    return fmt::format("domain {} topic {} on {}", config_.domain, config_.topic, config_.interface_address);
  }

  [[nodiscard]] std::string condition(const FeedReport& feed, Timestamp now) const {
    if (topic_ == nullptr) return "closed";
    const TopicStatus topic = topic_->status();
    if (!topic.outage.empty()) return topic.outage;
    if (topic.publishers == 0) {
      return topic.incompatible > 0 && config_.reliable
                 ? fmt::format("the publisher on {} is best effort, but reliable = true asks for more", config_.topic)
                 : fmt::format("no publisher on {} in domain {}", config_.topic, config_.domain);
    }
    const std::string publishers = publishers_in_words(topic.publishers);
    const Timestamp last = feed.last_receive_time;
    if (!last.known()) {
      return publishers + (topic.messages == 0 ? ", nothing received yet" : ", no message names a joint of this robot");
    }
    const Nanoseconds silence = now - last;
    if (feed.last_conflict.known() && now - feed.last_conflict <= config_.ages.lost_after) {
      return fmt::format("two publishers name {}: {} and {}", feed_->ros_name(feed.conflict_joint),
                         text(feed.other_publisher), text(feed.publisher));
    }
    if (silence > config_.ages.lost_after) return fmt::format("{}, silent for {:.1f} s", publishers, seconds(silence));
    return publishers + implausible_stamps(feed);
  }

  // The age of a value counts from its arrival, so a slow network shows in the stamps alone.
  [[nodiscard]] std::string implausible_stamps(const FeedReport& feed) const {
    const Nanoseconds most = config_.ages.stale_after;
    const Nanoseconds age = feed.stamp_age.value_or(Nanoseconds(0));
    if (age > most)
      return fmt::format(", whose time stamps are {:.2f} s old on arrival: messages are late, or the clocks differ",
                         seconds(age));
    if (age < -most)
      return fmt::format(", whose time stamps are {:.2f} s in the future: the clocks differ", seconds(-age));
    return {};
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> details(const FeedCounters& counters) const {
    std::vector<std::pair<std::string, std::string>> found;
    if (topic_ != nullptr) {
      const TopicStatus topic = topic_->status();
      found.emplace_back("publishers", fmt::format("{}", topic.publishers));
      found.emplace_back("messages on the topic", fmt::format("{}", topic.messages));
    }
    const std::pair<const char*, std::uint64_t> counts[] = {
        {"malformed samples", counters.malformed},
        {"messages with arrays of wrong length", counters.wrong_length},
        {"velocities and efforts not known (NaN)", counters.unknown},
        {"values of two publishers", counters.conflicts},
        {"bad time stamps", counters.bad_stamps},
        {"samples dropped because the queue was full", counters.sink_full},
    };
    for (const auto& [name, count] : counts) {
      if (count > 0) found.emplace_back(name, fmt::format("{}", count));
    }
    return found;
  }

  DdsStreamConfig config_;
  std::unique_ptr<RobotFeed> feed_;
  const Clock& clock_;
  // Among callers of status(), open() and close(). Never taken by the thread that receives, nor does status() take the
  // topic's mutex: that thread publishes what it reads.
  mutable std::mutex status_mutex_;
  std::shared_ptr<JointStateTopic> topic_;  // open: not null
};

}  // namespace

Result<std::unique_ptr<JointStream>> make_dds_stream(const DdsStreamConfig& config, const Clock& clock,
                                                     std::shared_ptr<PayloadSink> payloads) {
  if (auto ok = check_domain(config.domain); !ok) return std::unexpected(ok.error());
  if (auto ok = check_topic(config.topic); !ok) return std::unexpected(ok.error());
  auto feed = RobotFeed::make(config.joints, config.ages.lost_after);
  if (!feed) return std::unexpected(feed.error());
  (*feed)->set_payload_sink(std::move(payloads));
  return std::make_unique<DdsStream>(config, std::move(*feed), clock);
}

}  // namespace cellmirror::dds
