#include "ipc/wire/proximity_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ipc/sysv/proximity_pacing.hpp"
#include "tests/unit/ipc/golden_bytes.hpp"

namespace cellmirror {
namespace {

using test::Bytes;
using test::place;

void place_header(Bytes& bytes, int kind, int length) {
  place(bytes, 0, "CMIR");
  place(bytes, 4, {0x01, 0x00, kind, 0x00, length & 0xFF, length >> 8});
  place(bytes, 16, {0x07, 0, 0, 0, 0, 0, 0, 0});                       // sequence 7
  place(bytes, 24, {0x00, 0xCA, 0x9A, 0x3B, 0, 0, 0, 0});              // 1,000,000,000 ns
  place(bytes, 32, {0x00, 0x00, 0x2A, 0x36, 0xFE, 0x9C, 0x97, 0x17});  // 1,700,000,000,000,000,000 ns
}

// One pair that touches and one that is near: 88 + 2 * 376 = 840 = 0x348 bytes.
Bytes golden_proximity() {
  Bytes bytes(840, std::byte{0});
  place_header(bytes, 5, 840);
  place(bytes, 40, {0x02, 0x01, 0, 0, 0, 0, 0, 0});        // check 258
  place(bytes, 48, {0, 0, 0, 0, 0, 0, 0xC0, 0x3F});        // warning distance 0.125
  place(bytes, 56, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});        // computed after 0.5 s
  place(bytes, 64, {0x2C, 0x01, 0, 0});                    // 300 tested
  place(bytes, 68, {1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0});  // 1 touching, 2 within warning, 1 doubt
  place(bytes, 80, {2, 0, 0, 0, 2, 0});                    // 2 found, 2 listed
  place(bytes, 88, "w.A");
  place(bytes, 216, "w.B");
  place(bytes, 352, {0, 0, 0, 0, 0, 0, 0xD0, 0x3F});  // depth 0.25
  place(bytes, 360, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // point a: x 1
  place(bytes, 384, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // point b: x 1
  place(bytes, 424, {0, 0, 0, 0, 0, 0, 0xF0, 0xBF});  // normal: z -1
  place(bytes, 432, {0, 0, 0, 0, 0, 0, 0xF8, 0x7F});  // closing speed NaN
  place(bytes, 440, {0, 0, 0, 0, 0, 0, 0xF8, 0x7F});  // time to contact NaN
  place(bytes, 448, {7, 0, 0, 0, 3, 0, 0, 0});        // touching, within warning, doubtful; 3 contacts
  place(bytes, 456, {0, 0, 0, 0, 0, 0, 0xC0, 0x3F});  // contact age 0.125 s
  place(bytes, 464, "w.A");
  place(bytes, 592, "w.C");
  place(bytes, 720, {0, 0, 0, 0, 0, 0, 0xB0, 0x3F});  // distance 0.0625
  place(bytes, 736, {0, 0, 0, 0, 0, 0, 0x00, 0x40});  // point a: x 2
  place(bytes, 768, {0, 0, 0, 0, 0, 0, 0x08, 0x40});  // point b: y 3
  place(bytes, 808, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});  // closing speed 0.5
  place(bytes, 816, {0, 0, 0, 0, 0, 0, 0xC0, 0x3F});  // time to contact 0.125
  place(bytes, 824, {2, 0, 0, 0, 0, 0, 0, 0});        // within warning
  return bytes;
}

ProximityState golden_state() {
  ProximityState state;
  state.posture_time = Timestamp{1'000'000'000};
  state.finished = Timestamp{1'500'000'000};
  state.sequence = 258;
  state.names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"w.A", "w.B", "w.C"});
  state.warning_distance_m = 0.125;
  state.pairs = 300;
  state.doubts = {"A and B"};
  state.touching = {{0, 1, 0.25, {1, 0, 0}, {0, 0, -1}, std::vector<TouchingPoint>(3), true, Timestamp{875'000'000}}};
  state.near = {{0, 1, 0, {1, 0, 0}, {1, 0, 0}, true, true, {}, {}},
                {0, 2, 0.0625, {2, 0, 0}, {0, 3, 0}, true, false, 0.5, 0.125}};
  return state;
}

Bytes encoded(ProximityRecord record) {
  record.header.sequence = 7;
  record.header.wall_time_ns = 1'700'000'000'000'000'000;
  Bytes bytes(kMaxProximityRecordBytes, std::byte{0xEE});
  const auto length = encode_proximity_record(record, bytes);
  EXPECT_TRUE(length) << length.error().text();
  bytes.resize(length.value_or(0));
  return bytes;
}

TEST(ProximityRecord, IsEncodedAsDocumented) {
  EXPECT_EQ(encoded(proximity_record_of(golden_state())), golden_proximity());
}

TEST(ProximityRecord, IsDecodedAsDocumented) {
  const auto sut = decode_proximity_record(golden_proximity());
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->check, 258U);
  EXPECT_EQ(sut->warning_distance, 0.125);
  EXPECT_EQ(sut->computed_after, 0.5);
  EXPECT_EQ(sut->tested, 300U);
  EXPECT_EQ(sut->touching, 1U);
  EXPECT_EQ(sut->within_warning, 2U);
  EXPECT_EQ(sut->doubts, 1U);
  EXPECT_EQ(sut->found, 2U);
  ASSERT_EQ(sut->pairs.size(), 2U);
  EXPECT_EQ(sut->pairs[0].a, "w.A");
  EXPECT_EQ(sut->pairs[0].b, "w.B");
  EXPECT_EQ(sut->pairs[0].depth, 0.25);
  EXPECT_EQ(sut->pairs[0].normal, (PointRecord{0, 0, -1}));
  EXPECT_TRUE(sut->pairs[0].touching && sut->pairs[0].within_warning && sut->pairs[0].doubtful);
  EXPECT_EQ(sut->pairs[0].contacts, 3U);
  EXPECT_EQ(sut->pairs[0].contact_age, 0.125);
  EXPECT_EQ(sut->pairs[1].contact_age, 0.0);
  EXPECT_TRUE(std::isnan(sut->pairs[0].time_to_contact));
  EXPECT_EQ(sut->pairs[1].distance, 0.0625);
  EXPECT_EQ(sut->pairs[1].point_b, (PointRecord{0, 3, 0}));
  EXPECT_EQ(sut->pairs[1].time_to_contact, 0.125);
  EXPECT_FALSE(sut->pairs[1].touching || sut->pairs[1].doubtful);
}

TEST(ProximityRecord, TellsHowManyPairsWereLeftOut) {
  ProximityState state = golden_state();
  std::vector<std::string> names;
  for (int i = 0; i < 40; ++i) names.push_back("b" + std::to_string(i));
  state.names = std::make_shared<const std::vector<std::string>>(names);
  state.touching.clear();
  state.near.clear();
  for (std::uint32_t i = 0; i < 8; ++i) {
    state.touching.push_back({0, i + 1, 0.001 * i, {0, 0, 0}, {0, 0, 0}, {}, false});
    state.near.push_back({0, i + 1, 0, {0, 0, 0}, {0, 0, 0}, true, false, {}, {}});
  }
  for (std::uint32_t i = 20; i < 30; ++i)
    state.near.push_back({1, i, 0.001 * i, {0, 0, 0}, {0, 0, 0}, i < 25, false, {}, {}});
  const auto sut = decode_proximity_record(encoded(proximity_record_of(state)));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->touching, 8U);
  EXPECT_EQ(sut->within_warning, 13U);
  EXPECT_EQ(sut->found, 18U);
  ASSERT_EQ(sut->pairs.size(), kMaxPairsInRecord);
  EXPECT_EQ(sut->pairs[0].b, "b8") << "the deepest first";
  EXPECT_EQ(sut->pairs[7].b, "b1");
  EXPECT_EQ(sut->pairs[8].b, "b20") << "then the nearest";
}

TEST(ProximityRecord, RefusesWhatTheEncoderWouldNotWrite) {
  struct Damage {
    std::size_t offset;
    int value;
    const char* what;
  };
  const Damage damages[] = {{6, 6, "another kind"}, {80, 1, "more listed than found"},
                            {84, 1, "too few"},     {84, 3, "too many"},
                            {85, 1, "258 pairs"},   {86, 1, "reserved"},
                            {100, 'x', "a's NUL"},  {230, 'x', "b's NUL"},
                            {448, 8, "flag"},       {449, 1, "flag"}};
  for (const Damage& damage : damages) {
    Bytes bytes = golden_proximity();
    bytes[damage.offset] = static_cast<std::byte>(damage.value);
    EXPECT_FALSE(decode_proximity_record(bytes)) << damage.what;
  }
  for (std::size_t length = 0; length < 840; ++length) {
    Bytes shorter = golden_proximity();
    shorter.resize(length);
    if (length >= 10) place(shorter, 8, {static_cast<int>(length & 0xFF), static_cast<int>(length >> 8)});
    EXPECT_FALSE(decode_proximity_record(shorter)) << length;
  }
}

TEST(ProximityRecord, EncoderRefusesMorePairsThanFit) {
  ProximityRecord record;
  record.pairs.resize(kMaxPairsInRecord + 1);
  record.found = 100;
  Bytes bytes(kMaxRecordBytes);
  EXPECT_FALSE(encode_proximity_record(record, bytes));
  record.pairs.pop_back();
  EXPECT_TRUE(encode_proximity_record(record, bytes));
  record.found = 3;
  EXPECT_FALSE(encode_proximity_record(record, bytes));
}

Bytes golden_event() {
  Bytes bytes(320, std::byte{0});
  place_header(bytes, 6, 320);
  place(bytes, 40, {0x09, 0, 0, 0, 0, 0, 0, 0, 0x02});  // event 9: parted
  place(bytes, 56, {0, 0, 0, 0, 0, 0, 0xD0, 0x3F});     // 0.25
  place(bytes, 64, "w.A");
  place(bytes, 192, "w.B");
  return bytes;
}

TEST(EventRecord, IsEncodedAndDecodedAsDocumented) {
  EventRecord record = event_record_of({9, ProximityChange::parted, "w.A", "w.B", 0.25, Timestamp{1'000'000'000}});
  record.header.sequence = 7;
  record.header.wall_time_ns = 1'700'000'000'000'000'000;
  Bytes bytes(320, std::byte{0xEE});
  ASSERT_EQ(encode_event_record(record, bytes).value_or(0), 320U);
  EXPECT_EQ(bytes, golden_event());
  const auto sut = decode_event_record(golden_event());
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->event, 9U);
  EXPECT_EQ(sut->change, ProximityChange::parted);
  EXPECT_EQ(sut->distance, 0.25);
  EXPECT_EQ(sut->a, "w.A");
  EXPECT_EQ(sut->b, "w.B");
}

TEST(EventRecord, RefusesWhatTheEncoderWouldNotWrite) {
  for (const std::size_t offset : {49U, 55U, 100U, 300U}) {
    Bytes bytes = golden_event();
    bytes[offset] = std::byte{'x'};
    EXPECT_FALSE(decode_event_record(bytes)) << offset;
  }
  Bytes bytes = golden_event();
  bytes[48] = std::byte{4};
  EXPECT_FALSE(decode_event_record(bytes)) << "unknown change";
  bytes = golden_event();
  bytes[6] = std::byte{5};
  EXPECT_FALSE(decode_event_record(bytes)) << "another kind";
  EXPECT_FALSE(encode_event_record({}, std::span(bytes).first(319)));
}

class Pacing : public ::testing::Test {
 protected:
  bool due(const ProximityState& state, std::int64_t ms) {
    ProximityRecord record = proximity_record_of(state);
    record.header.time_ns = 1'000'000 * ms;
    record.check = static_cast<std::uint64_t>(ms);
    return sut_.is_due(record);
  }
  ProximityPacing sut_;
};

TEST_F(Pacing, WhatIsNearIsSentWheneverItMoves) {
  ProximityState state = golden_state();
  EXPECT_TRUE(due(state, 1000)) << "the first";
  EXPECT_FALSE(due(state, 1020)) << "the same again, NaN included";
  state.near[1].distance_m += 1e-9;
  EXPECT_TRUE(due(state, 1040));
  EXPECT_FALSE(due(state, 1060));
  EXPECT_TRUE(due(state, 2040)) << "a second later in any case";
}

TEST_F(Pacing, WhereNothingIsNearOneASecondIsEnough) {
  ProximityState state = golden_state();
  state.touching.clear();
  state.near = {{0, 2, 1.5, {0, 0, 0}, {0, 0, 0}, false, false, {}, {}}};
  EXPECT_TRUE(due(state, 1000));
  state.near[0].distance_m = 1.4;
  EXPECT_FALSE(due(state, 1500));
  EXPECT_TRUE(due(state, 2000));
}

TEST_F(Pacing, WhatComesAndGoesIsSentAtOnce) {
  ProximityState near = golden_state();
  ProximityState free = golden_state();
  free.touching.clear();
  free.near = {{0, 2, 1.5, {0, 0, 0}, {0, 0, 0}, false, false, {}, {}}};
  EXPECT_TRUE(due(free, 1000));
  EXPECT_TRUE(due(near, 1020));
  EXPECT_TRUE(due(free, 1040));
  near.touching.clear();
  EXPECT_TRUE(due(near, 1060));
  EXPECT_TRUE(due(free, 1000)) << "time that goes back begins anew";
}

}  // namespace
}  // namespace cellmirror
