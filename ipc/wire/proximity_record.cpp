#include "ipc/wire/proximity_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/wire/little_endian.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror {
namespace {

using namespace little_endian;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PointRecord point_record(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

std::string name_of(const ProximityState& state, std::uint32_t body) {
  CELLMIRROR_EXPECTS(state.names != nullptr && body < state.names->size());
  return state.short_name(body);
}

std::uint32_t counted(std::size_t count) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(count, std::numeric_limits<std::uint32_t>::max()));
}

template <class Pair>
const Pair* find_pair(const std::vector<Pair>& pairs, std::uint32_t a, std::uint32_t b) {
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& p) { return p.a == a && p.b == b; });
  return found == pairs.end() ? nullptr : &*found;
}

PairRecord pair_record(const ProximityState& state, const TouchingPair& pair) {
  PairRecord record;
  record.a = name_of(state, pair.a);
  record.b = name_of(state, pair.b);
  record.depth = pair.depth_m;
  record.point_a = record.point_b = point_record(pair.point_m);
  record.normal = point_record(pair.normal);
  record.touching = record.within_warning = true;
  record.doubtful = pair.doubtful;
  record.contacts = counted(pair.points.size());
  record.contact_age = seconds(state.posture_time - pair.contact_time);
  if (const NearPair* near = find_pair(state.near, pair.a, pair.b)) {
    record.closing_speed = near->closing_speed_m_s.value_or(kNaN);
    record.time_to_contact = near->time_to_contact_s.value_or(kNaN);
  }
  return record;
}

PairRecord pair_record(const ProximityState& state, const NearPair& pair) {
  PairRecord record;
  record.a = name_of(state, pair.a);
  record.b = name_of(state, pair.b);
  record.distance = pair.distance_m;
  record.point_a = point_record(pair.point_a_m);
  record.point_b = point_record(pair.point_b_m);
  record.closing_speed = pair.closing_speed_m_s.value_or(kNaN);
  record.time_to_contact = pair.time_to_contact_s.value_or(kNaN);
  record.within_warning = pair.within_warning;
  record.doubtful = pair.doubtful;
  return record;
}

void put_pair(std::span<std::byte> bytes, const PairRecord& pair) {
  using namespace proximity_record_offset;
  put_path(bytes, kPairA, kRecordPathBytes, pair.a);
  put_path(bytes, kPairB, kRecordPathBytes, pair.b);
  put(bytes, kPairDistance, pair.distance);
  put(bytes, kPairDepth, pair.depth);
  put_point(bytes, kPairPointA, pair.point_a);
  put_point(bytes, kPairPointB, pair.point_b);
  put_point(bytes, kPairNormal, pair.normal);
  put(bytes, kPairClosingSpeed, pair.closing_speed);
  put(bytes, kPairTimeToContact, pair.time_to_contact);
  put(bytes, kPairFlags,
      (pair.touching ? kPairTouching : 0U) | (pair.within_warning ? kPairWithinWarning : 0U) |
          (pair.doubtful ? kPairDoubtful : 0U));
  put(bytes, kPairContacts, pair.contacts);
  put(bytes, kPairContactAge, pair.contact_age);
}

Result<PairRecord> get_pair(std::span<const std::byte> bytes) {
  using namespace proximity_record_offset;
  auto a = get_text(bytes, kPairA, kRecordPathBytes);
  if (!a) return std::unexpected(a.error());
  auto b = get_text(bytes, kPairB, kRecordPathBytes);
  if (!b) return std::unexpected(b.error());
  const auto flags = get<std::uint32_t>(bytes, kPairFlags);
  if (flags > (kPairTouching | kPairWithinWarning | kPairDoubtful)) {
    return fail(fmt::format("flags {:#x} of a pair are unknown", flags));
  }
  PairRecord pair;
  pair.a = std::move(*a);
  pair.b = std::move(*b);
  pair.distance = get<double>(bytes, kPairDistance);
  pair.depth = get<double>(bytes, kPairDepth);
  pair.point_a = get_point(bytes, kPairPointA);
  pair.point_b = get_point(bytes, kPairPointB);
  pair.normal = get_point(bytes, kPairNormal);
  pair.closing_speed = get<double>(bytes, kPairClosingSpeed);
  pair.time_to_contact = get<double>(bytes, kPairTimeToContact);
  pair.touching = (flags & kPairTouching) != 0;
  pair.within_warning = (flags & kPairWithinWarning) != 0;
  pair.doubtful = (flags & kPairDoubtful) != 0;
  pair.contacts = get<std::uint32_t>(bytes, kPairContacts);
  pair.contact_age = get<double>(bytes, kPairContactAge);
  return pair;
}

Result<RecordHeader> header_of(std::span<const std::byte> bytes, RecordKind kind, std::size_t least) {
  auto header = decode_record_header(bytes);
  if (!header) return header;
  if (header->kind != kind) {
    return fail(fmt::format("a record of kind {}, not {}", static_cast<int>(header->kind), static_cast<int>(kind)));
  }
  if (bytes.size() < least) return fail(fmt::format("a record of {} bytes; it has {} at least", bytes.size(), least));
  return header;
}

}  // namespace

ProximityRecord proximity_record_of(const ProximityState& state) {
  ProximityRecord record;
  record.header.time_ns = state.posture_time.ns;
  record.check = state.sequence;
  record.warning_distance = state.warning_distance_m;
  record.computed_after = seconds(state.finished - state.posture_time);
  record.tested = counted(state.pairs);
  record.touching = counted(state.touching.size());
  record.doubts = counted(state.doubts.size());
  std::vector<const TouchingPair*> deepest;
  for (const TouchingPair& pair : state.touching) deepest.push_back(&pair);
  std::stable_sort(deepest.begin(), deepest.end(), [](auto* x, auto* y) { return x->depth_m > y->depth_m; });
  for (const TouchingPair* pair : deepest) {
    if (record.pairs.size() < kMaxPairsInRecord) record.pairs.push_back(pair_record(state, *pair));
  }
  std::size_t apart = 0;
  std::size_t apart_within_warning = 0;
  for (const NearPair& pair : state.near) {
    if (find_pair(state.touching, pair.a, pair.b) != nullptr) continue;
    ++apart;
    apart_within_warning += pair.within_warning ? 1 : 0;
    if (record.pairs.size() < kMaxPairsInRecord) record.pairs.push_back(pair_record(state, pair));
  }
  record.within_warning = counted(state.touching.size() + apart_within_warning);
  record.found = counted(state.touching.size() + apart);
  return record;
}

EventRecord event_record_of(const ProximityEvent& event) {
  EventRecord record;
  record.header.time_ns = event.posture_time.ns;
  record.event = event.sequence;
  record.change = event.change;
  record.distance = event.distance_m;
  record.a = event.short_a.empty() ? event.a : event.short_a;
  record.b = event.short_b.empty() ? event.b : event.short_b;
  return record;
}

Result<std::size_t> encode_proximity_record(const ProximityRecord& record, std::span<std::byte> bytes) {
  using namespace proximity_record_offset;
  const std::size_t count = record.pairs.size();
  if (count > kMaxPairsInRecord || count > record.found) {
    return fail(fmt::format("{} pairs of {} found; a record holds {}", count, record.found, kMaxPairsInRecord));
  }
  const std::size_t length = kPairs + count * kPairBytes;
  if (bytes.size() < length) return fail(fmt::format("a proximity record of {} bytes into {}", length, bytes.size()));
  const auto out = bytes.first(length);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::proximity;
  encode_record_header(header, out);
  put(out, kCheck, record.check);
  put(out, kWarningDistance, record.warning_distance);
  put(out, kComputedAfter, record.computed_after);
  put(out, kTested, record.tested);
  put(out, kTouching, record.touching);
  put(out, kWithinWarning, record.within_warning);
  put(out, kDoubts, record.doubts);
  put(out, kFound, record.found);
  put(out, kPairCount, static_cast<std::uint16_t>(count));
  for (std::size_t i = 0; i < count; ++i) put_pair(out.subspan(kPairs + i * kPairBytes, kPairBytes), record.pairs[i]);
  return length;
}

Result<ProximityRecord> decode_proximity_record(std::span<const std::byte> bytes) {
  using namespace proximity_record_offset;
  const auto header = header_of(bytes, RecordKind::proximity, kPairs);
  if (!header) return std::unexpected(header.error());
  ProximityRecord record;
  record.header = *header;
  record.check = get<std::uint64_t>(bytes, kCheck);
  record.warning_distance = get<double>(bytes, kWarningDistance);
  record.computed_after = get<double>(bytes, kComputedAfter);
  record.tested = get<std::uint32_t>(bytes, kTested);
  record.touching = get<std::uint32_t>(bytes, kTouching);
  record.within_warning = get<std::uint32_t>(bytes, kWithinWarning);
  record.doubts = get<std::uint32_t>(bytes, kDoubts);
  record.found = get<std::uint32_t>(bytes, kFound);
  const std::size_t count = get<std::uint16_t>(bytes, kPairCount);
  if (count > kMaxPairsInRecord || count > record.found || bytes.size() != kPairs + count * kPairBytes) {
    return fail(fmt::format("{} pairs of {} do not fit a record of {} bytes", count, record.found, bytes.size()));
  }
  if (get<std::uint16_t>(bytes, kReserved) != 0) return fail("reserved bytes of a proximity record are not 0");
  record.pairs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    auto pair = get_pair(bytes.subspan(kPairs + i * kPairBytes, kPairBytes));
    if (!pair) return fail(fmt::format("pair {}: {}", i, pair.error().what));
    record.pairs.push_back(std::move(*pair));
  }
  return record;
}

Result<std::size_t> encode_event_record(const EventRecord& record, std::span<std::byte> bytes) {
  using namespace event_record_offset;
  if (bytes.size() < kBytes) return fail(fmt::format("an event record of {} bytes into {}", kBytes, bytes.size()));
  const auto out = bytes.first(kBytes);
  std::fill(out.begin(), out.end(), std::byte{0});
  RecordHeader header = record.header;
  header.kind = RecordKind::proximity_event;
  encode_record_header(header, out);
  put(out, kEvent, record.event);
  put(out, kChange, static_cast<std::uint8_t>(record.change));
  put(out, kDistance, record.distance);
  put_path(out, kA, kRecordPathBytes, record.a);
  put_path(out, kB, kRecordPathBytes, record.b);
  return kBytes;
}

Result<EventRecord> decode_event_record(std::span<const std::byte> bytes) {
  using namespace event_record_offset;
  const auto header = header_of(bytes, RecordKind::proximity_event, kBytes);
  if (!header) return std::unexpected(header.error());
  if (bytes.size() != kBytes) return fail(fmt::format("an event record of {} bytes; it has {}", bytes.size(), kBytes));
  const auto change = get<std::uint8_t>(bytes, kChange);
  if (change > static_cast<std::uint8_t>(ProximityChange::left_warning)) {
    return fail(fmt::format("change {} is unknown", change));
  }
  if (!all_zero(bytes.subspan(kReserved, kDistance - kReserved))) return fail("reserved bytes of an event are not 0");
  auto a = get_text(bytes, kA, kRecordPathBytes);
  if (!a) return std::unexpected(a.error());
  auto b = get_text(bytes, kB, kRecordPathBytes);
  if (!b) return std::unexpected(b.error());
  EventRecord record;
  record.header = *header;
  record.event = get<std::uint64_t>(bytes, kEvent);
  record.change = static_cast<ProximityChange>(change);
  record.distance = get<double>(bytes, kDistance);
  record.a = std::move(*a);
  record.b = std::move(*b);
  return record;
}

}  // namespace cellmirror
