#include "ipc/record/recover.hpp"

#include <set>
#include <string>
#include <utility>

#include "ipc/record/decode.hpp"

namespace cellmirror::mcap {

namespace {

class Copier final : public Visitor {
 public:
  explicit Copier(Writer& to) : to_(to) {}

  void on_schema(const Schema& schema) override { look(to_.put(schema)); }
  // One whose schema is not there was reported as a fault before, and its messages are copied without it.
  void on_channel(const Channel& channel) override { know(channel); }
  void on_message(const Message& message, const Channel& channel) override {
    know(channel);
    if (!failed_) look(to_.put(message));
  }
  void on_attachment(const Attachment& attachment, const RecordView& /*record*/) override { look(to_.put(attachment)); }
  void on_metadata(const Metadata& metadata, const RecordView& /*record*/) override { look(to_.put(metadata)); }

  [[nodiscard]] const std::optional<Error>& failed() const { return failed_; }

 private:
  // Once each. A channel whose schema is not there was reported as a fault; its messages are copied without it.
  void know(Channel channel) {
    if (failed_ || !known_.insert(channel.id).second) return;
    if (!to_.knows_schema(channel.schema)) channel.schema = 0;
    look(to_.put(channel));
  }
  void look(const Result<void>& written) {
    if (!written && !failed_) failed_ = written.error();
  }

  Writer& to_;
  std::set<std::uint16_t> known_;
  std::optional<Error> failed_;
};

// Empty where there is none: the scan reports that.
std::string profile_of(const Source& source, const Limits& limits) {
  RecordStream stream(source, kMagic.size(), source.size(), limits);
  const auto record = stream.next();
  if (!record || !*record || !(*record)->is(Opcode::header)) return {};
  const auto header = decode_header((*record)->content);
  return header ? header->profile : std::string();
}

}  // namespace

Result<RecoverReport> recover(const Source& source, Sink& out, Compression compression, const Limits& limits) {
  Writer writer(out, {.profile = profile_of(source, limits), .library = "cellmirror", .compression = compression});
  if (auto begun = writer.begin(); !begun) return std::unexpected(begun.error());
  Copier copier(writer);
  auto scanned = scan(source, limits, copier);
  if (!scanned) return std::unexpected(scanned.error());
  if (copier.failed()) return std::unexpected(*copier.failed());
  if (auto finished = writer.finish(); !finished) return std::unexpected(finished.error());
  RecoverReport report;
  report.written = writer.statistics();
  report.chunks_lost = scanned->chunks_lost;
  report.faults = std::move(scanned->faults);
  report.was_whole = report.faults.count() == 0;
  return report;
}

}  // namespace cellmirror::mcap
