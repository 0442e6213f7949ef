#include "app/io/payload_tap.hpp"

#include <cstring>
#include <utility>
#include <variant>

#include "rt_core/rt/byte_ring.hpp"

namespace cellmirror::app {

// The stream's thread is the ring's producer. A record is the time, then the payload.
class PayloadTap::Line final : public PayloadSink {
 public:
  Line(PayloadKind kind, std::string robot, std::shared_ptr<std::atomic<bool>> on)
      : kind_(kind), robot_(std::move(robot)), on_(std::move(on)), ring_(kBytes) {}

  void take(std::span<const std::byte> payload, Timestamp receive_time) override {
    if (!on_->load(std::memory_order_relaxed)) return;
    record_.resize(sizeof(receive_time.ns) + payload.size());
    std::memcpy(record_.data(), &receive_time.ns, sizeof(receive_time.ns));
    if (!payload.empty()) std::memcpy(record_.data() + sizeof(receive_time.ns), payload.data(), payload.size());
    if (!ring_.push(record_)) missed_.fetch_add(1, std::memory_order_relaxed);
  }

  // The reader's.
  void drain(std::vector<std::byte>& record, const Take& take, const Missed& missed) {
    // As much as was there, and no more while the stream goes on giving.
    for (std::size_t taken = 0; taken < kBytes; taken += record.size()) {
      record.clear();
      if (!ring_.pop(record)) break;
      Timestamp time;
      std::memcpy(&time.ns, record.data(), sizeof(time.ns));
      take(kind_, robot_, time, std::span(record).subspan(sizeof(time.ns)));
    }
    const std::uint64_t now = missed_.load(std::memory_order_relaxed);
    if (now > missed_told_) missed(kind_, robot_, now - missed_told_);
    missed_told_ = now;
  }

 private:
  const PayloadKind kind_;
  const std::string robot_;
  const std::shared_ptr<std::atomic<bool>> on_;
  ByteRing ring_;
  std::vector<std::byte> record_;         // the stream's
  std::atomic<std::uint64_t> missed_{0};  // counts
  std::uint64_t missed_told_ = 0;         // the reader's
};

std::shared_ptr<PayloadSink> PayloadTap::sink_for(const StreamConfig& config, std::string robot) {
  const bool is_dds = std::holds_alternative<DdsStreamConfig>(config);
  if (!is_dds && !std::holds_alternative<RtdeStreamConfig>(config)) return nullptr;
  auto line = std::make_shared<Line>(is_dds ? PayloadKind::dds : PayloadKind::rtde, std::move(robot), on_);
  const std::scoped_lock lock(mutex_);
  lines_.push_back(line);
  return line;
}

void PayloadTap::drain(const Take& take, const Missed& missed) {
  std::vector<std::shared_ptr<Line>> lines;
  {
    const std::scoped_lock lock(mutex_);
    lines.reserve(lines_.size());
    // A stream that is gone gives nothing more: it is drained once more, below.
    std::erase_if(lines_, [&](const std::shared_ptr<Line>& line) {
      const bool gone = line.use_count() == 1;
      lines.push_back(line);
      return gone;
    });
  }
  for (const std::shared_ptr<Line>& line : lines) line->drain(record_, take, missed);
}

}  // namespace cellmirror::app
