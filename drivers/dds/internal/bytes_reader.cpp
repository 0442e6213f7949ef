#include "drivers/dds/internal/bytes_reader.hpp"

#include <algorithm>
#include <utility>

namespace cellmirror::dds {

namespace {

constexpr std::size_t kMostWriters = 4096;  // matched at the same time
// Limit of the age that the process claims for a sample. A false claim can make a value look older, never newer.
constexpr Nanoseconds kMostAge{10'000'000'000};

}  // namespace

BytesReader::BytesReader(std::shared_ptr<Participant> participant) : participant_(std::move(participant)) {}

Result<std::unique_ptr<BytesReader>> BytesReader::make(const std::shared_ptr<Participant>& participant,
                                                       const EndpointConfig& config, Receive receive, Gone gone) {
  std::unique_ptr<BytesReader> made(new BytesReader(participant));
  made->receive_ = std::move(receive);
  made->gone_ = std::move(gone);
  made->wants_history_ = config.transient_local;
  const auto id = participant->add_reader(config, *made);
  if (!id) return std::unexpected(id.error());
  made->id_ = *id;
  return made;
}

BytesReader::~BytesReader() {
  if (id_ != 0) participant_->link().remove(id_);
}

void BytesReader::sample(const SampleReceived& sample, std::span<const std::byte> payload) {
  const Timestamp now = clock_.now();
  if (!wants_history_ && repeated_.is_repeated({sample.writer, sample.number}, now)) return;
  samples_.fetch_add(1, std::memory_order_relaxed);
  ReceivedSample out;
  out.payload = payload;
  out.received = std::max<std::size_t>(sample.received, payload.size());
  out.start = std::as_bytes(std::span(sample.start));
  out.name = {sample.writer, sample.number};
  out.related_guid = sample.related;
  out.age = std::clamp(now - Timestamp{sample.taken_ns}, Nanoseconds(0), kMostAge);
  receive_(out);
}

void BytesReader::matched(const PeerMatched& event) {
  matched_.store(std::max(event.count, 0), std::memory_order_relaxed);
  if (event.matched) {
    if (writers_.size() < kMostWriters) writers_.insert(event.peer);
    return;
  }
  repeated_.forget(event.peer);
  if (writers_.erase(event.peer) > 0 && gone_) gone_(event.peer);
}

void BytesReader::lost() {
  matched_.store(0, std::memory_order_relaxed);
  repeated_.restart(clock_.now());
  for (const Guid& writer : std::exchange(writers_, {})) {
    if (gone_) gone_(writer);
  }
}

}  // namespace cellmirror::dds
