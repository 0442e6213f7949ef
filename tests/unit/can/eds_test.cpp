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
  const auto tpdos = tpdos_of(*sut, 5, "drive.dcf", diagnostics);
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
       {"f.eds:1:1: warning: a key before the first section",
        "f.eds:2:1: warning: a section needs a name and ends with ]",
        "f.eds:5:12: warning: 'maybe' is not an AccessType",
        "f.eds:6:14: warning: '300' is not a value that 1 byte can",
        "f.eds:7:1: warning: the line is neither [section], key=value nor ; comment",
        "f.eds:10:14: warning: '$NODEID+12x' is not a value", "f.eds:11: warning: [1003] has the unknown DataType 0x99",
        "f.eds:14:3: warning: the object 0x6000 is listed", "f.eds:15:3: warning: 'nonsense' is not the index"}) {
    EXPECT_THAT(told, HasSubstr(expected));
  }
  EXPECT_TRUE(diagnostics.ok()) << "the cell does not use these objects";
  EXPECT_NE(sut.objects.find({0x1001, 0}), nullptr) << "what could be read is there";
}

// An EDS with TPDO1 of statusword and position, followed by the lines `more`.
std::string drive_text(const std::string& more) {
  return "[1A00]\nObjectType=9\nSubNumber=3\n"
         "[1A00sub0]\nDataType=5\nDefaultValue=2\n"
         "[1A00sub1]\nDataType=7\nDefaultValue=0x60410010\n" +
         more;
}
const std::string kPosition = "[1A00sub2]\nDataType=7\nDefaultValue=0x60640020";

struct ReadDrive {
  Diagnostics diagnostics;
  DeviceDescription device;
  std::vector<TpdoConfig> tpdos;
};
ReadDrive read_drive(const std::string& text, std::uint8_t node = 3) {
  ReadDrive read;
  read.device = parse_eds(text, "f.eds", node, read.diagnostics);
  read.tpdos = tpdos_of(read.device, node, "f.eds", read.diagnostics);
  warn_of_foreign_node(read.device, read.tpdos, node, "f.eds", read.diagnostics);
  return read;
}

TEST(Eds, IgnoresCommentsOfEveryKindBehindValues) {
  for (const char* comment : {" ; position", "; position", "\t# position", " // position", ";"}) {
    const ReadDrive sut = read_drive(
        drive_text("# by a tool\n// 2024\n" + kPosition + comment + "\nPDOMapping=1;yes\nAccessType=rw ; always\n"));
    EXPECT_EQ(sut.diagnostics.text(), "") << comment;
    ASSERT_EQ(sut.tpdos.size(), 1U) << comment;
    ASSERT_EQ(sut.tpdos[0].entries.size(), 2U);
    EXPECT_EQ(sut.tpdos[0].entries[1].index, 0x6064);
    EXPECT_TRUE(sut.device.objects.find({0x1A00, 2})->pdo_mappable);
  }
}

TEST(Eds, ATextKeepsItsSemicolons) {
  const ReadDrive sut = read_drive("[1008]\nDataType=9\nDefaultValue=AX;8 // rev #2\n");
  const std::vector<std::uint8_t>& value = sut.device.objects.find({0x1008, 0})->value;
  EXPECT_EQ(std::string(value.begin(), value.end()), "AX;8 // rev #2");
}

TEST(Eds, ReadsNumbersInTheSpellingsOfAllTools) {
  const ReadDrive sut = read_drive(
      "[2000]\nDataType=7\nDefaultValue=0X3ED\n[2001]\nDataType=5\nDefaultValue=\"0x60\"\n"
      "[2002]\nDataType=5\nDefaultValue=009\n[2003]\nDataType=7\nDefaultValue= $NodeID + 0x180 ; TPDO1\n");
  EXPECT_EQ(sut.diagnostics.text(), "");
  EXPECT_EQ(sut.device.objects.integer({0x2000, 0}), 0x3ED);
  EXPECT_EQ(sut.device.objects.integer({0x2001, 0}), 0x60);
  EXPECT_EQ(sut.device.objects.integer({0x2002, 0}), 9);
  EXPECT_EQ(sut.device.objects.integer({0x2003, 0}), 0x183);
}

TEST(Eds, WarnsOfFaultsInUnusedLines) {
  for (const char* line :
       {"[2010]\nDataType=5\nDefaultValue=0x1FF", "[2010]\nDataType=7\nDefaultValue=-1", "[2010]\nDefaultValue=1",
        "[2010]\nDataType=5\nAccessType=read/write", "[2010]\nDataType=5\nCompactSubObj=300",
        "[2010]\nDataType=5\nCompactSubObj=all", "[2010]\nDataType=8\nDefaultValue=one", "[2010", "****", "\x01\x02",
        "[2010]\nDataType=5\nPDOMapping=yes", "[OptionalObjects]\n1=10 objects",
        "[2010]\nDataType=7\nDefaultValue=$NODEID+0xFFFFFFFFFFFFFFFF",
        "[1A03sub0]\nDataType=5\nDefaultValue=1\n[1A03sub1]\nDataType=7\nDefaultValue=0x20000010\n[1803sub3]\n"
        "DataType=6\nDefaultValue=70000"}) {
    const ReadDrive sut = read_drive(drive_text(kPosition + "\n" + line + "\n"));
    EXPECT_TRUE(sut.diagnostics.ok()) << line << "\n" << sut.diagnostics.text();
    EXPECT_GE(sut.diagnostics.warnings(), 1U) << line;
    ASSERT_FALSE(sut.tpdos.empty()) << line;
    EXPECT_EQ(sut.tpdos[0].entries.size(), 2U) << line;
  }
}

TEST(Eds, FaultsInLinesThatAStreamUsesAreErrorsWithTheirPlace) {
  for (const auto& [line, place] : {std::pair("[1A00sub2]\nDataType=5\nDefaultValue=0x60640020", "f.eds:12:14"),
                                    std::pair("[1A00sub2]\nDataType=7\nDefaultValue=x", "f.eds:12:14"),
                                    std::pair("[1A00sub2]\nDefaultValue=0x60640020", "f.eds:10")}) {
    const ReadDrive sut = read_drive(drive_text(line));
    EXPECT_THAT(sut.diagnostics.text(Severity::error),
                HasSubstr(std::string(place) + ": error: the stream uses 0x1A00:02: "))
        << line;
    EXPECT_TRUE(sut.tpdos.empty()) << line;
  }
  const ReadDrive cob_id = read_drive(drive_text(kPosition + "\n[1800sub1]\nDataType=7\nDefaultValue=abc\n"));
  EXPECT_THAT(cob_id.diagnostics.text(), HasSubstr("f.eds:15:14: error: the stream uses 0x1800:01"));
  const ReadDrive off = read_drive(
      drive_text("[1A00sub2]\nDataType=7\nDefaultValue=x\n[1800sub1]\nDataType=7\nDefaultValue=0x80000180\n"));
  EXPECT_TRUE(off.diagnostics.ok()) << "no stream uses a TPDO that is switched off";
}

TEST(Eds, AGapInAMappingIsAnError) {
  const std::string text =
      "[1A00sub0]\nDataType=5\nDefaultValue=2\n[1A00sub1]\nDataType=7\n[1A00sub2]\nDataType=7\n"
      "DefaultValue=0x60640020\n";
  EXPECT_THAT(read_drive(text).diagnostics.text(),
              HasSubstr("error: the mapping of TPDO1 has a gap: 0x1A00:01 is 0 or missing, 0x1A00:02 is not"));
}

TEST(Eds, ADcfOfAnotherNodeIsReported) {
  const std::string text =
      drive_text(kPosition + "\n[1800sub1]\nDataType=7\nParameterValue=0x185\n" + "[DeviceComissioning]\nNodeID=5\n");
  const ReadDrive own = read_drive(text, 5);
  EXPECT_EQ(own.diagnostics.text(), "");
  const ReadDrive other = read_drive(text, 3);
  EXPECT_TRUE(other.diagnostics.ok());
  EXPECT_THAT(other.diagnostics.text(), HasSubstr("f.eds:17:8: warning: the file was written for node 5"));
  EXPECT_THAT(other.diagnostics.text(),
              HasSubstr("TPDO1 of node 3 has the COB-ID 0x185, which CiA 301 gives to node 5"));
}

TEST(Eds, ADriveIsRecognizedByItsProfileOrItsPosition) {
  const auto is_drive_of = [](const char* text) {
    Diagnostics diagnostics;
    return is_drive(parse_eds(text, "f.eds", 1, diagnostics));
  };
  EXPECT_TRUE(is_drive_of("[1000]\nDataType=7\nDefaultValue=0x00420192\n"));
  EXPECT_TRUE(is_drive_of("[1000]\nDataType=7\nDefaultValue=0\n[6064]\nDataType=4\n"));
  EXPECT_FALSE(is_drive_of("[1000]\nDataType=7\nDefaultValue=0x00030191\n"));
  EXPECT_FALSE(is_drive_of("[1001]\nDataType=5\n"));
}

TEST(Eds, ReadsLineEndsOfEverySystem) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line : {"[1000]", "DataType=7", "DefaultValue=402", "\x1A"}) text += line + std::string(end);
    const ReadDrive sut = read_drive(text);
    EXPECT_EQ(sut.diagnostics.text(), "");
    EXPECT_EQ(sut.device.objects.integer({0x1000, 0}), 402);
  }
  EXPECT_THAT(read_drive("[1000]\r\nDataType=7\r\nDefaultValue=x\r\n").diagnostics.text(), HasSubstr("f.eds:3:14:"));
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
  const auto tpdos = tpdos_of(*prbt, 3, "prbt.dcf", diagnostics);
  ASSERT_EQ(tpdos.size(), 3U);
  EXPECT_EQ(tpdos[2].cob_id, 0x383U);
  EXPECT_EQ(tpdos[2].transmission_type, 1);
  EXPECT_EQ(tpdos[2].entries[0].index, 0x6064);
  const auto ipos = read_eds((folder / "ros2_canopen_cia402_slave.eds").string(), 3, diagnostics);
  ASSERT_TRUE(ipos);
  EXPECT_EQ(tpdos_of(*ipos, 3, "ipos.eds", diagnostics).size(), 2U);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
}

}  // namespace
}  // namespace cellmirror::can
