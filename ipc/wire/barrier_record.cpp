#include "ipc/wire/barrier_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/wire/little_endian.hpp"
#include "ipc/wire/record_fields.hpp"

namespace cellmirror {

using namespace little_endian;

BarrierRecord barrier_record_of(const BarrierReading& reading) {
  BarrierRecord record;
  record.header.time_ns = reading.posture_time.ns;
  record.id = reading.name;
  record.object = reading.short_object.empty() ? reading.object : reading.short_object;
  record.interruptions = reading.interruptions;
  record.interrupted = reading.interrupted;
  record.doubtful = reading.doubtful;
  return record;
}

Result<std::size_t> encode_barrier_record(const BarrierRecord& record, std::span<std::byte> bytes) {
  using namespace barrier_record_offset;
  if (bytes.size() < kBytes)
    return fail(fmt::format("a record of a light barrier of {} bytes into {}", kBytes, bytes.size()));
  if (!record.interrupted && !record.object.empty()) return fail("a body in a beam that is free");
  const auto out = bytes.first(kBytes);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::light_barrier;
  encode_record_header(header, out);
  put_name(out, kId, kRecordNameBytes, record.id);
  put_path(out, kObject, kRecordPathBytes, record.object);
  put(out, kInterruptions, record.interruptions);
  put(out, kFlags, (record.interrupted ? kBarrierInterrupted : 0U) | (record.doubtful ? kBarrierDoubtful : 0U));
  return kBytes;
}

Result<BarrierRecord> decode_barrier_record(std::span<const std::byte> bytes) {
  using namespace barrier_record_offset;
  const auto header = decode_record_header(bytes);
  if (!header) return std::unexpected(header.error());
  if (header->kind != RecordKind::light_barrier)
    return fail(fmt::format("a record of kind {}, not {}", static_cast<int>(header->kind),
                            static_cast<int>(RecordKind::light_barrier)));
  if (bytes.size() != kBytes)
    return fail(fmt::format("a record of a light barrier of {} bytes; it has {}", bytes.size(), kBytes));
  auto id = get_text(bytes, kId, kRecordNameBytes);
  if (!id) return std::unexpected(id.error());
  auto object = get_text(bytes, kObject, kRecordPathBytes);
  if (!object) return std::unexpected(object.error());
  const auto flags = get<std::uint32_t>(bytes, kFlags);
  if (flags > (kBarrierInterrupted | kBarrierDoubtful))
    return fail(fmt::format("flags {:#x} of a light barrier are unknown", flags));
  if (get<std::uint32_t>(bytes, kReserved) != 0) return fail("reserved bytes of a light barrier are not 0");
  BarrierRecord record;
  record.header = *header;
  record.id = std::move(*id);
  record.object = std::move(*object);
  record.interruptions = get<std::uint64_t>(bytes, kInterruptions);
  record.interrupted = (flags & kBarrierInterrupted) != 0;
  record.doubtful = (flags & kBarrierDoubtful) != 0;
  if (!record.interrupted && !record.object.empty()) return fail("a body in a beam that is free");
  return record;
}

}  // namespace cellmirror
