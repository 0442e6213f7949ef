// A CANopen master that loads the drives which the gateway answers for ([[device]]): all of them in cyclic
// synchronous position, a target to each and SYNC in every period. Prints how long after SYNC their TPDOs came, SDO
// answers took, and beside them the raw echo of such a channel in the same run: a frame to a thread that sends
// another one back. It has a channel of its own, since each frame of the drives would wake that thread. Both have
// SCHED_FIFO where that is allowed, as a controller has.
//   device_load ENDPOINT ECHO_ENDPOINT NODES RATE_HZ SECONDS
#include <sched.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/channel/open_channel.hpp"
#include "rt_core/base/time.hpp"

using namespace cellmirror;

namespace {

constexpr std::uint32_t kNmt = 0x000;
constexpr std::uint32_t kSync = 0x080;
constexpr std::uint32_t kTpdo2 = 0x280;
constexpr std::uint32_t kRpdo2 = 0x300;
constexpr std::uint32_t kTpdo3 = 0x380;
constexpr std::uint32_t kNoPdo = 0x8000'0000;
constexpr std::uint32_t kSdoAnswer = 0x580;
constexpr std::uint32_t kSdoRequest = 0x600;
constexpr std::uint32_t kPing = 0x7F0;  // used by nobody else
constexpr std::uint32_t kPong = 0x7F1;
constexpr std::int64_t kPatience_ns = 5'000'000'000;
constexpr int kPriority = 10;  // below the gateway's threads
constexpr std::int64_t kLastAnswers_ns = 100'000'000;

using Bytes = std::array<std::uint8_t, 8>;

std::uint32_t word(const CanFrame& frame, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(frame.data[at + i]) << (8 * i);
  return value;
}

CanFrame frame_of(std::uint32_t id, const Bytes& data, std::uint8_t length) {
  CanFrame frame;
  frame.id = id;
  frame.length = length;
  std::copy_n(data.begin(), length, frame.data.begin());
  return frame;
}

// Expedited: what these objects need.
CanFrame request(std::uint32_t node, std::uint8_t command, std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
  Bytes data{command, static_cast<std::uint8_t>(index & 0xFF), static_cast<std::uint8_t>(index >> 8), sub};
  for (std::size_t i = 0; i < 4; ++i) data[4 + i] = static_cast<std::uint8_t>(value >> (8 * i));
  return frame_of(kSdoRequest + node, data, 8);
}

void print(const char* name, std::vector<double> us) {
  if (us.empty()) return;
  std::sort(us.begin(), us.end());
  const auto at = [&us](double p) { return us[static_cast<std::size_t>(p * static_cast<double>(us.size() - 1))]; };
  std::printf("%-22s n %zu  p50 %.0f  p99 %.0f  p99.9 %.0f  max %.0f us\n", name, us.size(), at(0.5), at(0.99),
              at(0.999), us.back());
}

class Master {
 public:
  Master(std::unique_ptr<CanChannel> channel, std::unique_ptr<CanChannel> echo, std::uint32_t nodes, double rate)
      : channel_(std::move(channel)),
        echo_(std::move(echo)),
        nodes_(nodes),
        period_ns_(static_cast<std::int64_t>(1e9 / rate)),
        axes_(nodes) {}

  // Of each drive only TPDO2 is left, as a master of this mode needs it.
  bool prepare() {
    channel_->send(frame_of(kNmt, {1, 0}, 2));
    const auto period_ms = static_cast<std::uint32_t>(std::lround(1e-6 * static_cast<double>(period_ns_)));
    for (std::uint32_t node = 1; node <= nodes_; ++node) {
      const bool done = write(node, 0x1802, 1, kNoPdo | (kTpdo3 + node), 4) && write(node, 0x60C2, 1, period_ms, 1) &&
                        write(node, 0x60C2, 2, 0xFD, 1) &&  // times 10^-3 s
                        write(node, 0x6060, 0, 8, 1) && write(node, 0x6040, 0, 0x06, 2) &&
                        write(node, 0x6040, 0, 0x07, 2) && write(node, 0x6040, 0, 0x0F, 2) && enabled(node);
      if (!done) {
        std::fprintf(stderr, "node %u cannot be enabled\n", node);
        return false;
      }
      axes_[node - 1].start = static_cast<std::int32_t>(read(node, 0x6064));
    }
    return true;
  }

  // All axes rest for some periods and turn with one velocity then.
  // Periods that this program missed are left out: a controller does not send several SYNCs at once.
  void run(double seconds) {
    std::int64_t due = clock_.now().ns + period_ns_;
    const std::int64_t end = due + static_cast<std::int64_t>(1e9 * seconds);
    for (std::int64_t n = 0; due < end; ++n, due += period_ns_) {
      hear_until(due, n);
      count_missing(n);
      const std::int64_t behind = clock_.now().ns - due;
      if (behind > period_ns_ / 2) ++late_;
      due += behind / period_ns_ * period_ns_;
      cycle(n);
      periods_ = n + 1;
    }
    echo_due_ = false;
    hear_until(clock_.now().ns + kLastAnswers_ns, periods_);
    count_missing(periods_);
  }

  void report() const {
    print("raw echo", echo_us_);
    print("SYNC to TPDO", tpdo_us_);
    print("SYNC to the last TPDO", last_us_);
    print("SDO answer", sdo_us_);
    std::int64_t slowest = 0;
    for (const Axis& axis : axes_) slowest = std::max(slowest, axis.moved_at < 0 ? periods_ : axis.moved_at - kRest);
    const auto unanswered = static_cast<long long>(periods_ * nodes_) - static_cast<long long>(tpdo_us_.size());
    std::printf(
        "a target is motion after at most %lld periods; of %lld SYNCs %lld answers never came, %lld were not all "
        "answered in their period; this program was late in %lld periods\n",
        static_cast<long long>(slowest), static_cast<long long>(periods_), unanswered, static_cast<long long>(missed_),
        static_cast<long long>(late_));
  }

 private:
  static constexpr std::int64_t kRest = 200;  // periods
  static constexpr double kSpeed = 5000;      // increments/s behind them

  struct Axis {
    std::int32_t start = 0;
    std::int32_t rest = 0;  // where it stood before the first target away from the start
    bool answered = false;  // the SYNC of this period
    std::int64_t moved_at = -1;
  };

  // The data of the answer to an SDO request; nothing within kPatience_ns or at an abort.
  bool transfer(const CanFrame& frame, std::uint32_t& value) {
    channel_->send(frame);
    const std::int64_t end = clock_.now().ns + kPatience_ns;
    ReceivedCanFrame got;
    while (clock_.now().ns < end) {
      if (channel_->receive(got, std::chrono::milliseconds(100)) != CanReceive::frame) continue;
      if (got.frame.id != frame.id - kSdoRequest + kSdoAnswer) continue;
      value = word(got.frame, 4);
      return got.frame.data[0] != 0x80;
    }
    return false;
  }

  bool write(std::uint32_t node, std::uint16_t index, std::uint8_t sub, std::uint32_t value, int bytes) {
    const auto command = static_cast<std::uint8_t>(0x23 | ((4 - bytes) << 2));
    std::uint32_t answer = 0;
    return transfer(request(node, command, index, sub, value), answer);
  }

  std::uint32_t read(std::uint32_t node, std::uint16_t index) {
    std::uint32_t value = 0;
    transfer(request(node, 0x40, index, 0, 0), value);
    return value;
  }

  bool enabled(std::uint32_t node) {
    for (int i = 0; i < 1000; ++i) {
      if ((read(node, 0x6041) & 0x6F) == 0x27) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

  void cycle(std::int64_t n) {
    const double way = n < kRest ? 0.0 : 1e-9 * kSpeed * static_cast<double>((n - kRest + 1) * period_ns_);
    std::vector<CanFrame> targets;
    for (std::uint32_t node = 1; node <= nodes_; ++node) {
      const auto target = static_cast<std::uint32_t>(axes_[node - 1].start + static_cast<std::int32_t>(way));
      Bytes data{0x0F, 0};
      for (std::size_t i = 0; i < 4; ++i) data[2 + i] = static_cast<std::uint8_t>(target >> (8 * i));
      targets.push_back(frame_of(kRpdo2 + node, data, 6));
    }
    channel_->send_all(targets, std::span(sent_).first(nodes_));
    synced_ns_ = clock_.now().ns;
    channel_->send(frame_of(kSync, {}, 0));
    // Beside them, not in each period: an SDO request, and an echo when the TPDOs are through.
    echo_due_ = n % 4 == 0;
    if (n % 10 != 5) return;
    sdo_node_ = 1 + static_cast<std::uint32_t>(n / 10) % nodes_;
    asked_ns_ = clock_.now().ns;
    channel_->send(request(sdo_node_, 0x40, 0x6064, 0, 0));
  }

  void hear_until(std::int64_t due, std::int64_t n) {
    const std::int64_t ping_at = synced_ns_ + (due - synced_ns_) * 3 / 4;
    ReceivedCanFrame got;
    for (std::int64_t now = clock_.now().ns; now < due; now = clock_.now().ns) {
      if (echo_due_ && now >= ping_at) {
        echo_due_ = false;
        ping();
        continue;
      }
      const std::int64_t until = echo_due_ ? std::min(ping_at, due) : due;
      const Nanoseconds longest(std::max<std::int64_t>(until - now, 0));
      if (channel_->receive(got, longest) == CanReceive::frame) take(got.frame, n);
    }
    // What has come already.
    for (std::uint32_t i = 0; i < 4 * nodes_ && channel_->receive(got, Nanoseconds(0)) == CanReceive::frame; ++i)
      take(got.frame, n);
  }

  void ping() {
    ReceivedCanFrame got;
    const std::int64_t sent_ns = clock_.now().ns;
    echo_->send(frame_of(kPing, {}, 0));
    while (echo_->receive(got, std::chrono::seconds(1)) == CanReceive::frame) {
      if (got.frame.id != kPong) continue;
      echo_us_.push_back(1e-3 * static_cast<double>(clock_.now().ns - sent_ns));
      return;
    }
  }

  void take(const CanFrame& frame, std::int64_t n) {
    const std::int64_t now = clock_.now().ns;
    const auto us = [now](std::int64_t since) { return 1e-3 * static_cast<double>(now - since); };
    if (frame.id == kSdoAnswer + sdo_node_) sdo_us_.push_back(us(asked_ns_));
    if (frame.id <= kTpdo2 || frame.id > kTpdo2 + nodes_ || n == 0) return;
    Axis& axis = axes_[frame.id - kTpdo2 - 1];
    axis.answered = true;
    tpdo_us_.push_back(us(synced_ns_));
    newest_us_ = tpdo_us_.back();
    const auto position = static_cast<std::int32_t>(word(frame, 2));
    // The answer to the SYNC of the period n - 1. The first target away from the start comes with that of kRest.
    if (n - 1 <= kRest) axis.rest = position;
    if (axis.moved_at < 0 && position != axis.rest) axis.moved_at = n - 1;
  }

  void count_missing(std::int64_t n) {
    if (n == 0) return;
    const bool all = std::ranges::all_of(axes_, &Axis::answered);
    if (all) last_us_.push_back(newest_us_);
    if (!all) ++missed_;
    for (Axis& axis : axes_) axis.answered = false;
  }

  SystemClock clock_;
  std::unique_ptr<CanChannel> channel_;
  std::unique_ptr<CanChannel> echo_;
  std::uint32_t nodes_;
  std::int64_t period_ns_;
  std::vector<Axis> axes_;
  std::vector<double> echo_us_, tpdo_us_, last_us_, sdo_us_;
  std::array<bool, 127> sent_{};
  std::int64_t synced_ns_ = 0, asked_ns_ = 0;
  double newest_us_ = 0;
  std::uint32_t sdo_node_ = 1;
  bool echo_due_ = false;
  std::int64_t periods_ = 0, missed_ = 0, late_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int nodes = argc == 6 ? std::atoi(argv[3]) : 0;
  const double rate = argc == 6 ? std::atof(argv[4]) : 0;
  const double seconds = argc == 6 ? std::atof(argv[5]) : 0;
  if (nodes < 1 || nodes > 127 || rate < 1 || rate > 1000 || seconds <= 0) {
    std::fprintf(stderr, "usage: device_load ENDPOINT ECHO_ENDPOINT NODES RATE_HZ SECONDS\n");
    return 2;
  }
  sched_param priority{};
  priority.sched_priority = kPriority;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0) std::fprintf(stderr, "SCHED_FIFO is not allowed\n");
  CanChannelConfig config;
  config.endpoint = argv[1];
  CanChannelConfig beside;
  beside.endpoint = argv[2];
  auto channel = can::open_can_channel(config);
  auto pings = can::open_can_channel(beside);
  auto echo = can::open_can_channel(beside);
  for (const auto* opened : {&channel, &pings, &echo}) {
    if (*opened) continue;
    std::fprintf(stderr, "%s\n", opened->error().text().c_str());
    return 1;
  }
  const std::jthread echoes([&echo](const std::stop_token& stop) {
    ReceivedCanFrame got;
    while (!stop.stop_requested()) {
      if ((*echo)->receive(got, std::chrono::milliseconds(50)) != CanReceive::frame || got.frame.id != kPing) continue;
      (*echo)->send(frame_of(kPong, {}, 0));
    }
  });
  Master master(std::move(*channel), std::move(*pings), static_cast<std::uint32_t>(nodes), rate);
  if (!master.prepare()) return 1;
  master.run(seconds);
  master.report();
  return 0;
}
