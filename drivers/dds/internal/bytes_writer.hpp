// A DDS writer of serialized samples.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "drivers/dds/internal/participant.hpp"
#include "drivers/dds/sample_name.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

// One calling thread, but for the counters.
class BytesWriter final : private EndpointEvents {
 public:
  using OnReader = std::function<void(const Guid& reader, bool matched)>;
  // `config.depth`: 1..400.
  [[nodiscard]] static Result<std::unique_ptr<BytesWriter>> make(const std::shared_ptr<Participant>& participant,
                                                                 const EndpointConfig& config);
  ~BytesWriter() override;
  BytesWriter(const BytesWriter&) = delete;
  BytesWriter& operator=(const BytesWriter&) = delete;

  // The next sample's bytes, to be filled in; keeps its capacity.
  [[nodiscard]] std::vector<std::byte>& payload() { return payload_; }
  // Does not block. Returns false if there is no process of the DDS library, or if it does not read.
  bool write();
  // The same, as the reply to a request: with its identity in the inline QoS.
  bool write_reply(const SampleName& request);
  [[nodiscard]] int matched_readers() const { return matched_.load(std::memory_order_relaxed); }
  // Number of samples that the library refused or overwrote before a reliable reader had confirmed them.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
  // Called for each reader that is matched, now or later, and for each that is no longer: by the link's thread, one at
  // a time; it may write. An empty one ends that: none runs when this returns.
  void on_reader(OnReader call);

 private:
  BytesWriter(std::shared_ptr<Participant> participant, const EndpointConfig& config);
  void matched(const PeerMatched& event) override;
  void dropped(std::uint64_t total) override;
  void added() override;
  void lost() override;

  std::shared_ptr<Participant> participant_;
  const std::size_t kept_most_;  // 0: late readers get nothing
  std::vector<std::byte> payload_;
  std::atomic<int> matched_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::uint64_t dropped_before_ = 0;  // by processes that have ended; the link's thread
  std::mutex mutex_;                  // of what follows; also while the call runs
  std::set<Guid> readers_;
  OnReader call_;
  std::mutex kept_mutex_;
  std::deque<std::vector<std::byte>> kept_;  // what a new process gets for late readers, oldest first
  std::uint32_t id_ = 0;                     // 0: none
};

}  // namespace cellmirror::dds
