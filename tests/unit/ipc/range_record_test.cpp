#include "ipc/wire/range_record.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/unit/ipc/golden_bytes.hpp"

namespace cellmirror {
namespace {

using test::Bytes;
using test::place;

// The header of docs/messages.md: sequence 7, 1,000,000,000 ns, 1,700,000,000,000,000,000 ns.
void place_header(Bytes& bytes, int kind, int length) {
  place(bytes, 0, "CMIR");
  place(bytes, 4, {0x01, 0x00, kind, 0x00, length & 0xFF, length >> 8});
  place(bytes, 16, {0x07, 0, 0, 0, 0, 0, 0, 0});
  place(bytes, 24, {0x00, 0xCA, 0x9A, 0x3B, 0, 0, 0, 0});
  place(bytes, 32, {0x00, 0x00, 0x2A, 0x36, 0xFE, 0x9C, 0x97, 0x17});
}

Bytes golden_range() {
  Bytes bytes(296, std::byte{0});
  place_header(bytes, 2, 296);
  place(bytes, 40, "USS_1B");
  place(bytes, 104, "cell.box");
  place(bytes, 232, {0, 0, 0, 0, 0, 0, 0xD0, 0x3F});  // distance 0.25
  place(bytes, 240, {0, 0, 0, 0, 0, 0, 0x08, 0x40});  // range 3
  place(bytes, 248, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});  // blind zone 0.5
  place(bytes, 256, {0, 0, 0, 0, 0, 0, 0xC0, 0x3F});  // half angle 0.125
  place(bytes, 264, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // point: x 1
  place(bytes, 272, {0, 0, 0, 0, 0, 0, 0x00, 0xC0});  // y -2
  place(bytes, 280, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});  // z 0.5
  place(bytes, 288, {0x03, 0, 0, 0});                 // seen, in the blind zone
  return bytes;
}

// Sensor A sees something at 0.25 m, B nothing.
Bytes golden_array() {
  Bytes bytes(272, std::byte{0});
  place_header(bytes, 3, 272);
  place(bytes, 40, {0x02, 0x00, 0x02, 0x00, 0x02, 0x00, 0x4A, 0x00});  // part 2 of 2, 2 of 74 sensors
  place(bytes, 48, "A");
  place(bytes, 112, {0, 0, 0, 0, 0, 0, 0xD0, 0x3F});  // distance 0.25
  place(bytes, 120, {0, 0, 0, 0, 0, 0, 0x08, 0x40});  // range 3
  place(bytes, 128, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // x 1
  place(bytes, 136, {0, 0, 0, 0, 0, 0, 0x00, 0xC0});  // y -2
  place(bytes, 144, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});  // z 0.5
  place(bytes, 152, {0x01, 0, 0, 0});                 // seen
  place(bytes, 160, "B");
  for (const std::size_t nan : {224U, 240U, 248U, 256U}) place(bytes, nan, {0, 0, 0, 0, 0, 0, 0xF8, 0x7F});
  place(bytes, 232, {0, 0, 0, 0, 0, 0, 0x10, 0x40});  // range 4
  return bytes;
}

RangeReading reading(std::string id, std::optional<double> distance) {
  RangeReading made;
  made.id = std::move(id);
  made.path = "cell." + made.id;
  made.posture_time = Timestamp{1'000'000'000};
  made.distance_m = distance;
  if (distance) {
    made.point_m = {1, -2, 0.5};
    made.object = "cell.box";
  }
  made.range_m = distance ? 3 : 4;
  made.blind_zone_m = 0.5;
  made.half_angle_rad = 0.125;
  return made;
}

void stamp(RecordHeader& header) {
  header.sequence = 7;
  header.wall_time_ns = 1'700'000'000'000'000'000;
}

template <class Record, class Encode>
Bytes encoded(const Record& record, Encode encode) {
  Bytes bytes(kMaxRecordBytes, std::byte{0xEE});
  const auto length = encode(record, bytes);
  EXPECT_TRUE(length) << length.error().text();
  bytes.resize(length.value_or(0));
  return bytes;
}

TEST(RangeRecord, IsEncodedAsDocumented) {
  RangeReading near = reading("USS_1B", 0.25);
  near.in_blind_zone = true;
  RangeRecord sut = range_record_of(near);
  stamp(sut.header);
  EXPECT_EQ(encoded(sut, encode_range_record), golden_range());
}

TEST(RangeRecord, IsDecodedAsDocumented) {
  const auto sut = decode_range_record(golden_range());
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->header.kind, RecordKind::ultrasonic_range);
  EXPECT_EQ(sut->header.time_ns, 1'000'000'000);
  EXPECT_EQ(sut->id, "USS_1B");
  EXPECT_EQ(sut->object, "cell.box");
  EXPECT_EQ(sut->distance, 0.25);
  EXPECT_EQ(sut->range, 3);
  EXPECT_EQ(sut->blind_zone, 0.5);
  EXPECT_EQ(sut->half_angle, 0.125);
  EXPECT_EQ(sut->point, (PointRecord{1, -2, 0.5}));
  EXPECT_TRUE(sut->in_blind_zone);
}

TEST(RangeRecord, NothingInTheConeIsNaN) {
  const auto sut = decode_range_record(encoded(range_record_of(reading("U", {})), encode_range_record));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_TRUE(std::isnan(sut->distance));
  EXPECT_TRUE(std::isnan(sut->point[0]) && std::isnan(sut->point[1]) && std::isnan(sut->point[2]));
  EXPECT_EQ(sut->object, "");
  EXPECT_EQ(sut->range, 4);
}

TEST(RangeRecord, ADoubtIsTold) {
  RangeReading doubtful = reading("U", {});
  doubtful.doubtful = true;
  const Bytes bytes = encoded(range_record_of(doubtful), encode_range_record);
  EXPECT_EQ(bytes[288], std::byte{4});
  EXPECT_TRUE(decode_range_record(bytes)->doubtful);
  const auto array = range_arrays_of(std::span(&doubtful, 1));
  EXPECT_TRUE(decode_range_array(encoded(array.front(), encode_range_array))->ranges.front().doubtful);
}

TEST(RangeRecord, RefusesWhatTheEncoderWouldNotWrite) {
  struct Damage {
    std::size_t offset;
    int value;
    const char* what;
  };
  const Damage damages[] = {{6, 3, "another kind"},  {8, 0, "length"},        {60, 'x', "behind the id's NUL"},
                            {200, 'x', "object"},    {288, 0, "not seen"},    {288, 2, "blind but not seen"},
                            {288, 9, "flag"},        {291, 1, "flag"},        {292, 1, "reserved"},
                            {238, 0xF8, "NaN seen"}, {300, 0, "one too long"}};
  for (const Damage& damage : damages) {
    Bytes bytes = golden_range();
    if (damage.offset >= bytes.size()) bytes.resize(damage.offset);
    if (damage.offset < bytes.size()) bytes[damage.offset] = static_cast<std::byte>(damage.value);
    if (damage.value == 0xF8) bytes[239] = std::byte{0x7F};
    if (bytes.size() != 296) place(bytes, 8, {static_cast<int>(bytes.size() & 0xFF), 1});
    EXPECT_FALSE(decode_range_record(bytes)) << damage.what;
  }
  for (std::size_t length = 0; length < 296; ++length) {
    Bytes shorter = golden_range();
    shorter.resize(length);
    if (length >= 10) place(shorter, 8, {static_cast<int>(length & 0xFF), static_cast<int>(length >> 8)});
    EXPECT_FALSE(decode_range_record(shorter)) << length;
  }
}

TEST(RangeRecord, EncoderRefusesContradictionsAndTooLittleRoom) {
  RangeRecord record = range_record_of(reading("U", {}));
  Bytes bytes(295);
  EXPECT_FALSE(encode_range_record(record, bytes));
  record.in_blind_zone = true;
  bytes.resize(296);
  EXPECT_FALSE(encode_range_record(record, bytes));
}

TEST(RangeRecord, LongPathsKeepBothEnds) {
  RangeReading near = reading("U", 0.25);
  near.object =
      "Left." + std::string(121, 'a') + "\xC3\xA9" + std::string(119, 'b');  // the cut would split the e acute
  const auto sut = decode_range_record(encoded(range_record_of(near), encode_range_record));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->object, "Left..." + std::string(119, 'b'));
  near.object = std::string(127, 'c');
  EXPECT_EQ(decode_range_record(encoded(range_record_of(near), encode_range_record))->object, near.object);
  near.short_object = "Left.b";
  EXPECT_EQ(decode_range_record(encoded(range_record_of(near), encode_range_record))->object, "Left.b");
}

TEST(RangeArray, IsEncodedAndDecodedAsDocumented) {
  const std::array readings = {reading("A", 0.25), reading("B", {})};
  auto records = range_arrays_of(readings);
  ASSERT_EQ(records.size(), 1U);
  RangeArrayRecord& sut = records.front();
  stamp(sut.header);
  EXPECT_EQ(sut.part, 1);
  EXPECT_EQ(sut.parts, 1);
  EXPECT_EQ(sut.total, 2);
  sut.part = sut.parts = 2;
  sut.total = 74;
  EXPECT_EQ(encoded(sut, encode_range_array), golden_array());

  const auto decoded = decode_range_array(golden_array());
  ASSERT_TRUE(decoded) << decoded.error().text();
  ASSERT_EQ(decoded->ranges.size(), 2U);
  EXPECT_EQ(decoded->ranges[0].id, "A");
  EXPECT_EQ(decoded->ranges[0].distance, 0.25);
  EXPECT_TRUE(std::isnan(decoded->ranges[1].distance));
  EXPECT_EQ(decoded->ranges[1].range, 4);
  EXPECT_EQ(decoded->total, 74);
}

TEST(RangeArray, ManySensorsGoInParts) {
  std::vector<RangeReading> readings;
  for (int i = 0; i < 150; ++i) readings.push_back(reading("U" + std::to_string(i), 0.01 * i));
  const auto sut = range_arrays_of(readings);
  ASSERT_EQ(sut.size(), 3U);
  int next = 0;
  for (std::size_t i = 0; i < sut.size(); ++i) {
    const auto decoded = decode_range_array(encoded(sut[i], encode_range_array));
    ASSERT_TRUE(decoded) << decoded.error().text();
    EXPECT_EQ(decoded->part, i + 1);
    EXPECT_EQ(decoded->parts, 3);
    EXPECT_EQ(decoded->total, 150);
    for (const RangeEntry& entry : decoded->ranges) EXPECT_EQ(entry.id, "U" + std::to_string(next++));
  }
  EXPECT_EQ(next, 150);
  EXPECT_TRUE(range_arrays_of({}).empty());
}

TEST(RangeArray, RefusesWhatTheEncoderWouldNotWrite) {
  struct Damage {
    std::size_t offset;
    int value;
    const char* what;
  };
  const Damage damages[] = {{6, 2, "another kind"}, {40, 0, "part 0"},     {40, 3, "part 3 of 2"},
                            {44, 0, "no sensor"},   {44, 3, "too many"},   {46, 1, "more than in all"},
                            {43, 1, "258 parts"},   {152, 0, "not seen"},  {152, 9, "flag"},
                            {156, 1, "reserved"},   {264, 1, "seen, NaN"}, {60, 'x', "behind the NUL"}};
  for (const Damage& damage : damages) {
    Bytes bytes = golden_array();
    bytes[damage.offset] = static_cast<std::byte>(damage.value);
    EXPECT_FALSE(decode_range_array(bytes)) << damage.what;
  }
}

}  // namespace
}  // namespace cellmirror
