// Golden bytes from CiA 301, 7.2.4.3 (SDO protocol).
#include <gtest/gtest.h>

#include <chrono>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/sdo_client.hpp"
#include "drivers/can/canopen/sdo_server.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

class DictionaryObjects : public SdoObjects {
 public:
  ObjectDictionary objects;

  std::expected<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) override {
    return read_object(objects, address);
  }
  std::optional<SdoAbort> write(ObjectAddress address, std::span<const std::uint8_t> value) override {
    return write_object(objects, address, value);
  }
};

struct SdoServerTest : testing::Test {
  SdoServerTest() {
    device.objects.set_integer({0x1017, 0}, DataType::unsigned16, ObjectAccess::read_write, 1000);
    device.objects.set_integer({0x1000, 0}, DataType::unsigned32, ObjectAccess::read_only, 0x00020192);
    device.objects.set_integer({0x2000, 1}, DataType::integer8, ObjectAccess::write_only, 0);
    device.objects.set_integer({0x6060, 0}, DataType::integer8, ObjectAccess::read_write, 8);
    device.objects.find({0x6060, 0})->low_limit = -1;
    device.objects.find({0x6060, 0})->high_limit = 10;
    ObjectEntry name;
    name.type = DataType::visible_string;
    name.access = ObjectAccess::read_write;
    name.value = {'s', 'e', 'r', 'v', 'o', ' ', 'd', 'r', 'i', 'v', 'e'};
    device.objects.set({0x1008, 0}, name);
  }
  DictionaryObjects device;
  SdoServer sut{5, device};
  Timestamp now{1'000'000'000};
};

TEST_F(SdoServerTest, ExpeditedUpload) {
  // Two bytes: scs 2, n 2, e 1, s 1 = 0x4B.
  EXPECT_EQ(sut.receive(frame(0x605, {0x40, 0x17, 0x10, 0x00, 0, 0, 0, 0}), now),
            frame(0x585, {0x4B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0, 0}));
  EXPECT_EQ(sut.receive(frame(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}), now),
            frame(0x585, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}));
}

TEST_F(SdoServerTest, ExpeditedDownload) {
  EXPECT_EQ(sut.receive(frame(0x605, {0x2B, 0x17, 0x10, 0x00, 0x64, 0x00, 0, 0}), now),
            frame(0x585, {0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_EQ(device.objects.integer({0x1017, 0}), 100);
}

TEST_F(SdoServerTest, ExpeditedDownloadWithoutSizeFillsTheObject) {
  EXPECT_EQ(sut.receive(frame(0x605, {0x22, 0x17, 0x10, 0x00, 0x64, 0x00, 0x77, 0x77}), now),
            frame(0x585, {0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_EQ(device.objects.integer({0x1017, 0}), 100);
}

TEST_F(SdoServerTest, SegmentedUpload) {
  EXPECT_EQ(sut.receive(frame(0x605, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}), now),
            frame(0x585, {0x41, 0x08, 0x10, 0x00, 0x0B, 0, 0, 0}));
  EXPECT_EQ(sut.receive(frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}), now),
            frame(0x585, {0x00, 's', 'e', 'r', 'v', 'o', ' ', 'd'}));
  // Four bytes left: t 1, n 3, c 1 = 0x17.
  EXPECT_EQ(sut.receive(frame(0x605, {0x70, 0, 0, 0, 0, 0, 0, 0}), now),
            frame(0x585, {0x17, 'r', 'i', 'v', 'e', 0, 0, 0}));
}

TEST_F(SdoServerTest, SegmentedDownload) {
  EXPECT_EQ(sut.receive(frame(0x605, {0x21, 0x08, 0x10, 0x00, 0x08, 0, 0, 0}), now),
            frame(0x585, {0x60, 0x08, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_EQ(sut.receive(frame(0x605, {0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), now),
            frame(0x585, {0x20, 0, 0, 0, 0, 0, 0, 0}));
  // One byte left: t 1, n 6, c 1 = 0x1D.
  EXPECT_EQ(sut.receive(frame(0x605, {0x1D, 'h', 0, 0, 0, 0, 0, 0}), now), frame(0x585, {0x30, 0, 0, 0, 0, 0, 0, 0}));
  const auto& value = device.objects.find({0x1008, 0})->value;
  EXPECT_EQ(std::string(value.begin(), value.end()), "abcdefgh");
}

struct Refusal {
  CanFrame request;
  SdoAbort abort;
};

TEST_F(SdoServerTest, RefusesWithTheCodeOfTheReason) {
  const Refusal refusals[] = {
      {frame(0x605, {0x40, 0x00, 0x30, 0x00, 0, 0, 0, 0}), SdoAbort::no_such_object},
      {frame(0x605, {0x40, 0x00, 0x20, 0x05, 0, 0, 0, 0}), SdoAbort::no_such_subindex},
      {frame(0x605, {0x40, 0x00, 0x20, 0x01, 0, 0, 0, 0}), SdoAbort::write_only},
      {frame(0x605, {0x23, 0x00, 0x10, 0x00, 1, 0, 0, 0}), SdoAbort::read_only},
      {frame(0x605, {0x23, 0x17, 0x10, 0x00, 1, 0, 0, 0}), SdoAbort::too_long},
      {frame(0x605, {0x2F, 0x17, 0x10, 0x00, 1, 0, 0, 0}), SdoAbort::too_short},
      {frame(0x605, {0x2F, 0x60, 0x60, 0x00, 11, 0, 0, 0}), SdoAbort::value_too_high},
      {frame(0x605, {0x2F, 0x60, 0x60, 0x00, 0xFE, 0, 0, 0}), SdoAbort::value_too_low},
  };
  for (const Refusal& refusal : refusals) {
    const CanFrame& request = refusal.request;
    CanFrame expected = frame(0x585, {0x80, request.data[1], request.data[2], request.data[3], 0, 0, 0, 0});
    put_le(std::span(expected.data).subspan(4), static_cast<std::uint32_t>(refusal.abort), 4);
    EXPECT_EQ(sut.receive(request, now), expected) << words(refusal.abort);
  }
}

// The check value of CRC-16 with polynomial 0x1021 and initial value 0 over "123456789" (CiA 301, 7.2.4.3.16).
TEST(SdoBlock, ComputesTheCrcOfTheStandard) {
  const std::string text = "123456789";
  EXPECT_EQ(sdo_crc(std::vector<std::uint8_t>(text.begin(), text.end())), 0x31C3);
}

TEST_F(SdoServerTest, BlockUploadInOneSubBlock) {
  EXPECT_EQ(sut.receive(frame(0x605, {0xA4, 0x08, 0x10, 0x00, 0x7F, 0, 0, 0}), now),
            frame(0x585, {0xC6, 0x08, 0x10, 0x00, 0x0B, 0, 0, 0}));
  EXPECT_FALSE(sut.receive(frame(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0}), now));
  EXPECT_EQ(sut.advance(now), frame(0x585, {0x01, 's', 'e', 'r', 'v', 'o', ' ', 'd'}));
  EXPECT_EQ(sut.advance(now), frame(0x585, {0x82, 'r', 'i', 'v', 'e', 0, 0, 0}));
  EXPECT_FALSE(sut.advance(now));
  const auto end = sut.receive(frame(0x605, {0xA2, 0x02, 0x7F, 0, 0, 0, 0, 0}), now);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->data[0], 0xC1 | 3 << 2) << "three bytes of the last segment are unused";
  const auto& value = device.objects.find({0x1008, 0})->value;
  EXPECT_EQ(end->data[1] | end->data[2] << 8, sdo_crc(value));
  EXPECT_FALSE(sut.receive(frame(0x605, {0xA1, 0, 0, 0, 0, 0, 0, 0}), now));
  EXPECT_FALSE(sut.next_due().known());
}

TEST_F(SdoServerTest, BlockUploadRepeatsWhatTheClientMissed) {
  device.objects.find({0x1008, 0})->value.assign(30, 'x');
  device.objects.find({0x1008, 0})->value[7] = 'y';
  (void)sut.receive(frame(0x605, {0xA0, 0x08, 0x10, 0x00, 3, 0, 0, 0}), now);
  (void)sut.receive(frame(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0}), now);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(sut.advance(now)->data[0], i);
  EXPECT_FALSE(sut.advance(now)) << "the sub-block is sent";
  EXPECT_FALSE(sut.receive(frame(0x605, {0xA2, 1, 5, 0, 0, 0, 0, 0}), now)) << "only the first has come";
  const auto again = sut.advance(now);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->data[0], 1);
  EXPECT_EQ(again->data[1], 'y');
  for (const int first : {2, 3, 0x84}) EXPECT_EQ(sut.advance(now)->data[0], first);
  EXPECT_EQ(sut.receive(frame(0x605, {0xA2, 4, 5, 0, 0, 0, 0, 0}), now)->data[0], 0xC1 | 5 << 2);
}

TEST_F(SdoServerTest, BlockUploadPausesBetweenBursts) {
  device.objects.find({0x1008, 0})->value.assign(200, 'x');
  (void)sut.receive(frame(0x605, {0xA0, 0x08, 0x10, 0x00, 127, 0, 0, 0}), now);
  (void)sut.receive(frame(0x605, {0xA3, 0, 0, 0, 0, 0, 0, 0}), now);
  int sent = 0;
  while (sut.advance(now)) ++sent;
  EXPECT_EQ(sent, 8);
  EXPECT_EQ(sut.next_due(), now + Nanoseconds(1'000'000));
  now = sut.next_due();
  while (sut.advance(now)) ++sent;
  EXPECT_EQ(sent, 16);
}

TEST_F(SdoServerTest, BlockDownloadWithCrc) {
  EXPECT_EQ(sut.receive(frame(0x605, {0xC6, 0x08, 0x10, 0x00, 0x09, 0, 0, 0}), now),
            frame(0x585, {0xA4, 0x08, 0x10, 0x00, 31, 0, 0, 0}));
  EXPECT_FALSE(sut.receive(frame(0x605, {0x01, '1', '2', '3', '4', '5', '6', '7'}), now));
  EXPECT_EQ(sut.receive(frame(0x605, {0x82, '8', '9', 0, 0, 0, 0, 0}), now),
            frame(0x585, {0xA2, 2, 31, 0, 0, 0, 0, 0}));
  EXPECT_EQ(sut.receive(frame(0x605, {0xC1 | 5 << 2, 0xC3, 0x31, 0, 0, 0, 0, 0}), now),
            frame(0x585, {0xA1, 0, 0, 0, 0, 0, 0, 0}));
  const auto& value = device.objects.find({0x1008, 0})->value;
  EXPECT_EQ(std::string(value.begin(), value.end()), "123456789");
}

TEST_F(SdoServerTest, BlockDownloadAsksAgainForSegmentsAfterAGap) {
  (void)sut.receive(frame(0x605, {0xC0, 0x08, 0x10, 0x00, 0, 0, 0, 0}), now);
  (void)sut.receive(frame(0x605, {0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0x83, 'o', 0, 0, 0, 0, 0, 0}), now), frame(0x585, {0xA2, 1, 31, 0, 0, 0, 0, 0}));
  (void)sut.receive(frame(0x605, {0x01, 'h', 'i', 'j', 'k', 'l', 'm', 'n'}), now);
  (void)sut.receive(frame(0x605, {0x82, 'o', 0, 0, 0, 0, 0, 0}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0xC1 | 6 << 2, 0, 0, 0, 0, 0, 0, 0}), now)->data[0], 0xA1);
  const auto& value = device.objects.find({0x1008, 0})->value;
  EXPECT_EQ(std::string(value.begin(), value.end()), "abcdefghijklmno");
}

TEST_F(SdoServerTest, BlockDownloadRefusesAWrongCrcAndAWrongLength) {
  for (const bool wrong_length : {false, true}) {
    (void)sut.receive(frame(0x605, {0xC6, 0x08, 0x10, 0x00, wrong_length ? 8 : 9, 0, 0, 0}), now);
    (void)sut.receive(frame(0x605, {0x01, '1', '2', '3', '4', '5', '6', '7'}), now);
    (void)sut.receive(frame(0x605, {0x82, '8', '9', 0, 0, 0, 0, 0}), now);
    const auto answer = sut.receive(frame(0x605, {0xC1 | 5 << 2, 0x00, 0x31, 0, 0, 0, 0, 0}), now);
    ASSERT_TRUE(answer);
    EXPECT_EQ(get_le32(std::span(answer->data).subspan(4)), wrong_length ? 0x0607'0010 : 0x0504'0004);
  }
  EXPECT_EQ(device.objects.find({0x1008, 0})->value.size(), 11U);
}

TEST_F(SdoServerTest, AbortsATransferWhoseClientIsSilent) {
  for (const int first : {0x21, 0xC0, 0xA0}) {
    (void)sut.receive(frame(0x605, {first, 0x08, 0x10, 0x00, 0x08, 0, 0, 0}), now);
    EXPECT_EQ(sut.next_due(), now + SdoServer::kTimeout);
    EXPECT_FALSE(sut.advance(now + SdoServer::kTimeout - Nanoseconds(1)));
    now = sut.next_due();
    EXPECT_EQ(sut.advance(now), frame(0x585, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
    EXPECT_FALSE(sut.advance(now));
  }
}

TEST_F(SdoServerTest, AnswersAClientThatStartsAgainAmidABlockDownload) {
  (void)sut.receive(frame(0x605, {0xC0, 0x08, 0x10, 0x00, 0, 0, 0, 0}), now);
  (void)sut.receive(frame(0x605, {0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0x40, 0x17, 0x10, 0x00, 0, 0, 0, 0}), now)->data[0], 0x4B);
}

TEST_F(SdoServerTest, RefusesBlocksOfAnImpossibleSize) {
  for (const int size : {0, 128}) {
    EXPECT_EQ(sut.receive(frame(0x605, {0xA0, 0x08, 0x10, 0x00, size, 0, 0, 0}), now),
              frame(0x585, {0x80, 0x08, 0x10, 0x00, 0x02, 0x00, 0x04, 0x05}));
  }
}

TEST_F(SdoServerTest, RefusesASegmentWithTheWrongToggleBitAndForgetsTheTransfer) {
  (void)sut.receive(frame(0x605, {0x21, 0x08, 0x10, 0x00, 0x08, 0, 0, 0}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0x10, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), now),
            frame(0x585, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(sut.receive(frame(0x605, {0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), now)->data[0], 0x80);
}

TEST_F(SdoServerTest, KeepsTheObjectWhereALaterSegmentRepeatsTheToggleBit) {
  (void)sut.receive(frame(0x605, {0x21, 0x08, 0x10, 0x00, 0x08, 0, 0, 0}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), now),
            frame(0x585, {0x20, 0, 0, 0, 0, 0, 0, 0}));
  // The last segment, t 0 again: 0x05030000 toggle bit not alternated.
  EXPECT_EQ(sut.receive(frame(0x605, {0x0D, 'h', 0, 0, 0, 0, 0, 0}), now),
            frame(0x585, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  const auto& value = device.objects.find({0x1008, 0})->value;
  EXPECT_EQ(std::string(value.begin(), value.end()), "servo drive");
}

TEST_F(SdoServerTest, RefusesToGiveASegmentForTheWrongToggleBitAndForgetsTheTransfer) {
  const CanFrame refused = frame(0x585, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05});
  (void)sut.receive(frame(0x605, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0x70, 0, 0, 0, 0, 0, 0, 0}), now), refused) << "the first has t 0";
  EXPECT_EQ(sut.receive(frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}), now)->data[0], 0x80) << "the transfer has ended";

  (void)sut.receive(frame(0x605, {0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0}), now);
  EXPECT_EQ(sut.receive(frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}), now)->data[0], 0x00);
  EXPECT_EQ(sut.receive(frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}), now), refused) << "asked twice for the same segment";
}

TEST_F(SdoServerTest, BoundsWhatAClientAnnouncesAndSends) {
  EXPECT_EQ(sut.receive(frame(0x605, {0x21, 0x08, 0x10, 0x00, 0, 0, 0, 0x7F}), now)->data[0], 0x80);
  (void)sut.receive(frame(0x605, {0x20, 0x08, 0x10, 0x00, 0, 0, 0, 0}), now);  // without a size
  int segments = 0;
  for (int toggle = 0; segments < 10'000; ++segments, toggle ^= 0x10) {
    if (sut.receive(frame(0x605, {toggle, 1, 2, 3, 4, 5, 6, 7}), now)->data[0] == 0x80) break;
  }
  EXPECT_EQ(segments, static_cast<int>(kMaxSdoValue / 7));
}

TEST_F(SdoServerTest, IgnoresWhatIsNotForIt) {
  EXPECT_FALSE(sut.receive(frame(0x606, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}), now));
  EXPECT_FALSE(sut.receive(frame(0x605, {0x40, 0x00, 0x10, 0x00}), now));
  EXPECT_FALSE(sut.receive(frame(0x605, {0x80, 0x00, 0x10, 0x00, 0, 0, 0, 0}), now));
}

TEST(SdoClient, ExpeditedDownload) {
  SdoClient sut(5, 100ms);
  const std::uint8_t value[] = {0xE8, 0x03};
  EXPECT_EQ(sut.download({0x1017, 0}, value, {1}), frame(0x605, {0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0, 0}));
  EXPECT_FALSE(sut.receive(frame(0x585, {0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0}), {2}));
  EXPECT_EQ(sut.state(), SdoClient::State::done);
}

TEST(SdoClient, ExpeditedUpload) {
  SdoClient sut(5, 100ms);
  EXPECT_EQ(sut.upload({0x1000, 0}, {1}), frame(0x605, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
  EXPECT_FALSE(sut.receive(frame(0x585, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}), {2}));
  ASSERT_EQ(sut.state(), SdoClient::State::done);
  EXPECT_EQ(get_le32(sut.value()), 0x00020192U);
}

TEST(SdoClient, SegmentedDownload) {
  SdoClient sut(5, 100ms);
  const std::uint8_t value[] = {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'};
  EXPECT_EQ(sut.download({0x1008, 0}, value, {1}), frame(0x605, {0x21, 0x08, 0x10, 0x00, 0x08, 0, 0, 0}));
  EXPECT_EQ(sut.receive(frame(0x585, {0x60, 0x08, 0x10, 0x00, 0, 0, 0, 0}), {2}),
            frame(0x605, {0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}));
  EXPECT_EQ(sut.receive(frame(0x585, {0x20, 0, 0, 0, 0, 0, 0, 0}), {3}), frame(0x605, {0x1D, 'h', 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(sut.receive(frame(0x585, {0x30, 0, 0, 0, 0, 0, 0, 0}), {4}));
  EXPECT_EQ(sut.state(), SdoClient::State::done);
}

TEST(SdoClient, SegmentedUpload) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x1008, 0}, {1});
  EXPECT_EQ(sut.receive(frame(0x585, {0x41, 0x08, 0x10, 0x00, 0x09, 0, 0, 0}), {2}),
            frame(0x605, {0x60, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(sut.receive(frame(0x585, {0x00, '1', '2', '3', '4', '5', '6', '7'}), {3}),
            frame(0x605, {0x70, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(sut.receive(frame(0x585, {0x1B, '8', '9', 0, 0, 0, 0, 0}), {4}));
  ASSERT_EQ(sut.state(), SdoClient::State::done);
  EXPECT_EQ(std::string(sut.value().begin(), sut.value().end()), "123456789");
}

TEST(SdoClient, AbortsADownloadWhoseAnswerHasTheWrongToggleBit) {
  const std::uint8_t value[] = {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'};
  // 0x05030000 toggle bit not alternated.
  const CanFrame aborted = frame(0x605, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05});
  for (const bool first : {true, false}) {
    SdoClient sut(5, 100ms);
    (void)sut.download({0x1008, 0}, value, {1});
    (void)sut.receive(frame(0x585, {0x60, 0x08, 0x10, 0x00, 0, 0, 0, 0}), {2});
    if (first) {
      EXPECT_EQ(sut.receive(frame(0x585, {0x30, 0, 0, 0, 0, 0, 0, 0}), {3}), aborted);
    } else {
      (void)sut.receive(frame(0x585, {0x20, 0, 0, 0, 0, 0, 0, 0}), {3});
      EXPECT_EQ(sut.receive(frame(0x585, {0x20, 0, 0, 0, 0, 0, 0, 0}), {4}), aborted) << "the answer came twice";
    }
    EXPECT_EQ(sut.state(), SdoClient::State::failed);
    EXPECT_EQ(sut.abort(), SdoAbort::toggle_not_alternated);
    EXPECT_FALSE(sut.receive(frame(0x585, {0x30, 0, 0, 0, 0, 0, 0, 0}), {5})) << "the transfer has ended";
  }
}

TEST(SdoClient, AbortsAnUploadOfWhichASegmentCameTwice) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x1008, 0}, {1});
  (void)sut.receive(frame(0x585, {0x41, 0x08, 0x10, 0x00, 0x09, 0, 0, 0}), {2});
  (void)sut.receive(frame(0x585, {0x00, '1', '2', '3', '4', '5', '6', '7'}), {3});
  EXPECT_EQ(sut.receive(frame(0x585, {0x00, '1', '2', '3', '4', '5', '6', '7'}), {4}),
            frame(0x605, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(sut.state(), SdoClient::State::failed);
  EXPECT_EQ(sut.abort(), SdoAbort::toggle_not_alternated);
}

TEST(SdoClient, AbortsAnUploadThatBeginsWithTheWrongToggleBit) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x1008, 0}, {1});
  (void)sut.receive(frame(0x585, {0x41, 0x08, 0x10, 0x00, 0x09, 0, 0, 0}), {2});
  EXPECT_EQ(sut.receive(frame(0x585, {0x10, '1', '2', '3', '4', '5', '6', '7'}), {3}),
            frame(0x605, {0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(sut.state(), SdoClient::State::failed);
}

TEST(SdoClient, TellsWhyTheServerRefused) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x3000, 0}, {1});
  EXPECT_FALSE(sut.receive(frame(0x585, {0x80, 0x00, 0x30, 0x00, 0x00, 0x00, 0x02, 0x06}), {2}));
  EXPECT_EQ(sut.state(), SdoClient::State::failed);
  EXPECT_EQ(words(sut.abort()), "object does not exist");
}

TEST(SdoClient, AbortsAfterTheTimeout) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x1000, 0}, {1'000'000});
  EXPECT_EQ(sut.due().ns, 101'000'000);
  EXPECT_FALSE(sut.advance({100'999'999}));
  // 0x05040000 SDO protocol timed out.
  EXPECT_EQ(sut.advance({101'000'000}), frame(0x605, {0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}));
  EXPECT_EQ(sut.state(), SdoClient::State::failed);
}

TEST(SdoClient, IgnoresALateAnswerToAnotherTransfer) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x1000, 0}, {1});
  EXPECT_FALSE(sut.receive(frame(0x585, {0x4B, 0x17, 0x10, 0x00, 0xE8, 0x03, 0, 0}), {2}));
  EXPECT_EQ(sut.state(), SdoClient::State::busy);
}

TEST(SdoClient, RefusesAnUploadBeyondItsBound) {
  SdoClient sut(5, 100ms);
  (void)sut.upload({0x1008, 0}, {1});
  const auto answer = sut.receive(frame(0x585, {0x41, 0x08, 0x10, 0x00, 0xFF, 0xFF, 0xFF, 0x7F}), {2});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->data[0], 0x80);
}

}  // namespace
}  // namespace cellmirror::can
