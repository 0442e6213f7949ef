#include "drivers/rtde/rtde_stream.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/rtde/rtde_session.hpp"
#include "drivers/rtde/tcp_connection.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/rate_meter.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::rtde {

namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kLongestWait = 50ms;  // how long close() may have to wait for the thread
constexpr Nanoseconds kPause = 500ms;       // before the next attempt to connect
constexpr std::size_t kErrorsKept = 16;

class RtdeStream final : public JointStream, private SessionOutput {
 public:
  RtdeStream(const RtdeStreamConfig& config, const Clock& clock, int fifo_priority,
             std::shared_ptr<PayloadSink> payloads)
      : config_(config),
        clock_(clock),
        fifo_priority_(fifo_priority),
        payloads_(std::move(payloads)),
        session_(config, *this) {}
  ~RtdeStream() override { close(); }
  RtdeStream(const RtdeStream&) = delete;
  RtdeStream& operator=(const RtdeStream&) = delete;

  Result<void> open(JointSampleSink& sink) override {
    CELLMIRROR_EXPECTS(!thread_.joinable());
    const std::lock_guard lock(status_mutex_);
    sink_ = &sink;
    stop_ = false;
    open_ = true;
    report_ = Report();
    report_.problem = "connecting";
    publish();
    thread_ = std::thread([this] { run(); });
    return {};
  }

  void close() override {
    if (!thread_.joinable()) return;
    stop_ = true;
    thread_.join();
    sink_ = nullptr;
    const std::lock_guard lock(status_mutex_);
    open_ = false;
  }

  [[nodiscard]] JointStreamStatus status() const override {
    const std::lock_guard lock(status_mutex_);
    const Timestamp now = clock_.now();
    const Report& report = published_.read().value;
    JointStreamStatus status;
    status.kind = "rtde";
    status.endpoint = endpoint();
    status.open = open_;
    status.received = report.counters.samples;
    status.lost = report.counters.lost;
    status.rejected = report.counters.rejected;
    status.rate_hz = report.rate.per_second(now);
    status.condition = open_ ? condition(report, now) : "closed";
    status.details.emplace_back("connections", number_of(report.connections, "connection"));
    if (report.connected) {
      status.details.emplace_back("robot", robot_mode_text(report.robot_mode));
      status.details.emplace_back("safety", safety_mode_text(report.safety_mode));
      if (report.speed_scaling)
        status.details.emplace_back("speed scaling", fmt::format("{:.0f} %", 100 * *report.speed_scaling));
      if (report.runtime_state) status.details.emplace_back("program", runtime_state_text(*report.runtime_state));
    }
    status.last_errors = report.errors;
    return status;
  }

 private:
  // What status() shows; published by the thread after each reading of the connection.
  struct Report {
    bool connected = false;
    std::string problem;              // why it is not connected
    std::vector<std::string> errors;  // newest last
    std::uint64_t connections = 0;
    SessionCounters counters;
    RtdeSession::Phase phase = RtdeSession::Phase::asking_version;
    std::int32_t robot_mode = 7;
    std::int32_t safety_mode = 1;
    Timestamp last_sample;
    Timestamp last_refused;
    std::string why_refused;
    Timestamp heard;  // receive time of the newest bytes
    std::optional<double> speed_scaling;
    std::optional<std::uint32_t> runtime_state;
    RateMeter rate;
  };

  [[nodiscard]] std::string endpoint() const { return fmt::format("{}:{}", config_.address, config_.port); }

  [[nodiscard]] std::string condition(const Report& report, Timestamp now) const {
    if (!report.connected) return report.problem;
    if (report.phase != RtdeSession::Phase::running) return "connected, waiting for the controller's answer";
    const bool sampled = report.last_sample.known() && now - report.last_sample <= config_.ages.stale_after;
    // Unusable packages are reported as such, not as silence.
    if (!sampled && report.last_refused.known() && now - report.last_refused <= config_.ages.stale_after)
      return "connected, packages are refused: " + report.why_refused;
    if (!sampled && report.heard.known() && now - report.heard <= config_.ages.stale_after)
      return "connected, the bytes that arrive are not a whole package";
    if (!report.last_sample.known()) return "connected, no data yet";
    if (!sampled) return fmt::format("connected, silent for {:.1f} s", seconds(now - report.heard));
    const std::string robot = robot_mode_text(report.robot_mode);
    return report.safety_mode == 1 ? robot : fmt::format("{}, {}", robot, safety_mode_text(report.safety_mode));
  }

  void prepare_thread() const {
    pthread_setname_np(pthread_self(), "rtde");
    if (fifo_priority_ <= 0) return;
    sched_param parameters{};
    parameters.sched_priority = fifo_priority_;
    if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0)
      log_warning("rtde.scheduler " + endpoint(), "SCHED_FIFO is not allowed: the stream runs without it");
  }

  void run() {
    prepare_thread();
    while (!stop_) {
      if (auto connected = connection_.connect(config_.address, config_.port); !connected) {
        disconnected(connected.error().text());
      } else {
        serve();
      }
      for (Nanoseconds slept{0}; slept < kPause && !stop_; slept += kLongestWait)
        std::this_thread::sleep_for(kLongestWait);
    }
    connection_.close();
  }

  // Until the connection is lost.
  void serve() {
    const Timestamp start = clock_.now();
    const Nanoseconds silence = std::max<Nanoseconds>(config_.ages.lost_after, 1s);
    session_.begin(start);
    Timestamp heard = start;
    std::array<std::uint8_t, 16384> bytes{};
    bool first = true;
    while (!stop_) {
      const auto received = connection_.receive(bytes, kLongestWait);
      const Timestamp now = clock_.now();
      if (!received) return disconnected(received.error().text());
      if (first && connection_.established()) {
        first = false;
        log_info("rtde.stream " + endpoint(), "connected");
        ++report_.connections;
      }
      if (*received > 0) {
        heard = now;
        report_.heard = now;
        session_.receive(std::span(bytes).first(*received), now);
      }
      publish();
      if (session_.failed()) return disconnected(last_rejection_);
      if (now - heard > silence) return disconnected(fmt::format("no answer for {:.1f} s", seconds(now - heard)));
    }
  }

  void disconnected(const std::string& why) {
    connection_.close();
    if (report_.problem != why) note(why);
    report_.problem = why;
    publish();
  }

  void publish() {
    report_.connected = connection_.established();
    if (report_.connected) report_.problem.clear();
    report_.counters = session_.counters();
    report_.phase = session_.phase();
    report_.robot_mode = session_.robot_mode();
    report_.safety_mode = session_.safety_mode();
    report_.last_sample = session_.last_sample();
    report_.last_refused = session_.last_refused();
    report_.why_refused = session_.why_refused();
    report_.speed_scaling = session_.speed_scaling();
    report_.runtime_state = session_.runtime_state();
    published_.writable() = report_;
    published_.publish();
  }

  void note(const std::string& text) {
    report_.errors.push_back(text);
    if (report_.errors.size() > kErrorsKept) report_.errors.erase(report_.errors.begin());
    log_warning("rtde.stream " + endpoint(), "{}", text);
  }

  void send(std::span<const std::uint8_t> bytes) override { connection_.send(bytes); }
  void sample(const JointSample& sample) override {
    report_.rate.count(clock_.now());
    sink_->push(sample);
  }
  void data(std::span<const std::uint8_t> payload, Timestamp now) override {
    if (payloads_) payloads_->take(std::as_bytes(payload), now);
  }
  void rejected(const std::string& why) override {
    last_rejection_ = why;
    if (report_.errors.empty() || report_.errors.back() != why) note(why);
  }
  void message(const std::string& text) override { log_info("rtde.message " + endpoint(), "{}", text); }

  const RtdeStreamConfig config_;
  const Clock& clock_;
  const int fifo_priority_;
  const std::shared_ptr<PayloadSink> payloads_;  // null: nobody wants them
  RtdeSession session_;                          // the thread's, as what follows
  TcpConnection connection_;
  Report report_;
  std::string last_rejection_;
  JointSampleSink* sink_ = nullptr;
  std::atomic<bool> stop_{false};
  std::thread thread_;
  mutable Latest<Report> published_;
  mutable std::mutex status_mutex_;  // among callers of status(), open() and close(); the thread never takes it
  bool open_ = false;
};

}  // namespace

Result<std::unique_ptr<JointStream>> make_rtde_stream(const RtdeStreamConfig& config, const Clock& clock,
                                                      int fifo_priority, std::shared_ptr<PayloadSink> payloads) {
  for (const RtdeJointConfig& joint : config.joints) {
    if (joint.number >= kJoints)
      return fail(fmt::format("joint number {}: the controller has {}", joint.number + 1, kJoints));
  }
  return std::make_unique<RtdeStream>(config, clock, fifo_priority, std::move(payloads));
}

}  // namespace cellmirror::rtde
