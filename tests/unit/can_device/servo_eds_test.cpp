// The EDS that is shipped for the drive says what the drive has.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "drivers/can/canopen/eds.hpp"
#include "drivers/can/canopen/ini.hpp"
#include "drivers/can/cia402/device/servo_objects.hpp"
#include "tests/unit/can/test_data.hpp"
#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

TEST(ServoEds, DescribesTheDrive) {
  constexpr std::uint8_t kNode = 5;
  const std::string file = (source_dir() / "config/devices/cellmirror_servo_drive.eds").string();
  Diagnostics diagnostics;
  const auto description = read_eds(file, kNode, diagnostics);
  ASSERT_TRUE(description);
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  const ObjectDictionary drive = make_servo_objects(test_drive(), 0);
  for (const auto& [address, entry] : drive.entries()) {
    const ObjectEntry* described = description->objects.find(address);
    ASSERT_NE(described, nullptr) << text(address);
    EXPECT_EQ(described->type, entry.type) << text(address);
    EXPECT_EQ(described->access, entry.access) << text(address);
    EXPECT_EQ(described->pdo_mappable, entry.pdo_mappable) << text(address);
    EXPECT_EQ(described->low_limit, entry.low_limit) << text(address);
    // Values of the profile's area depend on the cell file.
    const bool is_fixed = address.index < 0x2000;
    EXPECT_EQ(described->value, is_fixed ? entry.value : described->value) << text(address);
  }
  EXPECT_EQ(description->objects.size(), drive.size());
}

const std::string kServoEds = "config/devices/cellmirror_servo_drive.eds";

IniFile ini_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  Diagnostics diagnostics;
  IniFile ini = parse_ini(text, file.string(), diagnostics);
  EXPECT_EQ(diagnostics.text(), "");
  return ini;
}

std::vector<std::filesystem::path> shipped_files() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"config/devices", "config/cells"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_dir() / folder)) {
      if (entry.path().extension() == ".eds") files.push_back(entry.path());
    }
  }
  return files;
}

// Tools of masters assume that the drive has the defaults of the EDS. So objects that depend on the cell file have
// none.
TEST(ServoEds, GivesOnlyValuesThatEveryDriveHas) {
  constexpr std::uint8_t kNode = 5;
  DriveConfig other = test_drive();
  other.encoder_increments = 65'536;
  other.gear_motor = 100;
  other.gear_shaft = 3;
  other.velocity = 2;
  other.acceleration = 7;
  other.rated_torque = 3;
  other.peak_torque = 2;
  other.software_limits = {-1, 2};
  other.following_error = 0.1;
  other.blocked_after = 0.7;
  Diagnostics diagnostics;
  const auto description = read_eds((source_dir() / kServoEds).string(), kNode, diagnostics);
  ASSERT_TRUE(description);
  const IniFile ini = ini_of(source_dir() / kServoEds);
  for (const DriveConfig& config : {test_drive(), other}) {
    const ObjectDictionary drive = make_servo_objects(config, 0);
    for (const auto& [address, entry] : drive.entries()) {
      const bool is_simple = description->objects.find({address.index, 1}) == nullptr;
      const auto section = ini.find(is_simple ? fmt::format("{:04x}", address.index)
                                              : fmt::format("{:04x}sub{:x}", address.index, address.subindex));
      ASSERT_NE(section, ini.end()) << text(address);
      if (section->second.find("defaultvalue") == nullptr) continue;
      EXPECT_EQ(description->objects.find(address)->value, entry.value) << text(address);
    }
  }
}

// canopen for Python and lely's dcf tools read "$NODEID+0x180" and numbers that fit the type; they lose a bare $NODEID
// and refuse an overflow (tests/peers/eds_files.py runs them).
TEST(ShippedEds, NumbersHaveAFormThatOtherToolsRead) {
  const std::regex number("(\\$NODEID\\+)?(0x[0-9A-F]+|[0-9]+)", std::regex::icase);
  const auto files = shipped_files();
  ASSERT_GE(files.size(), 3U);
  for (const auto& file : files) {
    for (const auto& [name, section] : ini_of(file)) {
      const IniValue* value = section.find("defaultvalue");
      const IniValue* type = section.find("datatype");
      if (value == nullptr || type == nullptr || std::stoi(type->text, nullptr, 0) > 7) continue;
      std::smatch match;
      const bool is_signed = std::stoi(type->text, nullptr, 0) <= 4 && value->text.starts_with('-');
      const std::string unsigned_text = is_signed ? value->text.substr(1) : value->text;
      EXPECT_TRUE(std::regex_match(unsigned_text, match, number)) << file << " [" << name << "] " << value->text;
      const bool is_identifier = name == "1014" || name == "1018sub4" || name.starts_with("1200") ||
                                 name.starts_with("14") || name.starts_with("18");
      EXPECT_TRUE(is_identifier || !match[1].matched) << file << " [" << name << "] does not depend on the node";
    }
    for (const int node : {1, 127}) {
      Diagnostics diagnostics;
      EXPECT_TRUE(read_eds(file.string(), static_cast<std::uint8_t>(node), diagnostics));
      EXPECT_EQ(diagnostics.text(), "");
    }
  }
}

// lely's dcf tools check this too.
TEST(ShippedEds, ListsAndSubNumbersMatchTheSections) {
  for (const auto& file : shipped_files()) {
    const IniFile ini = ini_of(file);
    std::size_t listed = 0;
    for (const char* list : {"mandatoryobjects", "optionalobjects", "manufacturerobjects"}) {
      const auto found = ini.find(list);
      ASSERT_NE(found, ini.end()) << file << " " << list;
      const auto count = std::stoul(found->second.find("supportedobjects")->text);
      EXPECT_EQ(count, found->second.values.size() - 1) << file << " " << list;
      listed += count;
    }
    std::size_t objects = 0;
    for (const auto& [name, section] : ini) {
      if (!std::regex_match(name, std::regex("[0-9a-f]{4}"))) continue;
      ++objects;
      const IniValue* sub_number = section.find("subnumber");
      if (sub_number == nullptr) continue;
      const auto subs =
          std::ranges::count_if(ini, [&](const auto& other) { return other.first.starts_with(name + "sub"); });
      EXPECT_EQ(std::stol(sub_number->text, nullptr, 0), subs) << file << " [" << name << "]";
    }
    EXPECT_EQ(listed, objects) << file;
  }
}

}  // namespace
}  // namespace cellmirror::can
