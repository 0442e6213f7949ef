// A DDS writer of serialized samples.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "drivers/dds/internal/bytes_type.hpp"
#include "drivers/dds/internal/participant.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

// One calling thread, but for matched_readers().
class BytesWriter final : private eprosima::fastdds::dds::DataWriterListener {
 public:
  // `config.depth`: 1..400.
  [[nodiscard]] static Result<std::unique_ptr<BytesWriter>> make(const std::shared_ptr<Participant>& participant,
                                                                 const EndpointConfig& config);
  ~BytesWriter() override;
  BytesWriter(const BytesWriter&) = delete;
  BytesWriter& operator=(const BytesWriter&) = delete;

  // The next sample's bytes, to be filled in; keeps its capacity.
  [[nodiscard]] std::vector<std::byte>& payload() { return sample_.payload; }
  // Does not wait for readers. False where DDS did not take the sample.
  bool write();
  // Whether every reliable reader has confirmed every sample; true where there is none. Does not wait.
  [[nodiscard]] bool all_confirmed() const;
  [[nodiscard]] int matched_readers() const { return matched_.load(std::memory_order_relaxed); }

 private:
  explicit BytesWriter(std::shared_ptr<Participant> participant);
  void on_publication_matched(eprosima::fastdds::dds::DataWriter* writer,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& status) override;

  std::shared_ptr<Participant> participant_;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  BytesSample sample_;
  std::atomic<int> matched_{0};
};

}  // namespace cellmirror::dds
