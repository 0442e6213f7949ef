#include "ipc/wire/record.hpp"

#include <fmt/format.h>

#include "ipc/wire/little_endian.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror {
namespace {

using namespace little_endian;
using namespace record_offset;

bool known_kind(std::uint16_t kind) {
  return kind >= static_cast<std::uint16_t>(RecordKind::robot_parameters) &&
         kind <= static_cast<std::uint16_t>(RecordKind::light_barrier);
}

}  // namespace

Result<RecordHeader> decode_record_header(std::span<const std::byte> record) {
  if (record.size() < kHeaderBytes || record.size() > kMaxRecordBytes) {
    return fail(
        fmt::format("a record of {} bytes; records have {} to {}", record.size(), kHeaderBytes, kMaxRecordBytes));
  }
  if (get<std::uint32_t>(record, kMagic) != kRecordMagic)
    return fail("not a cellmirror record: it does not begin with CMIR");
  const auto version = get<std::uint16_t>(record, kVersion);
  if (version != kRecordVersion) {
    return fail(fmt::format("record version {}, this program reads version {}", version, kRecordVersion),
                "use programs and gateway of the same version");
  }
  const auto kind = get<std::uint16_t>(record, kKind);
  if (!known_kind(kind)) return fail(fmt::format("record kind {} is unknown", kind));
  const auto length = get<std::uint32_t>(record, kLength);
  if (length != record.size()) {
    return fail(fmt::format("the record declares {} bytes, but {} were received", length, record.size()));
  }
  if (get<std::uint32_t>(record, kReserved) != 0) return fail("reserved bytes of the record's header are not 0");
  return RecordHeader{static_cast<RecordKind>(kind), length, get<std::uint64_t>(record, kSequence),
                      get<std::int64_t>(record, kTime), get<std::int64_t>(record, kWallTime)};
}

void encode_record_header(const RecordHeader& header, std::span<std::byte> record) {
  CELLMIRROR_EXPECTS(record.size() >= kHeaderBytes && record.size() <= kMaxRecordBytes);
  put(record, kMagic, kRecordMagic);
  put(record, kVersion, kRecordVersion);
  put(record, kKind, static_cast<std::uint16_t>(header.kind));
  put(record, kLength, static_cast<std::uint32_t>(record.size()));
  put(record, kReserved, std::uint32_t{0});
  put(record, kSequence, header.sequence);
  put(record, kTime, header.time_ns);
  put(record, kWallTime, header.wall_time_ns);
}

}  // namespace cellmirror
