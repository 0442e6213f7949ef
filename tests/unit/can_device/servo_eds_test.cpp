// The EDS that is shipped for the drive says what the drive has.
#include <gtest/gtest.h>

#include <string>

#include "drivers/can/canopen/eds.hpp"
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

}  // namespace
}  // namespace cellmirror::can
