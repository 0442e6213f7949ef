#include "ipc/record/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/record/decode.hpp"

namespace cellmirror::mcap {

namespace {

constexpr std::uint64_t kFooterContent = 20;
constexpr std::uint64_t kEnd = kRecordHead + kFooterContent + kMagic.size();
constexpr std::size_t kCrcBytes = 4;

template <class Record>
bool take(std::optional<Record> record, std::vector<Record>& into) {
  if (!record) return false;
  into.push_back(*std::move(record));
  return true;
}

// False where its content is wrong.
bool take_record(const RecordView& record, Summary& out) {
  switch (static_cast<Opcode>(record.opcode)) {
    case Opcode::schema: {
      auto schema = decode_schema(record.content);
      return schema && out.catalogue.add(*std::move(schema)).empty();
    }
    case Opcode::channel: {
      auto channel = decode_channel(record.content);
      if (!channel) return false;
      // A summary may repeat channels without their schemas, or schemas behind them.
      const auto [known, is_new] = out.catalogue.channels.try_emplace(channel->id, *channel);
      return is_new || known->second == *channel;
    }
    case Opcode::statistics:
      out.statistics = decode_statistics(record.content);
      return out.statistics.has_value();
    case Opcode::chunk_index:
      return take(decode_chunk_index(record.content), out.chunks);
    case Opcode::attachment_index:
      return take(decode_attachment_index(record.content), out.attachments);
    case Opcode::metadata_index:
      return take(decode_metadata_index(record.content), out.metadata);
    default:
      return true;
  }
}

}  // namespace

Result<Summary> read_summary(const Source& source, const Limits& limits) {
  const std::uint64_t size = source.size();
  if (size < kMagic.size() + kEnd) return fail("the file has no summary: it is too short");
  const std::uint64_t footer_at = size - kEnd;
  std::array<std::byte, kEnd> end;
  if (auto got = source.read(footer_at, end); !got) return std::unexpected(got.error());
  if (!std::ranges::equal(View(end).last(kMagic.size()), std::as_bytes(std::span(kMagic))))
    return fail("the file has no summary: it does not end with MCAP's magic");
  RecordList footer_list(View(end).first(kEnd - kMagic.size()));
  const auto footer_record = footer_list.next();
  const auto footer = footer_record && footer_record->is(Opcode::footer) ? decode_footer(footer_record->content)
                                                                         : std::optional<Footer>();
  if (!footer) return fail(fmt::format("at byte {}: there is no footer", footer_at));
  Summary out;
  out.footer = *footer;
  if (footer->summary_start == 0) return fail("the file has no summary");
  if (footer->summary_start < kMagic.size() || footer->summary_start > footer_at)
    return fail(fmt::format("at byte {}: the summary would begin at byte {}", footer_at, footer->summary_start));
  const std::uint64_t summary_size = footer_at - footer->summary_start;
  if (summary_size > limits.summary_bytes)
    return fail(fmt::format("at byte {}: a summary of {} bytes", footer->summary_start, summary_size));
  // With the footer up to its CRC, which the CRC covers.
  Bytes bytes(summary_size + kRecordHead + kFooterContent - kCrcBytes);
  if (auto got = source.read(footer->summary_start, bytes); !got) return std::unexpected(got.error());
  if (footer->summary_crc != 0 && footer->summary_crc != crc32(bytes))
    return fail(fmt::format("at byte {}: the CRC of the summary is wrong", footer->summary_start));
  RecordList records(View(bytes).first(summary_size));
  while (const auto record = records.next()) {
    if (!take_record(*record, out)) {
      return fail(fmt::format("at byte {}: a record of kind {:#04x} in the summary is wrong",
                              footer->summary_start + record->offset, record->opcode));
    }
  }
  if (!records.ok())
    return fail(fmt::format("at byte {}: the summary is cut off", footer->summary_start + records.offset()));
  return out;
}

}  // namespace cellmirror::mcap
