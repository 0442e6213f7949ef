#include "drivers/mqtt/credentials.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

namespace cellmirror::mqtt {
namespace {

TEST(MqttCredentials, AreTwoLines) {
  const auto read = parse_credentials("gateway\nword with: signs \n");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->user, "gateway");
  EXPECT_EQ(read->password, "word with: signs ");
  EXPECT_TRUE(parse_credentials("gateway\r\nword\r\n"));
  EXPECT_TRUE(parse_credentials("gateway\nword"));
  for (const char* wrong : {"", "\n", "gateway", "gateway\n", "\nword\n", "a\nb\nc\n", "a\x01\nb\n", "a\n\xFF\n"})
    EXPECT_FALSE(parse_credentials(wrong)) << wrong;
  EXPECT_FALSE(parse_credentials("a\n" + std::string(1025, 'x')));
}

class CredentialsFile : public testing::Test {
 protected:
  CredentialsFile() {
    folder_ = std::filesystem::temp_directory_path() / ("cellmirror-mqtt-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream(file()) << "gateway\nsecret\n";
    ::chmod(file().c_str(), 0600);
  }
  ~CredentialsFile() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string file() const { return (folder_ / "mqtt").string(); }

  std::filesystem::path folder_;
};

TEST_F(CredentialsFile, IsTheOwnersAlone) {
  EXPECT_TRUE(read_credentials(file()));
  for (const mode_t mode : {0640U, 0604U, 0660U}) {
    ::chmod(file().c_str(), mode);
    const auto refused = read_credentials(file());
    ASSERT_FALSE(refused) << mode;
    EXPECT_EQ(refused.error().remedy, "chmod 600 " + file());
  }
  EXPECT_FALSE(read_credentials(folder_.string()));
  EXPECT_FALSE(read_credentials(file() + "x"));
}

TEST_F(CredentialsFile, IsNotTold) {
  std::ofstream(file()) << "gateway\nsecret\nsecret\n";
  const auto refused = read_credentials(file());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text().find("secret"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::mqtt
