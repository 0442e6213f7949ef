#include "ipc/wire/tissue_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/unit/ipc/golden_bytes.hpp"

namespace cellmirror {
namespace {

using test::Bytes;
using test::place;

// 280 = 0x118 bytes.
Bytes golden() {
  Bytes bytes(280, std::byte{0});
  place(bytes, 0, "CMIR");
  place(bytes, 4, {0x01, 0x00, 7, 0x00, 0x18, 0x01});
  place(bytes, 16, {0x07, 0, 0, 0, 0, 0, 0, 0});                       // sequence 7
  place(bytes, 24, {0x00, 0xCA, 0x9A, 0x3B, 0, 0, 0, 0});              // 1,000,000,000 ns
  place(bytes, 32, {0x00, 0x00, 0x2A, 0x36, 0xFE, 0x9C, 0x97, 0x17});  // 1,700,000,000,000,000,000 ns
  place(bytes, 40, {0x02, 0x01, 0, 0, 0, 0, 0, 0});                    // event 258
  place(bytes, 48, {3});                                               // clip
  place(bytes, 56, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});                    // value 0.5
  place(bytes, 64, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});                    // x 1
  place(bytes, 72, {0, 0, 0, 0, 0, 0, 0xD0, 0xBF});                    // y -0.25
  place(bytes, 80, {0, 0, 0, 0, 0, 0, 0x00, 0x40});                    // z 2
  place(bytes, 88, "APPLIER");
  place(bytes, 152, "liver");
  place(bytes, 216, "cystic_artery");
  return bytes;
}

NamedTissueEvent golden_event() {
  TissueEvent event;
  event.number = 258;
  event.time = Timestamp{1'000'000'000};
  event.kind = TissueEventKind::clip;
  event.limit = TissueLimit::strain;  // means nothing for a clip
  event.at = {1, -0.25, 2};
  event.value = 0.5;
  std::ranges::copy(std::string_view("cystic_artery"), event.part.begin());
  return {event, "APPLIER", "liver"};
}

Bytes encoded(TissueRecord record) {
  record.header.sequence = 7;
  record.header.wall_time_ns = 1'700'000'000'000'000'000;
  Bytes bytes(tissue_record_offset::kBytes, std::byte{0xEE});
  const auto length = encode_tissue_record(record, bytes);
  EXPECT_TRUE(length) << length.error().text();
  bytes.resize(length.value_or(0));
  return bytes;
}

TEST(TissueRecord, IsTheBytesThatWereWrittenByHand) { EXPECT_EQ(encoded(tissue_record_of(golden_event())), golden()); }

TEST(TissueRecord, IsReadBackWithAllFields) {
  const auto record = decode_tissue_record(golden());
  ASSERT_TRUE(record) << record.error().text();
  EXPECT_EQ(record->header.sequence, 7U);
  EXPECT_EQ(record->header.time_ns, 1'000'000'000);
  EXPECT_EQ(record->event, 258U);
  EXPECT_EQ(record->kind, TissueEventKind::clip);
  EXPECT_DOUBLE_EQ(record->value, 0.5);
  EXPECT_EQ(record->place, (PointRecord{1, -0.25, 2}));
  EXPECT_EQ(record->robot, "APPLIER");
  EXPECT_EQ(record->object, "liver");
  EXPECT_EQ(record->part, "cystic_artery");
}

TEST(TissueRecord, NamesTheLimitOfAnExcess) {
  NamedTissueEvent event = golden_event();
  event.event.kind = TissueEventKind::limit;
  const Bytes bytes = encoded(tissue_record_of(event));
  EXPECT_EQ(bytes.at(48), std::byte{9});
  EXPECT_EQ(bytes.at(49), std::byte{5});
  const auto record = decode_tissue_record(bytes);
  ASSERT_TRUE(record) << record.error().text();
  EXPECT_EQ(record->limit, TissueLimit::strain);
}

TEST(TissueRecord, RefusesWhatTheEncoderWouldNotWrite) {
  const auto refused = [](std::size_t offset, int value) {
    Bytes bytes = golden();
    place(bytes, offset, {value});
    return !decode_tissue_record(bytes);
  };
  EXPECT_TRUE(refused(6, 6)) << "another kind of record";
  EXPECT_TRUE(refused(48, 10)) << "kind of event";
  EXPECT_TRUE(refused(49, 2)) << "a limit of a clip";
  EXPECT_TRUE(refused(50, 1)) << "reserved";
  EXPECT_TRUE(refused(55, 1)) << "reserved";
  EXPECT_TRUE(refused(150, 'x')) << "bytes behind a name";
  Bytes of_limit = golden();
  place(of_limit, 48, {9, 6});
  EXPECT_FALSE(decode_tissue_record(of_limit)) << "limit";
  Bytes cut = golden();
  cut.pop_back();
  place(cut, 8, {0x17});
  EXPECT_FALSE(decode_tissue_record(cut)) << "one byte short";
  std::array<std::byte, 279> small{};
  EXPECT_FALSE(encode_tissue_record({}, small)) << "too small";
}

TEST(TissueRecord, CutsLongNames) {
  NamedTissueEvent event = golden_event();
  event.object = std::string(100, 'o');
  const auto record = decode_tissue_record(encoded(tissue_record_of(event)));
  ASSERT_TRUE(record) << record.error().text();
  EXPECT_EQ(record->object, std::string(63, 'o'));
}

}  // namespace
}  // namespace cellmirror
