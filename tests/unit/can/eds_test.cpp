#include "drivers/can/canopen/eds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "drivers/can/canopen/bytes.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using testing::HasSubstr;

TEST(Eds, ReadsObjectsWithTheirTypesAccessAndValues) {
  Diagnostics diagnostics;
  const auto sut = read_eds(can_data("drive.dcf"), 5, diagnostics);
  ASSERT_TRUE(sut);
  EXPECT_EQ(diagnostics.text(), "");
  EXPECT_EQ(sut->vendor, "Cellmirror tests");
  EXPECT_EQ(sut->product, "Axis");
  const ObjectDictionary& objects = sut->objects;
  EXPECT_EQ(objects.integer({0x1000, 0}), 0x00020192);
  EXPECT_EQ(objects.find({0x1000, 0})->access, ObjectAccess::read_only);
  EXPECT_EQ(objects.integer({0x1017, 0}), 100) << "ParameterValue of a DCF wins over DefaultValue";
  EXPECT_EQ(objects.integer({0x1800, 1}), 0x185) << "$NODEID + 0x180";
  EXPECT_EQ(objects.integer({0x6060, 0}), -3);
  EXPECT_EQ(objects.find({0x6060, 0})->low_limit, -128);
  EXPECT_EQ(objects.find({0x6060, 0})->high_limit, 127);
  EXPECT_EQ(objects.integer({0x6064, 0}), -1) << "0xFFFFFFFF of a signed object";
  EXPECT_TRUE(objects.find({0x6064, 0})->pdo_mappable);
  EXPECT_EQ(objects.integer({0x2001, 0}), 0755) << "a leading 0 is octal";
  EXPECT_EQ(std::bit_cast<float>(get_le32(objects.find({0x2000, 0})->value)), 1.5F);
}

TEST(Eds, CompactSubObjectsAreUnfolded) {
  Diagnostics diagnostics;
  const auto sut = read_eds(can_data("drive.dcf"), 5, diagnostics);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->objects.integer({0x1003, 0}), 3);
  EXPECT_EQ(sut->objects.integer({0x1003, 1}), 7);
  EXPECT_EQ(sut->objects.integer({0x1003, 2}), 0x12345678) << "from [1003Value]";
  EXPECT_EQ(sut->objects.integer({0x1003, 3}), 7);
  EXPECT_EQ(sut->objects.find({0x1003, 4}), nullptr);
}

TEST(Eds, GivesTheTpdosThatExist) {
  Diagnostics diagnostics;
  const auto sut = read_eds(can_data("drive.dcf"), 5, diagnostics);
  ASSERT_TRUE(sut);
  const auto tpdos = tpdos_of(sut->objects, 5);
  ASSERT_EQ(tpdos.size(), 1U) << "TPDO2 is switched off by bit 31";
  EXPECT_EQ(tpdos[0].number, 1);
  EXPECT_EQ(tpdos[0].cob_id, 0x185U);
  EXPECT_EQ(tpdos[0].transmission_type, 1);
  ASSERT_EQ(tpdos[0].entries.size(), 2U);
  EXPECT_EQ(tpdos[0].entries[1].index, 0x6064);
  EXPECT_EQ(tpdos[0].entries[1].bits, 32);
}

TEST(Eds, TellsAllMistakesWithTheirPlaces) {
  const std::string text =
      "key=before\n"
      "[1000\n"
      "[1001]\n"
      "DataType=0x0005\n"
      "AccessType=maybe\n"
      "DefaultValue=300\n"
      "no equals sign\n"
      "[1002]\n"
      "DataType=0x0007\n"
      "DefaultValue=$NODEID+12x\n"
      "[1003]\n"
      "DataType=0x0099\n"
      "[OptionalObjects]\n"
      "1=0x6000\n"
      "2=nonsense\n";
  Diagnostics diagnostics;
  const DeviceDescription sut = parse_eds(text, "f.eds", 1, diagnostics);
  const std::string told = diagnostics.text();
  for (const char* expected :
       {"f.eds:1:1: error: a key before the first section", "f.eds:2:1: error: a section needs a name and ends with ]",
        "f.eds:5:12: error: 'maybe' is no AccessType", "f.eds:6:14: error: '300' is no value of 1 bytes",
        "f.eds:7:1: error: expected [section], key=value or ; comment", "f.eds:10:14: error: '$NODEID+12x' is no value",
        "f.eds:11: warning: [1003] has the unknown DataType 0x99", "f.eds:14:3: warning: the object 0x6000 is listed",
        "f.eds:15:3: error: 'nonsense' is no index"}) {
    EXPECT_THAT(told, HasSubstr(expected));
  }
  EXPECT_NE(sut.objects.find({0x1001, 0}), nullptr) << "what could be read is there";
}

TEST(Eds, AFileWithoutObjectsIsAnError) {
  Diagnostics diagnostics;
  (void)parse_eds("", "f.eds", 1, diagnostics);
  EXPECT_THAT(diagnostics.text(), HasSubstr("the file describes no object"));
  EXPECT_FALSE(read_eds("/does/not/exist.eds", 1, diagnostics));
}

TEST(Eds, ReadsFilesOfOthers) {
  const auto folder = shared_data() / "eds";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "skipped: no shared EDS files on this machine";
  Diagnostics diagnostics;
  const auto prbt = read_eds((folder / "pilz_prbt_0_1.dcf").string(), 3, diagnostics);
  ASSERT_TRUE(prbt);
  const auto tpdos = tpdos_of(prbt->objects, 3);
  ASSERT_EQ(tpdos.size(), 3U);
  EXPECT_EQ(tpdos[2].cob_id, 0x383U);
  EXPECT_EQ(tpdos[2].transmission_type, 1);
  EXPECT_EQ(tpdos[2].entries[0].index, 0x6064);
  const auto ipos = read_eds((folder / "ros2_canopen_cia402_slave.eds").string(), 3, diagnostics);
  ASSERT_TRUE(ipos);
  EXPECT_EQ(tpdos_of(ipos->objects, 3).size(), 2U);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
}

}  // namespace
}  // namespace cellmirror::can
