// The numbers of the specification, written by hand.
#include <gtest/gtest.h>

#include <initializer_list>

#include "ipc/record/decode.hpp"
#include "ipc/record/encode.hpp"
#include "tests/unit/record/record_parts.hpp"

namespace cellmirror::mcap {
namespace {

Bytes bytes(std::initializer_list<int> values) {
  Bytes out;
  for (const int value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes out;
  for (const Bytes& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

const Bytes kMagicBytes = bytes({0x89, 0x4D, 0x43, 0x41, 0x50, 0x30, 0x0D, 0x0A});

TEST(RecordLayout, MagicIsThatOfVersionZero) {
  Bytes out;
  append_magic(out);
  EXPECT_EQ(out, kMagicBytes);
}

TEST(RecordLayout, CrcIsThatOfZlib) {
  EXPECT_EQ(crc32(view_of("123456789")), 0xCBF43926U);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(crc32(view_of("6789"), crc32(view_of("12345"))), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
}

TEST(RecordLayout, OpcodesAreThoseOfTheSpecification) {
  EXPECT_EQ(static_cast<int>(Opcode::header), 1);
  EXPECT_EQ(static_cast<int>(Opcode::footer), 2);
  EXPECT_EQ(static_cast<int>(Opcode::schema), 3);
  EXPECT_EQ(static_cast<int>(Opcode::channel), 4);
  EXPECT_EQ(static_cast<int>(Opcode::message), 5);
  EXPECT_EQ(static_cast<int>(Opcode::chunk), 6);
  EXPECT_EQ(static_cast<int>(Opcode::message_index), 7);
  EXPECT_EQ(static_cast<int>(Opcode::chunk_index), 8);
  EXPECT_EQ(static_cast<int>(Opcode::attachment), 9);
  EXPECT_EQ(static_cast<int>(Opcode::attachment_index), 10);
  EXPECT_EQ(static_cast<int>(Opcode::statistics), 11);
  EXPECT_EQ(static_cast<int>(Opcode::metadata), 12);
  EXPECT_EQ(static_cast<int>(Opcode::metadata_index), 13);
  EXPECT_EQ(static_cast<int>(Opcode::summary_offset), 14);
  EXPECT_EQ(static_cast<int>(Opcode::data_end), 15);
}

TEST(RecordLayout, AHeaderIsTwoTexts) {
  Bytes out;
  append(Header{"ros2", "x"}, out);
  EXPECT_EQ(out, bytes({0x01, 13, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 'r', 'o', 's', '2', 1, 0, 0, 0, 'x'}));
}

TEST(RecordLayout, AChannelHasItsTextsAsAMapWithALengthInBytes) {
  Bytes out;
  append(Channel{0x0102, 3, "/t", "cdr", {{"k", "v"}}}, out);
  EXPECT_EQ(out, bytes({0x04, 31, 0, 0,   0,   0,   0,  0, 0, 2, 1, 3, 0, 2, 0,   0, 0, '/', 't', 3,
                        0,    0,  0, 'c', 'd', 'r', 10, 0, 0, 0, 1, 0, 0, 0, 'k', 1, 0, 0,   0,   'v'}));
}

TEST(RecordLayout, AMessageHasNoLengthBeforeItsData) {
  Bytes out;
  append(Message{1, 2, 0x0807060504030201, 3, view_of("abc")}, out);
  EXPECT_EQ(out, bytes({0x05, 25, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0,   1,   2,
                        3,    4,  5, 6, 7, 8, 3, 0, 0, 0, 0, 0, 0, 0, 'a', 'b', 'c'}));
}

TEST(RecordLayout, AnAttachmentEndsWithTheCrcOfItsContent) {
  Bytes out;
  append(Attachment{1, 2, "n", "m", view_of("12")}, out);
  const Bytes content = bytes({1, 0, 0,   0, 0, 0, 0, 0,   2, 0, 0, 0, 0, 0, 0, 0, 1,   0,
                               0, 0, 'n', 1, 0, 0, 0, 'm', 2, 0, 0, 0, 0, 0, 0, 0, '1', '2'});
  const std::uint32_t crc = crc32(content);
  const Bytes end = bytes({static_cast<int>(crc & 0xFFU), static_cast<int>(crc >> 8 & 0xFFU),
                           static_cast<int>(crc >> 16 & 0xFFU), static_cast<int>(crc >> 24)});
  EXPECT_EQ(out, joined({bytes({0x09, 40, 0, 0, 0, 0, 0, 0, 0}), content, end}));
}

TEST(RecordLayout, AChunkIndexHasItsFieldsInOrder) {
  Bytes out;
  append(ChunkIndex{1, 2, 3, 4, {{5, 6}}, 7, "lz4", 8, 9}, out);
  Decoder from(View(out).subspan(kRecordHead));
  EXPECT_EQ(out.size(), kRecordHead + 4 * 8 + 4 + 10 + 8 + 4 + 3 + 8 + 8);
  for (std::uint64_t i = 1; i <= 4; ++i) EXPECT_EQ(from.number<std::uint64_t>(), i);
  EXPECT_EQ(from.number<std::uint32_t>(), 10U);  // bytes of the map
  EXPECT_EQ(from.number<std::uint16_t>(), 5U);
  EXPECT_EQ(from.number<std::uint64_t>(), 6U);
  EXPECT_EQ(from.number<std::uint64_t>(), 7U);
  EXPECT_EQ(from.text(), "lz4");
  EXPECT_EQ(from.number<std::uint64_t>(), 8U);
  EXPECT_EQ(from.number<std::uint64_t>(), 9U);
  EXPECT_TRUE(from.ok() && from.at_end());
}

TEST(RecordLayout, TheSmallestFileIsRead) {
  const Bytes file =
      joined({kMagicBytes, bytes({0x01, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
              bytes({0x0F, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
              bytes({0x02, 20, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
              kMagicBytes});
  test::Collector found;
  const ScanReport report = test::scanned(file, found);
  EXPECT_EQ(report.faults.count(), 0U);
  EXPECT_TRUE(report.ended);
}

}  // namespace
}  // namespace cellmirror::mcap
