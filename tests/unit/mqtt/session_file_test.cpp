#include "drivers/mqtt/session_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace cellmirror::mqtt {
namespace {

class SessionFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void put(const std::string& text) const { std::ofstream(file_) << text; }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("cellmirror-session-" + std::to_string(::getpid()));
  std::string file_ = folder_ / "n1.session";
};

TEST_F(SessionFile, KeepsTheNumber) {
  const auto none = read_session(file_);
  ASSERT_TRUE(none.has_value());
  EXPECT_FALSE(none->has_value());
  for (const int number : {0, 7, 255}) {
    ASSERT_TRUE(write_session(file_, static_cast<std::uint8_t>(number)));
    EXPECT_EQ(**read_session(file_), number);
  }
  struct stat about{};
  ASSERT_EQ(::stat(file_.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0600U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "no temporary file is left";
}

TEST_F(SessionFile, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "7", "256\n", "-1\n", "7 \n", "x\n", "0000000000000007\n", "7\n7\n"}) {
    put(text);
    EXPECT_FALSE(read_session(file_).has_value()) << text;
  }
  ASSERT_TRUE(write_session(file_, 1)) << "and it is replaced";
  EXPECT_EQ(**read_session(file_), 1);
}

TEST_F(SessionFile, FollowsNoLink) {
  std::filesystem::create_symlink(folder_ / "other", file_);
  EXPECT_FALSE(read_session(file_).has_value());
  ASSERT_TRUE(write_session(file_, 3));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other"));
  EXPECT_FALSE(write_session(folder_ / "missing" / "n1.session", 3).has_value());
}

}  // namespace
}  // namespace cellmirror::mqtt
