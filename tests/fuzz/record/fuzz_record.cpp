// Any bytes as a recording. The scan never finds more than there is; what recover() writes is whole, and has what the
// scan found; a reader by the summary ends.
#include <cstddef>
#include <cstdint>

#include "ipc/record/reader.hpp"
#include "ipc/record/recover.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

struct Counter final : mcap::Visitor {
  void on_message(const mcap::Message& message, const mcap::Channel& channel) override {
    CELLMIRROR_EXPECTS(message.channel == channel.id);
    ++messages;
    bytes += message.data.size();
  }
  void on_attachment(const mcap::Attachment&, const mcap::RecordView&) override { ++attachments; }
  void on_metadata(const mcap::Metadata&, const mcap::RecordView&) override { ++metadata; }
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t attachments = 0;
  std::uint64_t metadata = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const mcap::Limits limits{.record_bytes = 1 << 20, .chunk_bytes = 1 << 20, .summary_bytes = 1 << 20};
  const mcap::MemorySource source(std::as_bytes(std::span(data, size)));
  Counter found;
  const auto scanned = mcap::scan(source, limits, found);
  if (!scanned) return 0;
  CELLMIRROR_EXPECTS(scanned->whole_until <= size);
  CELLMIRROR_EXPECTS(scanned->statistics.messages == found.messages);
  mcap::MemorySink out;
  const auto recovered = mcap::recover(source, out, mcap::Compression::none, limits);
  CELLMIRROR_EXPECTS(recovered.has_value());
  CELLMIRROR_EXPECTS(recovered->written.messages == found.messages);
  Counter again;
  const auto copy = mcap::scan(mcap::MemorySource(out.bytes), {}, again);
  CELLMIRROR_EXPECTS(copy && copy->faults.count() == 0 && copy->ended);
  CELLMIRROR_EXPECTS(again.messages == found.messages && again.bytes == found.bytes);
  CELLMIRROR_EXPECTS(again.attachments == found.attachments && again.metadata == found.metadata);
  auto reader = mcap::Reader::open(source, limits);
  if (!reader) return 0;
  std::uint64_t read = 0;
  static_cast<void>(reader->read({}, [&](const mcap::Message&, const mcap::Channel&) { return ++read < 100'000; }));
  for (const mcap::AttachmentIndex& attachment : reader->attachments())
    static_cast<void>(reader->attachment(attachment.name));
  for (const mcap::MetadataIndex& metadata : reader->metadata_records())
    static_cast<void>(reader->metadata(metadata.name));
  return 0;
}
