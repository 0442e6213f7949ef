#include "ipc/wire/barrier_record.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/unit/ipc/golden_bytes.hpp"

namespace cellmirror {
namespace {

using test::Bytes;
using test::place;

// 248 = 0xF8 bytes.
Bytes golden() {
  Bytes bytes(248, std::byte{0});
  place(bytes, 0, "CMIR");
  place(bytes, 4, {0x01, 0x00, 8, 0x00, 0xF8, 0x00});
  place(bytes, 16, {0x07, 0, 0, 0, 0, 0, 0, 0});                       // sequence 7
  place(bytes, 24, {0x00, 0xCA, 0x9A, 0x3B, 0, 0, 0, 0});              // 1,000,000,000 ns
  place(bytes, 32, {0x00, 0x00, 0x2A, 0x36, 0xFE, 0x9C, 0x97, 0x17});  // 1,700,000,000,000,000,000 ns
  place(bytes, 40, "gate");
  place(bytes, 104, "Arm.hand");
  place(bytes, 232, {0x02, 0x01, 0, 0, 0, 0, 0, 0});  // 258 interruptions
  place(bytes, 240, {1, 0, 0, 0});                    // interrupted
  return bytes;
}

BarrierReading golden_reading() {
  BarrierReading reading;
  reading.name = "gate";
  reading.posture_time = Timestamp{1'000'000'000};
  reading.interrupted = true;
  reading.object = "Cell.Arm.J_1.hand";
  reading.short_object = "Arm.hand";
  reading.interruptions = 258;
  return reading;
}

Bytes encoded(BarrierRecord record) {
  record.header.sequence = 7;
  record.header.wall_time_ns = 1'700'000'000'000'000'000;
  Bytes bytes(barrier_record_offset::kBytes, std::byte{0xEE});
  const auto length = encode_barrier_record(record, bytes);
  EXPECT_TRUE(length) << length.error().text();
  bytes.resize(length.value_or(0));
  return bytes;
}

TEST(BarrierRecord, IsTheBytesThatWereWrittenByHand) {
  EXPECT_EQ(encoded(barrier_record_of(golden_reading())), golden());
}

TEST(BarrierRecord, IsReadBackWithAllFields) {
  const auto record = decode_barrier_record(golden());
  ASSERT_TRUE(record) << record.error().text();
  EXPECT_EQ(record->header.sequence, 7U);
  EXPECT_EQ(record->header.time_ns, 1'000'000'000);
  EXPECT_EQ(record->id, "gate");
  EXPECT_EQ(record->object, "Arm.hand");
  EXPECT_EQ(record->interruptions, 258U);
  EXPECT_TRUE(record->interrupted);
  EXPECT_FALSE(record->doubtful);
}

TEST(BarrierRecord, WithoutAShortNameThePath) {
  BarrierReading reading = golden_reading();
  reading.short_object.clear();
  EXPECT_EQ(barrier_record_of(reading).object, "Cell.Arm.J_1.hand");
}

TEST(BarrierRecord, RefusesWhatTheEncoderWouldNotWrite) {
  const auto refused = [](std::size_t offset, int value) {
    Bytes bytes = golden();
    place(bytes, offset, {value});
    return !decode_barrier_record(bytes);
  };
  EXPECT_TRUE(refused(6, 7)) << "another kind of record";
  EXPECT_TRUE(refused(100, 'x')) << "bytes behind a name";
  EXPECT_TRUE(refused(240, 4)) << "flags";
  EXPECT_TRUE(refused(240, 0)) << "free, with a body in the beam";
  EXPECT_TRUE(refused(244, 1)) << "reserved";
  Bytes cut = golden();
  cut.pop_back();
  place(cut, 8, {0xF7});
  EXPECT_FALSE(decode_barrier_record(cut)) << "one byte short";
  std::array<std::byte, 247> small{};
  EXPECT_FALSE(encode_barrier_record({}, small)) << "too small";
}

}  // namespace
}  // namespace cellmirror
