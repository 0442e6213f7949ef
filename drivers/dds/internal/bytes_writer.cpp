#include "drivers/dds/internal/bytes_writer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace cellmirror::dds {

namespace {

constexpr int kMaxDepth = 400;              // the library's default of max_samples_per_instance
constexpr std::size_t kMostReaders = 4096;  // that are known by name

}  // namespace

BytesWriter::BytesWriter(std::shared_ptr<Participant> participant, const EndpointConfig& config)
    : participant_(std::move(participant)),
      kept_most_(config.transient_local ? static_cast<std::size_t>(config.depth) : 0) {}

Result<std::unique_ptr<BytesWriter>> BytesWriter::make(const std::shared_ptr<Participant>& participant,
                                                       const EndpointConfig& config) {
  if (config.depth < 1 || config.depth > kMaxDepth) {
    return fail(fmt::format("a history of {} samples for topic {}", config.depth, config.topic),
                fmt::format("use 1 to {}", kMaxDepth));
  }
  std::unique_ptr<BytesWriter> made(new BytesWriter(participant, config));
  const auto id = participant->add_writer(config, *made);
  if (!id) return std::unexpected(id.error());
  made->id_ = *id;
  return made;
}

BytesWriter::~BytesWriter() {
  if (id_ != 0) participant_->link().remove(id_);
}

bool BytesWriter::write() {
  if (kept_most_ > 0) {
    const std::scoped_lock lock(kept_mutex_);
    if (kept_.size() >= kept_most_) kept_.pop_front();
    kept_.push_back(payload_);
  }
  return participant_->link().write({.id = id_}, payload_);
}

bool BytesWriter::write_reply(const SampleName& request) {
  return participant_->link().write(
      {.id = id_, .reply = true, .request_guid = request.guid, .request_number = request.number}, payload_);
}

void BytesWriter::on_reader(OnReader call) {
  const std::scoped_lock lock(mutex_);
  call_ = std::move(call);
  if (!call_) return;
  for (const Guid& reader : readers_) call_(reader, true);
}

void BytesWriter::matched(const PeerMatched& event) {
  matched_.store(std::max(event.count, 0), std::memory_order_relaxed);
  const std::scoped_lock lock(mutex_);
  // The callback learns only of readers within the bound, since the process may announce any number of them.
  if (event.matched && readers_.size() >= kMostReaders) return;
  const bool changed = event.matched ? readers_.insert(event.peer).second : readers_.erase(event.peer) > 0;
  if (changed && call_) call_(event.peer, event.matched);
}

void BytesWriter::dropped(std::uint64_t total) { dropped_.store(dropped_before_ + total, std::memory_order_relaxed); }

void BytesWriter::added() {
  const std::scoped_lock lock(kept_mutex_);
  for (const std::vector<std::byte>& sample : kept_) participant_->link().write({.id = id_}, sample);
}

void BytesWriter::lost() {
  matched_.store(0, std::memory_order_relaxed);
  dropped_before_ = dropped_.load(std::memory_order_relaxed);
  const std::scoped_lock lock(mutex_);
  for (const Guid& reader : std::exchange(readers_, {})) {
    if (call_) call_(reader, false);
  }
}

}  // namespace cellmirror::dds
