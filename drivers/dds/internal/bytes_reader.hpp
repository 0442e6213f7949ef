// A DDS reader of serialized samples.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <span>

#include "drivers/dds/internal/participant.hpp"
#include "drivers/dds/internal/repeated_samples.hpp"
#include "drivers/dds/sample_name.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

struct ReceivedSample {
  std::span<const std::byte> payload;  // empty where it was longer than kMaxPayloadBytes
  std::size_t received = 0;            // bytes that came
  std::span<const std::byte> start;    // the first of them
  SampleName name;
  std::array<std::uint8_t, 16> related_guid{};  // of the related sample identity; zero: not given
  Nanoseconds age{0};                           // since it was taken from the network
};

class BytesReader final : private EndpointEvents {
 public:
  // The link's thread calls it, one call at a time, and not after the reader is destroyed. No sample comes twice, even
  // if the process of the DDS library is replaced, but for those that a reader of transient-local samples asks for.
  using Receive = std::function<void(const ReceivedSample& sample)>;
  // A matched writer was closed, its lease has expired, or the process of the DDS library has ended. Called like
  // Receive.
  using Gone = std::function<void(const Guid& writer)>;
  [[nodiscard]] static Result<std::unique_ptr<BytesReader>> make(const std::shared_ptr<Participant>& participant,
                                                                 const EndpointConfig& config, Receive receive,
                                                                 Gone gone = {});
  ~BytesReader() override;
  BytesReader(const BytesReader&) = delete;
  BytesReader& operator=(const BytesReader&) = delete;

  // Any thread; each value on its own.
  [[nodiscard]] int matched_writers() const { return matched_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t samples() const { return samples_.load(std::memory_order_relaxed); }  // of any content
  // Number of writers whose offer does not match the request of the reader.
  [[nodiscard]] std::uint64_t incompatible() const { return incompatible_.load(std::memory_order_relaxed); }
  // DomainLink::outage().
  [[nodiscard]] std::string outage() const { return participant_->link().outage(); }

 private:
  explicit BytesReader(std::shared_ptr<Participant> participant);
  void sample(const SampleReceived& sample, std::span<const std::byte> payload) override;
  void matched(const PeerMatched& event) override;
  void incompatible(std::uint64_t total) override { incompatible_.store(total, std::memory_order_relaxed); }
  void lost() override;

  std::shared_ptr<Participant> participant_;
  SystemClock clock_;
  Receive receive_;
  Gone gone_;
  bool wants_history_ = false;
  std::set<Guid> writers_;    // matched; the link's thread
  RepeatedSamples repeated_;  // the link's thread
  std::atomic<int> matched_{0};
  std::atomic<std::uint64_t> samples_{0};
  std::atomic<std::uint64_t> incompatible_{0};
  std::uint32_t id_ = 0;  // 0: none
};

}  // namespace cellmirror::dds
