#include "ipc/wire/tissue_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/wire/little_endian.hpp"

namespace cellmirror {
namespace {

using namespace little_endian;
using namespace tissue_record_offset;

Result<RecordHeader> header_of(std::span<const std::byte> bytes) {
  const auto header = decode_record_header(bytes);
  if (!header) return std::unexpected(header.error());
  if (header->kind != RecordKind::tissue_event) {
    return fail(fmt::format("a record of kind {}, not {}", static_cast<int>(header->kind),
                            static_cast<int>(RecordKind::tissue_event)));
  }
  if (bytes.size() != kBytes)
    return fail(fmt::format("a record of a tissue event of {} bytes; it has {}", bytes.size(), kBytes));
  return header;
}

// The kind of the event, and the limit where it is of that kind.
Result<void> get_kind(std::span<const std::byte> bytes, TissueRecord& record) {
  const auto kind = get<std::uint8_t>(bytes, kKind);
  const auto limit = get<std::uint8_t>(bytes, kLimit);
  if (kind >= kTissueEventWords.size()) return fail(fmt::format("kind {} of a tissue event is unknown", kind));
  record.kind = static_cast<TissueEventKind>(kind);
  if (limit >= kTissueLimits || (limit != 0 && record.kind != TissueEventKind::limit))
    return fail(fmt::format("a tissue event of kind {} with limit {}", word(record.kind), limit));
  record.limit = static_cast<TissueLimit>(limit);
  if (!all_zero(bytes.subspan(kReserved, kValue - kReserved)))
    return fail("reserved bytes of a tissue event are not 0");
  return {};
}

}  // namespace

TissueRecord tissue_record_of(const NamedTissueEvent& named) {
  const TissueEvent& event = named.event;
  TissueRecord record;
  record.header.time_ns = event.time.ns;
  record.event = event.number;
  record.kind = event.kind;
  if (event.kind == TissueEventKind::limit) record.limit = event.limit;
  record.value = event.value;
  record.place = {event.at.x(), event.at.y(), event.at.z()};
  record.robot = named.robot;
  record.object = named.object;
  record.part = part_of(event);
  return record;
}

Result<std::size_t> encode_tissue_record(const TissueRecord& record, std::span<std::byte> bytes) {
  if (bytes.size() < kBytes) return fail(fmt::format("a tissue event of {} bytes into {}", kBytes, bytes.size()));
  const auto out = bytes.first(kBytes);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::tissue_event;
  encode_record_header(header, out);
  put(out, kEvent, record.event);
  put(out, kKind, static_cast<std::uint8_t>(record.kind));
  put(out, kLimit, static_cast<std::uint8_t>(record.limit));
  put(out, kValue, record.value);
  put_point(out, kPlace, record.place);
  put_name(out, kRobot, kRecordNameBytes, record.robot);
  put_name(out, kObject, kRecordNameBytes, record.object);
  put_name(out, kPart, kRecordNameBytes, record.part);
  return kBytes;
}

Result<TissueRecord> decode_tissue_record(std::span<const std::byte> bytes) {
  const auto header = header_of(bytes);
  if (!header) return std::unexpected(header.error());
  TissueRecord record;
  record.header = *header;
  if (const auto ok = get_kind(bytes, record); !ok) return std::unexpected(ok.error());
  record.event = get<std::uint64_t>(bytes, kEvent);
  record.value = get<double>(bytes, kValue);
  record.place = get_point(bytes, kPlace);
  for (const auto& [offset, text] :
       {std::pair{kRobot, &record.robot}, std::pair{kObject, &record.object}, std::pair{kPart, &record.part}}) {
    auto found = get_text(bytes, offset, kRecordNameBytes);
    if (!found) return std::unexpected(found.error());
    *text = std::move(*found);
  }
  return record;
}

}  // namespace cellmirror
