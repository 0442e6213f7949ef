#include "drivers/dds/summary_reader.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "drivers/dds/internal/bytes_reader.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "drivers/dds/sender_conflict.hpp"
#include "ipc/wire/cell_summary_text.hpp"

namespace cellmirror::dds {

namespace {

constexpr int kOfWriter = 8;  // that wait to be taken: two of one instant are no loss

void read(const ReceivedSample& sample, Timestamp now, SummaryInbox& inbox) {
  const std::string sender = text(sample.name.guid);
  std::string_view document;
  if (const CdrFault fault = decode(sample.payload, document); fault != CdrFault::none)
    return inbox.rejected(sender, std::string(words(fault)));
  auto summary = parse_cell_summary(document);
  if (!summary) return inbox.rejected(sender, summary.error().text());
  inbox.received({std::move(*summary), sender, now, sample.received});
}

class Reader final : public SummaryReader {
 public:
  explicit Reader(std::unique_ptr<BytesReader> reader) : reader_(std::move(reader)) {}
  [[nodiscard]] std::size_t writers() const override {
    return static_cast<std::size_t>(std::max(reader_->matched_writers(), 0));
  }

 private:
  std::unique_ptr<BytesReader> reader_;
};

}  // namespace

Result<std::unique_ptr<SummaryReader>> SummaryReader::open(const SummaryReaderConfig& config, const Clock& clock,
                                                           SummaryInbox& inbox) {
  auto participant = Participant::shared(config.domain, config.interface_address, config.security);
  if (!participant) return std::unexpected(participant.error());
  const EndpointConfig endpoint{
      .topic = config.topic, .type = kStringType, .reliable = true, .depth = kOfWriter, .transient_local = true};
  auto reader = BytesReader::make(
      *participant, endpoint, [&](const ReceivedSample& sample) { read(sample, clock.now(), inbox); },
      [&inbox](const Guid& writer) { inbox.gone(text(writer)); });
  if (!reader) return std::unexpected(reader.error());
  return std::make_unique<Reader>(std::move(*reader));
}

}  // namespace cellmirror::dds
