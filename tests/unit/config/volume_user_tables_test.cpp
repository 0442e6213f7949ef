// Tables of users for voxel volumes.
#include "config/volume_user_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "rt_core/volume/user_table.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTwoRows = "# value red green blue opacity\n-1000 0 0 1 0\n1000 1 1 1 0.5\n";

class VolumeTablesOfHome : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { home_.write("envlib/" + name, text); }
  [[nodiscard]] Result<VolumeUserTables> load() const { return load_volume_tables(*KismetHome::open(home_.root())); }

  TemporaryHome home_;
};

TEST_F(VolumeTablesOfHome, ATableWithoutAFileIsNone) {
  const auto none = load();
  ASSERT_TRUE(none) << none.error().text();
  EXPECT_EQ(none->at(0), nullptr);
  write("USER2_LUT.lut", kTwoRows);
  const auto second = load();
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ(second->at(0), nullptr);
  ASSERT_NE(second->at(1), nullptr);
  EXPECT_EQ(second->at(1)->rows.size(), 2U);
  EXPECT_EQ(second->at(1)->rows[1].opacity, 0.5F);
}

TEST_F(VolumeTablesOfHome, AFileWithAnErrorIsRefusedWithItsPlace) {
  write("USER1_LUT.lut", std::string(kTwoRows) + "500 0 0 0 0\n");
  const auto sut = load();
  ASSERT_FALSE(sut);
  EXPECT_THAT(sut.error().text(), HasSubstr("envlib/USER1_LUT.lut:4"));
  write("USER1_LUT.lut", std::string(volume::kLongestUserTable + 1, '#'));
  EXPECT_FALSE(load());
}

TEST_F(VolumeTablesOfHome, ALinkOutOfTheCellFolderIsRefused) {
  std::filesystem::create_symlink("/etc/passwd", home_.root() / "envlib" / "USER1_LUT.lut");
  EXPECT_FALSE(load());
}

}  // namespace
}  // namespace cellmirror
