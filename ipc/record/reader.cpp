#include "ipc/record/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "ipc/record/decode.hpp"

namespace cellmirror::mcap {

namespace {

// Where attachments and metadata are, for a file without summary.
class Indexer final : public Visitor {
 public:
  void on_attachment(const Attachment& attachment, const RecordView& record) override {
    attachments.push_back({record.offset, kRecordHead + record.content.size(), attachment.log_time,
                           attachment.create_time, attachment.data.size(), attachment.name, attachment.media_type});
  }
  void on_metadata(const Metadata& one, const RecordView& record) override {
    metadata.push_back({record.offset, kRecordHead + record.content.size(), one.name});
  }

  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
};

class Selection final : public Visitor {
 public:
  Selection(const Filter& filter, const Reader::Take& take)
      : filter_(filter), topics_(filter.topics.begin(), filter.topics.end()), take_(take) {}

  void on_message(const Message& message, const Channel& channel) override {
    if (ended_ || message.log_time < filter_.from || message.log_time > filter_.to || !wants(channel)) return;
    ended_ = !take_(message, channel);
  }
  [[nodiscard]] bool wants(const Channel& channel) const { return topics_.empty() || topics_.contains(channel.topic); }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  const Filter& filter_;
  std::set<std::string, std::less<>> topics_;
  const Reader::Take& take_;
  bool ended_ = false;
};

// Whether the summary names all chunks, so that nothing is missed by reading those only.
std::string why_no_index(const Result<Summary>& summary) {
  if (!summary) return summary.error().what;
  if (!summary->statistics) return "the summary has no statistics";
  if (summary->chunks.size() != summary->statistics->chunks) return "the summary does not name all chunks";
  if (summary->statistics->messages > 0 && summary->chunks.empty()) return "its messages are in no chunks";
  if (summary->catalogue.channels.size() < summary->statistics->channel_messages.size())
    return "the summary does not name all channels";
  if (std::ranges::any_of(summary->catalogue.channels, [&](const auto& entry) {
        return entry.second.schema != 0 && summary->catalogue.schema_of(entry.second) == nullptr;
      }))
    return "the summary does not repeat all schemas";
  if (summary->attachments.size() < summary->statistics->attachments)
    return "the summary does not list all attachments";
  if (summary->metadata.size() < summary->statistics->metadata) return "the summary does not list all metadata";
  return {};
}

}  // namespace

Result<Header> Reader::read_header() const {
  std::array<std::byte, kMagic.size()> magic;
  if (source_->size() < magic.size() || !source_->read(0, magic) ||
      !std::ranges::equal(magic, std::as_bytes(std::span(kMagic))))
    return fail("at byte 0: this is no MCAP file of version 0: its first bytes are others",
                "name a file that cellmirror record or another MCAP writer has made");
  RecordStream stream(*source_, magic.size(), source_->size(), limits_);
  const auto record = stream.next();
  if (!record) return std::unexpected(record.error());
  auto header = *record && (*record)->is(Opcode::header) ? decode_header((*record)->content) : std::optional<Header>();
  if (!header) return fail("at byte 8: the first record is no header");
  return *std::move(header);
}

Result<Reader> Reader::open(const Source& source, const Limits& limits) {
  Reader out(source, limits);
  auto header = out.read_header();
  auto summary = read_summary(source, limits);
  out.why_not_ = header ? why_no_index(summary) : header.error().what;
  out.indexed_ = out.why_not_.empty();
  if (out.indexed_) {
    out.header_ = *std::move(header);
    out.catalogue_ = std::move(summary->catalogue);
    out.statistics_ = *std::move(summary->statistics);
    out.chunks_ = std::move(summary->chunks);
    out.attachments_ = std::move(summary->attachments);
    out.metadata_ = std::move(summary->metadata);
    std::ranges::stable_sort(out.chunks_, {}, &ChunkIndex::start_time);
    return out;
  }
  Indexer indexer;
  auto scanned = scan(source, limits, indexer);
  if (!scanned) return std::unexpected(scanned.error());
  if (scanned->recordings > 1)
    out.why_not_ = fmt::format("the file holds {} recordings, one behind the other", scanned->recordings);
  out.header_ = std::move(scanned->header);
  out.catalogue_ = std::move(scanned->catalogue);
  out.statistics_ = std::move(scanned->statistics);
  out.chunks_ = std::move(scanned->chunks);
  out.faults_ = std::move(scanned->faults);
  out.chunks_have_all_ = scanned->chunks_have_all;
  out.chunks_left_out_ = scanned->chunks_left_out;
  out.attachments_ = std::move(indexer.attachments);
  out.metadata_ = std::move(indexer.metadata);
  return out;
}

Result<void> Reader::read(const Filter& filter, const Take& take) {
  if (indexed_ || chunks_have_all_) return read_by_index(filter, take);
  Selection selection(filter, take);
  auto scanned = scan(*source_, limits_, selection);
  if (!scanned) return std::unexpected(scanned.error());
  return {};
}

Result<Bytes> Reader::record_at(std::uint64_t offset, std::uint64_t length, Opcode opcode) const {
  if (length < kRecordHead || length - kRecordHead > limits_.record_bytes || length > source_->size() ||
      offset > source_->size() - length)
    return fail(fmt::format("at byte {}: a record of {} bytes cannot be there", offset, length));
  Bytes out(length);
  if (auto got = source_->read(offset, out); !got) return std::unexpected(got.error());
  RecordList list(out);
  const auto record = list.next();
  if (!record || !record->is(opcode) || record->content.size() != length - kRecordHead)
    return fail(fmt::format("at byte {}: another record than the summary says", offset));
  out.erase(out.begin(), out.begin() + kRecordHead);
  return out;
}

Result<void> Reader::read_by_index(const Filter& filter, const Take& take) {
  Selection selection(filter, take);
  ChunkOpener opener(limits_, source_->size());
  std::uint64_t total = 0;
  std::uint64_t done = 0;
  for (const ChunkIndex& index : chunks_) total += index.length;
  for (const ChunkIndex& index : chunks_) {
    done += index.length;
    if (limits_.progress != nullptr) (*limits_.progress)(done, total);
    if (index.start_time > filter.to || index.end_time < filter.from) continue;
    const bool wanted =
        index.message_index_offsets.empty() || std::ranges::any_of(index.message_index_offsets, [&](const auto& entry) {
          const auto channel = catalogue_.channels.find(entry.first);
          return channel == catalogue_.channels.end() || selection.wants(channel->second);
        });
    if (!wanted) continue;
    const auto bytes = record_at(index.offset, index.length, Opcode::chunk);
    if (!bytes) return std::unexpected(bytes.error());
    const auto chunk = decode_chunk(*bytes);
    if (!chunk) return fail(fmt::format("at byte {}: a chunk that is cut off", index.offset));
    const auto content = opener.open(*chunk);
    if (!content)
      return fail(fmt::format("at byte {}: {}", index.offset, content.error().what), content.error().remedy);
    RecordList records(*content);
    while (const auto record = records.next()) {
      if (!record->is(Opcode::message)) continue;
      const auto message = decode_message(record->content);
      if (!message) return fail(fmt::format("at byte {}: a message that is cut off", index.offset));
      const auto channel = catalogue_.channels.find(message->channel);
      if (channel == catalogue_.channels.end())
        return fail(fmt::format("at byte {}: a message of a channel that is not described", index.offset));
      selection.on_message(*message, channel->second);
      if (selection.ended()) return {};
    }
    if (!records.ok())
      return fail(
          fmt::format("at byte {}: the chunk has no whole record at its byte {}", index.offset, records.offset()));
  }
  return {};
}

std::optional<std::string> Reader::attachment(std::string_view name) const {
  for (auto index = attachments_.rbegin(); index != attachments_.rend(); ++index) {
    if (index->name != name) continue;
    const auto bytes = record_at(index->offset, index->length, Opcode::attachment);
    bool crc_ok = false;
    const auto attachment = bytes ? decode_attachment(*bytes, crc_ok) : std::optional<Attachment>();
    if (!attachment || !crc_ok) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(attachment->data.data()), attachment->data.size());
  }
  return std::nullopt;
}

std::optional<Metadata> Reader::metadata(std::string_view name) const {
  for (auto index = metadata_.rbegin(); index != metadata_.rend(); ++index) {
    if (index->name != name) continue;
    const auto bytes = record_at(index->offset, index->length, Opcode::metadata);
    return bytes ? decode_metadata(*bytes) : std::optional<Metadata>();
  }
  return std::nullopt;
}

}  // namespace cellmirror::mcap
