// A DDS writer of serialized samples.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "drivers/dds/internal/bytes_sample.hpp"
#include "drivers/dds/internal/participant.hpp"
#include "drivers/dds/sample_name.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

// One calling thread, but for matched_readers().
class BytesWriter final {
 public:
  using OnReader = std::function<void(const Guid& reader, bool matched)>;
  // `config.depth`: 1..400.
  [[nodiscard]] static Result<std::unique_ptr<BytesWriter>> make(const std::shared_ptr<Participant>& participant,
                                                                 const EndpointConfig& config);
  ~BytesWriter();
  BytesWriter(const BytesWriter&) = delete;
  BytesWriter& operator=(const BytesWriter&) = delete;

  // The next sample's bytes, to be filled in; keeps its capacity.
  [[nodiscard]] std::vector<std::byte>& payload() { return sample_.payload; }
  // Does not wait for readers. False where DDS did not take the sample.
  bool write();
  // The same, as the reply to a request: with its identity in the inline QoS.
  bool write_reply(const SampleName& request);
  // Whether every reliable reader has confirmed every sample; true where there is none. Does not wait.
  [[nodiscard]] bool all_confirmed() const;
  [[nodiscard]] int matched_readers() const;
  // Called for each reader that is matched, now or later, and for each that is no longer: by a thread of the DDS
  // library, one at a time; it may write. An empty one ends that: none runs when this returns.
  void on_reader(OnReader call);

 private:
  explicit BytesWriter(std::shared_ptr<Participant> participant);

  class Listener;
  std::shared_ptr<Participant> participant_;
  std::unique_ptr<Listener> listener_;  // outlives the writer
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  BytesSample sample_;
};

}  // namespace cellmirror::dds
