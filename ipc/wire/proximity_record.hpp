// Records of what touches and what is near (SENSOR channel): the pairs of one posture, and single events.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "ipc/wire/record.hpp"
#include "ipc/wire/record_fields.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror {

inline constexpr std::uint32_t kPairTouching = 1;
inline constexpr std::uint32_t kPairWithinWarning = 2;
inline constexpr std::uint32_t kPairDoubtful = 4;  // touching or its distance is not certain: take it as touching

// This many fit into less than a quarter of a queue of 16,384 bytes, which the robots' records share.
inline constexpr std::size_t kMaxPairsInRecord = 10;

namespace proximity_record_offset {
// From the start of the record.
inline constexpr std::size_t kCheck = 40;            // u64
inline constexpr std::size_t kWarningDistance = 48;  // f64
inline constexpr std::size_t kComputedAfter = 56;    // f64
inline constexpr std::size_t kTested = 64;           // u32
inline constexpr std::size_t kTouching = 68;         // u32
inline constexpr std::size_t kWithinWarning = 72;    // u32
inline constexpr std::size_t kDoubts = 76;           // u32
inline constexpr std::size_t kFound = 80;            // u32
inline constexpr std::size_t kPairCount = 84;        // u16
inline constexpr std::size_t kReserved = 86;         // u16, 0
inline constexpr std::size_t kPairs = 88;            // first pair
// From the start of a pair.
inline constexpr std::size_t kPairA = 0;                // char[128]
inline constexpr std::size_t kPairB = 128;              // char[128]
inline constexpr std::size_t kPairDistance = 256;       // f64
inline constexpr std::size_t kPairDepth = 264;          // f64
inline constexpr std::size_t kPairPointA = 272;         // f64[3]
inline constexpr std::size_t kPairPointB = 296;         // f64[3]
inline constexpr std::size_t kPairNormal = 320;         // f64[3]
inline constexpr std::size_t kPairClosingSpeed = 344;   // f64
inline constexpr std::size_t kPairTimeToContact = 352;  // f64
inline constexpr std::size_t kPairFlags = 360;          // u32
inline constexpr std::size_t kPairContacts = 364;       // u32
inline constexpr std::size_t kPairContactAge = 368;     // f64
inline constexpr std::size_t kPairBytes = 376;
}  // namespace proximity_record_offset

namespace event_record_offset {
// From the start of the record.
inline constexpr std::size_t kEvent = 40;     // u64
inline constexpr std::size_t kChange = 48;    // u8
inline constexpr std::size_t kReserved = 49;  // 7 bytes, 0
inline constexpr std::size_t kDistance = 56;  // f64
inline constexpr std::size_t kA = 64;         // char[128]
inline constexpr std::size_t kB = 192;        // char[128]
inline constexpr std::size_t kBytes = 320;
}  // namespace event_record_offset

inline constexpr std::size_t kMaxProximityRecordBytes =
    proximity_record_offset::kPairs + kMaxPairsInRecord * proximity_record_offset::kPairBytes;
static_assert(kMaxProximityRecordBytes <= kMaxRecordBytes / 2);

struct PairRecord {
  std::string a;  // dotted path of the body
  std::string b;
  double distance = 0;                                                // m; 0 for bodies that touch
  double depth = 0;                                                   // m; 0 for bodies that do not touch
  PointRecord point_a{};                                              // nearest points; of bodies that touch the
  PointRecord point_b{};                                              // deepest contact, twice
  PointRecord normal{};                                               // of a contact: unit vector from a to b
  double closing_speed = std::numeric_limits<double>::quiet_NaN();    // m/s; NaN: not known
  double time_to_contact = std::numeric_limits<double>::quiet_NaN();  // s; NaN: they do not approach, or not known
  bool touching = false;
  bool within_warning = false;
  bool doubtful = false;
  std::uint32_t contacts = 0;  // contact points that were found
  double contact_age = 0;      // s that the contact is older than the record's posture
};

struct ProximityRecord {
  RecordHeader header;
  std::uint64_t check = 0;           // number of the computation
  double warning_distance = 0;       // m
  double computed_after = 0;         // s, from the posture's instant to the end of the computation
  std::uint32_t tested = 0;          // pairs
  std::uint32_t touching = 0;        // pairs
  std::uint32_t within_warning = 0;  // pairs, those that touch included
  std::uint32_t doubts = 0;          // things that could not be computed for sure
  std::uint32_t found = 0;           // pairs that would be listed if all had room
  std::vector<PairRecord> pairs;     // those that touch, deepest first, then the others, nearest first
};

struct EventRecord {
  RecordHeader header;
  std::uint64_t event = 0;  // from 1; a gap gives the number lost
  ProximityChange change = ProximityChange::entered_warning;
  double distance = 0;  // m
  std::string a;
  std::string b;
};

// Records of a state and of an event; the sender fills in sequence and wall time. Pairs beyond kMaxPairsInRecord are
// left out; `found` counts them.
[[nodiscard]] ProximityRecord proximity_record_of(const ProximityState& state);
[[nodiscard]] EventRecord event_record_of(const ProximityEvent& event);

// As encode_robot_record: the length that was written; fails where `bytes` is too small (kMaxProximityRecordBytes
// always suffices) and for more pairs than fit or were found.
[[nodiscard]] Result<std::size_t> encode_proximity_record(const ProximityRecord& record, std::span<std::byte> bytes);
[[nodiscard]] Result<std::size_t> encode_event_record(const EventRecord& record, std::span<std::byte> bytes);

// Strict: whatever the encoder would not write is refused. Numbers are passed on as they are, NaN too.
[[nodiscard]] Result<ProximityRecord> decode_proximity_record(std::span<const std::byte> bytes);
[[nodiscard]] Result<EventRecord> decode_event_record(std::span<const std::byte> bytes);

}  // namespace cellmirror
