// Who may feed a mirrored robot: [dds.security] and allow_from in cell files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kSecurity =
    "[dds.security]\nidentity_ca = \"sec/ca.pem\"\ncertificate = \"sec/own.pem\"\nprivate_key = \"sec/own.key\"\n"
    "governance = \"sec/governance.p7s\"\npermissions = \"sec/own.p7s\"\n";
constexpr const char* kDdsStream = "[[stream]]\nrobot = \"ARM\"\nkind = \"dds\"\n";

struct SecurityConfig : testing::Test {
  SecurityConfig() {
    home.write("envlib/arm.mpc",
               "format = 1\n[[node]]\nname = \"J_1\"\njoint = { type = \"revolute\", axis = [0, 0, 1], range_rad = "
               "[-1, 1], velocity_rad_s = 1 }\n[robot]\nid = \"ARM\"\nflange = \"J_1\"\n");
    for (const char* file : {"ca.pem", "permissions_ca.pem", "own.pem", "governance.p7s", "own.p7s"})
      home.write(std::string("sec/") + file, "x");
    key = home.write("sec/own.key", "x");
    std::filesystem::permissions(key, std::filesystem::perms{0600});
  }
  std::optional<LoadedCell> load(const std::string& text) {
    diagnostics = {};
    return load_cell(
        home.write("cell.toml", "format = 1\nname = \"c\"\n[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n" + text),
        diagnostics);
  }
  std::string udp(const std::string& more) const {
    return "[[stream]]\nrobot = \"ARM\"\nkind = \"can-cia402\"\n" + more +
           "\n[[stream.node]]\nid = 1\njoint = \"J_1\"\nrad_per_increment = 1e-6\n";
  }
  TemporaryHome home;
  std::filesystem::path key;
  Diagnostics diagnostics;
};

TEST_F(SecurityConfig, GivesTheSameFilesToOutputAndStreams) {
  const auto sut = load(std::string(kSecurity) + kDdsStream);
  ASSERT_TRUE(sut) << diagnostics.text();
  const DdsSecurityConfig& security = sut->dds.security;
  EXPECT_TRUE(security.enabled());
  EXPECT_EQ(security.identity_ca, (home.root() / "sec/ca.pem").string());
  EXPECT_EQ(security.permissions_ca, security.identity_ca) << "where the cell file names no other";
  EXPECT_EQ(security.private_key, key.string());
  EXPECT_EQ(security.permissions, (home.root() / "sec/own.p7s").string());
  EXPECT_EQ(std::get<DdsStreamConfig>(sut->streams.at(0).config).security, security);
}

TEST_F(SecurityConfig, IsOffWithoutTheTable) {
  const auto sut = load(kDdsStream);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_FALSE(sut->dds.security.enabled());
  EXPECT_FALSE(std::get<DdsStreamConfig>(sut->streams.at(0).config).security.enabled());
}

TEST_F(SecurityConfig, MayHaveAnotherCaForPermissions) {
  const auto sut = load(std::string(kSecurity) + "permissions_ca = \"sec/permissions_ca.pem\"\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->dds.security.permissions_ca, (home.root() / "sec/permissions_ca.pem").string());
}

TEST_F(SecurityConfig, RefusesAKeyThatOthersMayRead) {
  for (const unsigned mode : {0640U, 0604U, 0620U, 0601U}) {
    std::filesystem::permissions(key, std::filesystem::perms{mode});
    EXPECT_FALSE(load(kSecurity)) << mode;
    EXPECT_THAT(diagnostics.text(), HasSubstr("is accessible to others"));
    EXPECT_THAT(diagnostics.text(), HasSubstr("chmod 600"));
  }
  std::filesystem::permissions(key, std::filesystem::perms{0400});
  EXPECT_TRUE(load(kSecurity)) << diagnostics.text();
}

TEST_F(SecurityConfig, NeedsAllFilesAndInTheCellFolder) {
  EXPECT_FALSE(load("[dds.security]\nidentity_ca = \"sec/ca.pem\"\n"));
  for (const char* key_of : {"certificate", "private_key", "governance", "permissions"})
    EXPECT_THAT(diagnostics.text(), HasSubstr("the key " + std::string(key_of) + " is missing"));
  EXPECT_FALSE(load(std::string(kSecurity) + "permissions_ca = \"sec/nobody.pem\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("nobody.pem"));
  std::filesystem::create_symlink("/etc/passwd", home.root() / "sec/outside.pem");
  EXPECT_FALSE(load(std::string(kSecurity) + "permissions_ca = \"sec/outside.pem\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("leaves the cell folder"));
  EXPECT_FALSE(load(std::string(kSecurity) + "permissions_ca = \"/etc/hostname\"\n"));
  EXPECT_FALSE(load(std::string(kSecurity) + "password = \"secret\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("password"));
}

TEST_F(SecurityConfig, NamesTheSendersOfAUdpChannel) {
  const auto sources = [this](const std::string& more) {
    const auto sut = load(udp("channel = \"udp:239.74.163.2:43113\"\n" + more));
    EXPECT_TRUE(sut) << diagnostics.text();
    return sut ? std::get<Cia402StreamConfig>(sut->streams.at(0).config).channel.allow_from
               : std::vector<std::string>{"not loaded"};
  };
  EXPECT_THAT(sources(""), IsEmpty());
  EXPECT_THAT(sources("allow_from = [\"192.168.1.20\", \"fe80::1\"]"), ElementsAre("192.168.1.20", "fe80::1"));
}

TEST_F(SecurityConfig, RefusesSendersThatAreNoAddressesOrOfAnotherChannel) {
  const auto refused = [this](const std::string& text) {
    EXPECT_FALSE(load(udp(text))) << text;
    return diagnostics.text();
  };
  const std::string channel = "channel = \"udp:239.74.163.2:43113\"\n";
  EXPECT_THAT(refused(channel + "allow_from = [\"robot\"]"), HasSubstr("\"robot\" is not a numeric address"));
  EXPECT_THAT(refused(channel + "allow_from = []"), HasSubstr("allow_from has 0 addresses"));
  EXPECT_THAT(refused("channel = \"socketcan:can0\"\nallow_from = [\"10.0.0.1\"]"),
              HasSubstr("allow_from belongs to a udp: channel"));
}

}  // namespace
}  // namespace cellmirror
