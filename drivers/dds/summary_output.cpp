#include "drivers/dds/summary_output.hpp"

#include <fmt/core.h>

#include <utility>

#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds {

namespace {

// The newest is complete in itself; the ones before are for readers that missed one on the way.
constexpr CountingWriter::Options kNewestSummary{
    .depth = 4, .counts_overwritten = true, .large = true, .transient_local = true};

class DdsSummaryOutput final : public SummaryOutput {
 public:
  DdsSummaryOutput(const DdsOutputConfig& config, std::unique_ptr<CountingWriter> writer)
      : name_(fmt::format("dds summary {}", config.summary_topic)), writer_(std::move(writer)) {}

  void publish(const CellSummary& /*summary*/, std::string_view text) override {
    encode(text, writer_->payload());
    writer_->write();
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override {
    return {{"sent", writer_->sent()}, {"dropped", writer_->dropped()}, {"readers", writer_->readers()}};
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::string name_;
  std::unique_ptr<CountingWriter> writer_;
};

}  // namespace

Result<std::unique_ptr<SummaryOutput>> make_summary_output(const DdsOutputConfig& config) {
  auto participant = Participant::shared(config.domain, config.interface_address, config.security);
  if (!participant) return std::unexpected(participant.error());
  auto writer = CountingWriter::make(*participant, config.summary_topic, kStringType, kNewestSummary);
  if (!writer) return std::unexpected(writer.error());
  return std::make_unique<DdsSummaryOutput>(config, std::move(*writer));
}

}  // namespace cellmirror::dds
