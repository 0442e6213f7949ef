// A DDS reader of serialized samples.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "drivers/dds/internal/participant.hpp"
#include "drivers/dds/sample_name.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

struct ReceivedSample {
  std::span<const std::byte> payload;  // empty where it was longer than kMaxPayloadBytes
  std::size_t received = 0;            // bytes that came
  std::span<const std::byte> start;    // the first of them (BytesSample)
  SampleName name;
  std::array<std::uint8_t, 16> related_guid{};  // of the related sample identity; zero: not given
};

class BytesReader final {
 public:
  // Called by a thread of the DDS library, one at a time, and no more when the reader is gone.
  using Receive = std::function<void(const ReceivedSample& sample)>;
  // A writer that was matched was closed, or its lease has ended. As Receive.
  using Gone = std::function<void(const Guid& writer)>;
  [[nodiscard]] static Result<std::unique_ptr<BytesReader>> make(const std::shared_ptr<Participant>& participant,
                                                                 const EndpointConfig& config, Receive receive,
                                                                 Gone gone = {});
  ~BytesReader();
  BytesReader(const BytesReader&) = delete;
  BytesReader& operator=(const BytesReader&) = delete;

  // Any thread.
  [[nodiscard]] int matched_writers() const;
  [[nodiscard]] std::uint64_t samples() const;  // of any content

 private:
  explicit BytesReader(std::shared_ptr<Participant> participant);

  class Listener;
  std::shared_ptr<Participant> participant_;
  std::unique_ptr<Listener> listener_;  // outlives the reader
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
};

}  // namespace cellmirror::dds
