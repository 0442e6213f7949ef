// Golden bytes from CiA 301: NMT 7.2.8.2, heartbeat 7.2.8.3, SYNC 7.2.5, EMCY 7.2.7, PDO 7.2.2.
#include <gtest/gtest.h>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/emcy.hpp"
#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

TEST(Nmt, CommandsHaveTheBytesOfTheStandard) {
  EXPECT_EQ(encode_nmt({NmtCommand::start, 3}), frame(0x000, {0x01, 0x03}));
  EXPECT_EQ(encode_nmt({NmtCommand::stop, 127}), frame(0x000, {0x02, 0x7F}));
  EXPECT_EQ(encode_nmt({NmtCommand::enter_pre_operational, 0}), frame(0x000, {0x80, 0x00}));
  EXPECT_EQ(encode_nmt({NmtCommand::reset_node, 5}), frame(0x000, {0x81, 0x05}));
  EXPECT_EQ(decode_nmt(frame(0x000, {0x82, 0x05})), (NmtMessage{NmtCommand::reset_communication, 5}));
}

TEST(Nmt, RefusesWhatIsNoCommand) {
  EXPECT_FALSE(decode_nmt(frame(0x000, {0x01})));
  EXPECT_FALSE(decode_nmt(frame(0x000, {0x01, 0x03, 0x00})));
  EXPECT_FALSE(decode_nmt(frame(0x000, {0x03, 0x03})));
  EXPECT_FALSE(decode_nmt(frame(0x000, {0x01, 0x80})));
  EXPECT_FALSE(decode_nmt(frame(0x001, {0x01, 0x03})));
  EXPECT_FALSE(decode_nmt(extended_frame(0x000, {0x01, 0x03})));
}

TEST(Heartbeat, HasTheStateInOneByte) {
  EXPECT_EQ(encode_heartbeat({3, NmtState::boot_up}), frame(0x703, {0x00}));
  EXPECT_EQ(encode_heartbeat({3, NmtState::operational}), frame(0x703, {0x05}));
  EXPECT_EQ(decode_heartbeat(frame(0x77F, {0x7F})), (Heartbeat{127, NmtState::pre_operational}));
  EXPECT_EQ(decode_heartbeat(frame(0x701, {0x04})), (Heartbeat{1, NmtState::stopped}));
  EXPECT_EQ(decode_heartbeat(frame(0x701, {0x85})), (Heartbeat{1, NmtState::operational})) << "toggle bit of guarding";
  EXPECT_FALSE(decode_heartbeat(frame(0x700, {0x05})));
  EXPECT_FALSE(decode_heartbeat(frame(0x780, {0x05})));
  EXPECT_FALSE(decode_heartbeat(frame(0x701, {0x06})));
  EXPECT_FALSE(decode_heartbeat(frame(0x701, {0x05, 0x00})));
}

TEST(Sync, HasNoDataOrACounter) {
  EXPECT_EQ(encode_sync(), frame(0x080, {}));
  EXPECT_EQ(encode_sync(240), frame(0x080, {0xF0}));
  EXPECT_TRUE(is_sync(frame(0x080, {})));
  EXPECT_TRUE(is_sync(frame(0x080, {0x01})));
  EXPECT_FALSE(is_sync(frame(0x080, {0x01, 0x02})));
  EXPECT_FALSE(is_sync(extended_frame(0x080, {})));
}

TEST(Emcy, CarriesCodeRegisterAndFiveBytes) {
  const CanFrame golden = frame(0x083, {0x11, 0x86, 0x21, 0x01, 0x02, 0x03, 0x04, 0x05});
  const Emcy emcy{3, 0x8611, 0x21, {1, 2, 3, 4, 5}};
  EXPECT_EQ(encode_emcy(emcy), golden);
  EXPECT_EQ(decode_emcy(golden), emcy);
  EXPECT_EQ(text(emcy), "node 3 0x8611 following error, register 0x21");
  EXPECT_FALSE(decode_emcy(frame(0x083, {0x11, 0x86})));
  EXPECT_FALSE(decode_emcy(frame(0x080, {0, 0, 0, 0, 0, 0, 0, 0}))) << "the SYNC identifier is nobody's EMCY";
}

TEST(Emcy, WordsNameTheMostSpecificClass) {
  EXPECT_EQ(emcy_words(0x0000), "no error");
  EXPECT_EQ(emcy_words(0x8130), "life guard or heartbeat error");
  EXPECT_EQ(emcy_words(0x8199), "communication");
  EXPECT_EQ(emcy_words(0x2399), "current, device output side");
  EXPECT_EQ(emcy_words(0x4FFF), "temperature");
  EXPECT_EQ(emcy_words(0xFF01), "device specific");
}

const std::vector<PdoEntryConfig> kStatusAndPosition = {{0x6041, 0, 16}, {0x6064, 0, 32}};

TEST(Pdo, PacksLittleEndianInTheOrderOfTheMapping) {
  const CanFrame golden = frame(0x183, {0x37, 0x02, 0x78, 0x56, 0x34, 0x12});
  const std::uint64_t values[] = {0x0237, 0x12345678};
  EXPECT_EQ(pack_pdo(0x183, kStatusAndPosition, values), golden);
  const auto unpacked = unpack_pdo(kStatusAndPosition, golden.payload());
  ASSERT_TRUE(unpacked);
  EXPECT_EQ((*unpacked)[0], (PdoValue{0x6041, 0, 16, 0x0237}));
  EXPECT_EQ((*unpacked)[1], (PdoValue{0x6064, 0, 32, 0x12345678}));
}

TEST(Pdo, MapsBitsAcrossBytesAndSkipsFillers) {
  // 3 bits, 5 bits filler, 12 bits, 4 bits: 101, xxxxx, 0xABC, 0x9.
  const std::vector<PdoEntryConfig> entries = {{0x2000, 1, 3}, {0, 0, 5}, {0x2000, 2, 12}, {0x2000, 3, 4}};
  const std::uint64_t values[] = {5, 0xABC, 9};
  const CanFrame golden = frame(0x200, {0x05, 0xBC, 0x9A});
  EXPECT_EQ(pack_pdo(0x200, entries, values), golden);
  const auto unpacked = unpack_pdo(entries, golden.payload());
  ASSERT_TRUE(unpacked);
  ASSERT_EQ(unpacked->size(), 3U);
  EXPECT_EQ((*unpacked)[1].raw, 0xABCU);
  EXPECT_EQ((*unpacked)[2].raw, 9U);
}

TEST(Pdo, RefusesAnotherLengthThanTheMappings) {
  EXPECT_FALSE(unpack_pdo(kStatusAndPosition, frame(0, {1, 2, 3, 4, 5}).payload()));
  EXPECT_FALSE(unpack_pdo(kStatusAndPosition, frame(0, {1, 2, 3, 4, 5, 6, 7}).payload()));
}

TEST(Pdo, MappingWordHoldsIndexSubindexAndBits) {
  EXPECT_EQ(mapping_word({0x6064, 0, 32}), 0x60640020U);
  const PdoEntryConfig entry = entry_of_mapping_word(0x60C10120);
  EXPECT_EQ(entry.index, 0x60C1);
  EXPECT_EQ(entry.subindex, 1);
  EXPECT_EQ(entry.bits, 32);
  EXPECT_EQ(entry_of_mapping_word(0x00050008).index, 0) << "a data type is a filler";
}

TEST(Pdo, MappingIsBoundedTo64Bits) {
  EXPECT_TRUE(is_valid_mapping(std::vector<PdoEntryConfig>{{1, 0, 32}, {2, 0, 32}}));
  EXPECT_FALSE(is_valid_mapping(std::vector<PdoEntryConfig>{{1, 0, 32}, {2, 0, 33}}));
  EXPECT_FALSE(is_valid_mapping(std::vector<PdoEntryConfig>{{1, 0, 0}}));
  EXPECT_FALSE(is_valid_mapping(std::vector<PdoEntryConfig>{}));
}

TEST(Bits, SignIsExtendedFromTheTopBit) {
  EXPECT_EQ(sign_extended(0xFF, 8), -1);
  EXPECT_EQ(sign_extended(0x7F, 8), 127);
  EXPECT_EQ(sign_extended(0x800, 12), -2048);
  EXPECT_EQ(sign_extended(0xFFFFFFFE, 32), -2);
  EXPECT_EQ(sign_extended(1, 1), -1);
  EXPECT_EQ(sign_extended(~std::uint64_t{0}, 64), -1);
}

}  // namespace
}  // namespace cellmirror::can
