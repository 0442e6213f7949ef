// What DDS and RTDE streams receive, for a recording: payloads with their times, from the threads of the streams to one
// reader, without a lock between them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/payload_sink.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

enum class PayloadKind : std::uint8_t {
  dds,   // a sample: CDR with its encapsulation header
  rtde,  // a data package without its head
};

class PayloadTap {
 public:
  static constexpr std::size_t kBytes = std::size_t{256} << 10;  // of one stream, until the reader comes

  // What the stream of that robot gives its payloads to; null where it is neither DDS nor RTDE. Any thread. It may
  // outlive the tap.
  [[nodiscard]] std::shared_ptr<PayloadSink> sink_for(const StreamConfig& config, std::string robot);

  // While off, a payload costs a look at a flag.
  void set_on(bool on) { on_->store(on, std::memory_order_relaxed); }
  // Payloads since the last call, each stream's in order; `missed`: how many of it found no room. One thread.
  using Take = std::function<void(PayloadKind kind, const std::string& robot, Timestamp receive_time,
                                  std::span<const std::byte> payload)>;
  using Missed = std::function<void(PayloadKind kind, const std::string& robot, std::uint64_t payloads)>;
  void drain(const Take& take, const Missed& missed);

 private:
  class Line;

  std::shared_ptr<std::atomic<bool>> on_ = std::make_shared<std::atomic<bool>>(false);
  std::mutex mutex_;  // of the list; streams do not take it
  std::vector<std::shared_ptr<Line>> lines_;
  std::vector<std::byte> record_;  // the reader's
};

}  // namespace cellmirror::app
