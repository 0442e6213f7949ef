#include "ipc/wire/range_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/wire/little_endian.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror {
namespace {

using namespace little_endian;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Of a RangeRecord or a RangeEntry.
std::uint32_t flags_of(const auto& range) {
  return (std::isnan(range.distance) ? 0U : kRangeSeen) | (range.in_blind_zone ? kRangeInBlindZone : 0U) |
         (range.doubtful ? kRangeDoubtful : 0U);
}

// The flags at `offset` and the reserved number behind them; the distance is known already.
Result<void> get_flags(std::span<const std::byte> bytes, std::size_t offset, auto& range) {
  const auto flags = get<std::uint32_t>(bytes, offset);
  const bool seen = (flags & kRangeSeen) != 0;
  range.in_blind_zone = (flags & kRangeInBlindZone) != 0;
  range.doubtful = (flags & kRangeDoubtful) != 0;
  if (flags > (kRangeSeen | kRangeInBlindZone | kRangeDoubtful))
    return fail(fmt::format("flags {:#x} of a range are unknown", flags));
  if (seen == std::isnan(range.distance)) return fail("a range with contradictory flags and distance");
  if (range.in_blind_zone && !seen) return fail("no echo, but in the blind zone");
  if (get<std::uint32_t>(bytes, offset + sizeof flags) != 0) return fail("reserved bytes of a range are not 0");
  return {};
}

PointRecord point_of(const RangeReading& reading) {
  if (!reading.distance_m) return {kNaN, kNaN, kNaN};
  return {reading.point_m.x(), reading.point_m.y(), reading.point_m.z()};
}

Result<void> check_kind(std::span<const std::byte> bytes, RecordKind kind, std::size_t least, RecordHeader& header) {
  const auto found = decode_record_header(bytes);
  if (!found) return std::unexpected(found.error());
  if (found->kind != kind) {
    return fail(fmt::format("a record of kind {}, not {}", static_cast<int>(found->kind), static_cast<int>(kind)));
  }
  if (bytes.size() < least) return fail(fmt::format("a range record of {} bytes; it has {}", bytes.size(), least));
  header = *found;
  return {};
}

void put_entry(std::span<std::byte> bytes, const RangeEntry& entry) {
  using namespace range_array_offset;
  put_name(bytes, kEntryId, kRecordNameBytes, entry.id);
  put(bytes, kEntryDistance, entry.distance);
  put(bytes, kEntryRange, entry.range);
  put_point(bytes, kEntryPoint, entry.point);
  put(bytes, kEntryFlags, flags_of(entry));
}

Result<RangeEntry> get_entry(std::span<const std::byte> bytes) {
  using namespace range_array_offset;
  auto id = get_text(bytes, kEntryId, kRecordNameBytes);
  if (!id) return std::unexpected(id.error());
  RangeEntry entry;
  entry.id = std::move(*id);
  entry.distance = get<double>(bytes, kEntryDistance);
  entry.range = get<double>(bytes, kEntryRange);
  entry.point = get_point(bytes, kEntryPoint);
  if (const auto ok = get_flags(bytes, kEntryFlags, entry); !ok) return std::unexpected(ok.error());
  return entry;
}

// Whether the counts of a part are those of a whole that was cut into parts.
Result<void> check_counts(const RangeArrayRecord& record, std::size_t count) {
  if (record.part < 1 || record.part > record.parts) {
    return fail(fmt::format("part {} of {}", record.part, record.parts));
  }
  if (count < 1 || count > kMaxRangesInRecord || count > record.total || record.parts > record.total) {
    return fail(fmt::format("{} ranges in one of {} parts, {} in all", count, record.parts, record.total),
                fmt::format("a record holds 1 to {}", kMaxRangesInRecord));
  }
  return {};
}

}  // namespace

RangeRecord range_record_of(const RangeReading& reading) {
  RangeRecord record;
  record.header.time_ns = reading.posture_time.ns;
  record.id = reading.id;
  record.object = reading.short_object.empty() ? reading.object : reading.short_object;
  record.distance = reading.distance_m.value_or(kNaN);
  record.range = reading.range_m;
  record.blind_zone = reading.blind_zone_m;
  record.half_angle = reading.half_angle_rad;
  record.point = point_of(reading);
  record.in_blind_zone = reading.in_blind_zone && reading.distance_m.has_value();
  record.doubtful = reading.doubtful;
  return record;
}

std::vector<RangeArrayRecord> range_arrays_of(std::span<const RangeReading> readings) {
  CELLMIRROR_EXPECTS(readings.size() <= std::numeric_limits<std::uint16_t>::max());
  const std::size_t parts = (readings.size() + kMaxRangesInRecord - 1) / kMaxRangesInRecord;
  std::vector<RangeArrayRecord> records(parts);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const RangeReading& reading = readings[i];
    records[i / kMaxRangesInRecord].ranges.push_back(
        {reading.id, reading.distance_m.value_or(kNaN), reading.range_m, point_of(reading),
         reading.in_blind_zone && reading.distance_m.has_value(), reading.doubtful});
  }
  for (std::size_t i = 0; i < parts; ++i) {
    records[i].header.time_ns = readings.front().posture_time.ns;
    records[i].part = static_cast<std::uint16_t>(i + 1);
    records[i].parts = static_cast<std::uint16_t>(parts);
    records[i].total = static_cast<std::uint16_t>(readings.size());
  }
  return records;
}

Result<std::size_t> encode_range_record(const RangeRecord& record, std::span<std::byte> bytes) {
  using namespace range_record_offset;
  if (bytes.size() < kBytes) return fail(fmt::format("a range record of {} bytes into {}", kBytes, bytes.size()));
  if (record.in_blind_zone && std::isnan(record.distance)) return fail("no echo, but in the blind zone");
  const auto out = bytes.first(kBytes);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::ultrasonic_range;
  encode_record_header(header, out);
  put_name(out, kId, kRecordNameBytes, record.id);
  put_path(out, kObject, kRecordPathBytes, record.object);
  put(out, kDistance, record.distance);
  put(out, kRange, record.range);
  put(out, kBlindZone, record.blind_zone);
  put(out, kHalfAngle, record.half_angle);
  put_point(out, kPoint, record.point);
  put(out, kFlags, flags_of(record));
  return kBytes;
}

Result<RangeRecord> decode_range_record(std::span<const std::byte> bytes) {
  using namespace range_record_offset;
  RangeRecord record;
  if (const auto ok = check_kind(bytes, RecordKind::ultrasonic_range, kBytes, record.header); !ok) {
    return std::unexpected(ok.error());
  }
  if (bytes.size() != kBytes) return fail(fmt::format("a range record of {} bytes; it has {}", bytes.size(), kBytes));
  auto id = get_text(bytes, kId, kRecordNameBytes);
  if (!id) return std::unexpected(id.error());
  auto object = get_text(bytes, kObject, kRecordPathBytes);
  if (!object) return std::unexpected(object.error());
  record.id = std::move(*id);
  record.object = std::move(*object);
  record.distance = get<double>(bytes, kDistance);
  record.range = get<double>(bytes, kRange);
  record.blind_zone = get<double>(bytes, kBlindZone);
  record.half_angle = get<double>(bytes, kHalfAngle);
  record.point = get_point(bytes, kPoint);
  if (const auto ok = get_flags(bytes, kFlags, record); !ok) return std::unexpected(ok.error());
  return record;
}

Result<std::size_t> encode_range_array(const RangeArrayRecord& record, std::span<std::byte> bytes) {
  using namespace range_array_offset;
  if (const auto ok = check_counts(record, record.ranges.size()); !ok) return std::unexpected(ok.error());
  const std::size_t length = kRanges + record.ranges.size() * kEntryBytes;
  if (bytes.size() < length) return fail(fmt::format("a range record of {} bytes into {}", length, bytes.size()));
  const auto out = bytes.first(length);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::ultrasonic_range_array;
  encode_record_header(header, out);
  put(out, kPart, record.part);
  put(out, kParts, record.parts);
  put(out, kCount, static_cast<std::uint16_t>(record.ranges.size()));
  put(out, kTotal, record.total);
  for (std::size_t i = 0; i < record.ranges.size(); ++i) {
    const RangeEntry& entry = record.ranges[i];
    if (entry.in_blind_zone && std::isnan(entry.distance)) return fail("no echo, but in the blind zone");
    put_entry(out.subspan(kRanges + i * kEntryBytes, kEntryBytes), entry);
  }
  return length;
}

Result<RangeArrayRecord> decode_range_array(std::span<const std::byte> bytes) {
  using namespace range_array_offset;
  RangeArrayRecord record;
  if (const auto ok = check_kind(bytes, RecordKind::ultrasonic_range_array, kRanges, record.header); !ok) {
    return std::unexpected(ok.error());
  }
  record.part = get<std::uint16_t>(bytes, kPart);
  record.parts = get<std::uint16_t>(bytes, kParts);
  record.total = get<std::uint16_t>(bytes, kTotal);
  const std::size_t count = get<std::uint16_t>(bytes, kCount);
  if (const auto ok = check_counts(record, count); !ok) return std::unexpected(ok.error());
  if (bytes.size() != kRanges + count * kEntryBytes) {
    return fail(fmt::format("{} ranges do not fit a record of {} bytes", count, bytes.size()));
  }
  record.ranges.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    auto entry = get_entry(bytes.subspan(kRanges + i * kEntryBytes, kEntryBytes));
    if (!entry) return fail(fmt::format("range {}: {}", i, entry.error().what));
    record.ranges.push_back(std::move(*entry));
  }
  return record;
}

}  // namespace cellmirror
