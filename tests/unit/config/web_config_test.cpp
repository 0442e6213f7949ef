// [web] of cell files: where the monitor page listens, and who may ask.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct WebConfig : testing::Test {
  std::optional<LoadedCell> load(const std::string& text) {
    diagnostics = {};
    return load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n" + text), diagnostics);
  }
  // What is said of the value behind `keys`, which stand alone in the table.
  std::string refusal(const std::string& keys) {
    EXPECT_FALSE(load("[web]\n" + keys + "\n")) << keys;
    return diagnostics.text();
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(WebConfig, ListensOnLoopbackForEverybodyOfThisMachineByDefault) {
  for (const char* text : {"", "[web]\n"}) {
    const auto sut = load(text);
    ASSERT_TRUE(sut) << diagnostics.text();
    EXPECT_TRUE(sut->web.enabled);
    EXPECT_EQ(sut->web.address, "127.0.0.1");
    EXPECT_FALSE(sut->web.read_only);
    EXPECT_THAT(sut->web.origins, IsEmpty());
  }
  EXPECT_EQ(load("")->web.port, load("[web]\n")->web.port);
}

TEST_F(WebConfig, TakesEveryKey) {
  const auto sut = load(
      "[web]\nenabled = false\nport = 9001\naddress = \"::1\"\nread_only = true\n"
      "origins = [\"https://monitor.example.org\", \"http://[::1]:8080\"]\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_FALSE(sut->web.enabled);
  EXPECT_EQ(sut->web.port, 9001);
  EXPECT_EQ(sut->web.address, "::1");
  EXPECT_TRUE(sut->web.read_only);
  EXPECT_THAT(sut->web.origins, ElementsAre("https://monitor.example.org", "http://[::1]:8080"));
}

TEST_F(WebConfig, PortsAreThoseThatCanBeListenedAt) {
  for (const char* port : {"1", "65535"}) EXPECT_TRUE(load("[web]\nport = " + std::string(port) + "\n")) << port;
  for (const char* port : {"0", "65536", "-1", "8420.0", "\"8420\""})
    EXPECT_THAT(refusal("port = " + std::string(port)), HasSubstr("cell.toml:4:8: error: [web]: port ")) << port;
}

TEST_F(WebConfig, AddressesThatOthersReachHaveToBeMeant) {
  for (const char* address : {"0.0.0.0", "192.168.1.7", "::"}) {
    const std::string key = "address = \"" + std::string(address) + "\"\n";
    EXPECT_THAT(refusal(key), HasSubstr("allow_remote = true")) << address;
    EXPECT_FALSE(load("[web]\nallow_remote = false\n" + key)) << address;
    const auto sut = load("[web]\nallow_remote = true\n" + key);
    ASSERT_TRUE(sut) << diagnostics.text();
    EXPECT_EQ(sut->web.address, address);
  }
  for (const char* address : {"127.0.0.2", "::1"})
    EXPECT_TRUE(load("[web]\naddress = \"" + std::string(address) + "\"\n")) << address;
}

TEST_F(WebConfig, WarnsIfOtherMachinesOrOriginsReachThePage) {
  ASSERT_TRUE(
      load("[web]\nallow_remote = true\naddress = \"0.0.0.0\"\norigins = [\"https://a.example\", \"file://\"]\n"));
  EXPECT_EQ(diagnostics.warnings(), 3U) << diagnostics.text();
  EXPECT_THAT(diagnostics.text(), HasSubstr("the page at 0.0.0.0 is reachable from other machines"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("pages of https://a.example may show this cell"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("any HTML file"));
  for (const char* here : {"", "address = \"127.0.0.1\"\n"}) {
    ASSERT_TRUE(load("[web]\nallow_remote = true\n" + std::string(here)));
    EXPECT_THAT(diagnostics.text(), HasSubstr("allow_remote has no effect with the address 127.0.0.1"));
  }
  ASSERT_TRUE(load("[web]\nport = 9001\n"));
  EXPECT_EQ(diagnostics.warnings(), 0U) << diagnostics.text();
}

TEST_F(WebConfig, AddressesAreNumeric) {
  for (const char* address : {"localhost", "127.0.0.1:80", "", "127.0.0.256", "127.evil.example.org", "::g"})
    EXPECT_THAT(refusal("address = \"" + std::string(address) + "\""), HasSubstr("is not a numeric address"))
        << address;
}

TEST_F(WebConfig, OriginsHaveASchemeAndAHostAndNothingElse) {
  for (const char* origin : {"monitor.example.org", "ftp://a", "http://", "https://a/", "https://a/b", "https://a b",
                             "*", "null", "https://a\\nX: y", "https://user@a"})
    EXPECT_THAT(refusal("origins = [\"" + std::string(origin) + "\"]"), HasSubstr("is not an origin")) << origin;
  EXPECT_THAT(refusal("origins = [\"file:///a\"]"), HasSubstr("is not an origin"));
  EXPECT_TRUE(load("[web]\norigins = [\"file://\"]\n")) << "that of a desktop app";
  EXPECT_THAT(refusal("origins = \"https://a\""), HasSubstr("origins must be an array"));
}

TEST_F(WebConfig, OriginsAreFew) {
  std::string sixteen;
  for (int i = 0; i < 16; ++i) sixteen += "\"https://a\", ";
  EXPECT_TRUE(load("[web]\norigins = [" + sixteen + "]\n")) << diagnostics.text();
  EXPECT_THAT(refusal("origins = [" + sixteen + "\"https://b\"]"), HasSubstr("17 origins, but at most 16"));
}

// 203.0.113.0/24 and 2001:db8::/32 are reserved for documentation (RFC 5737, RFC 3849): no machine has them.
TEST_F(WebConfig, WarnsOfAnAddressThatThisMachineDoesNotHave) {
  for (const char* absent : {"203.0.113.77", "2001:db8::7"}) {
    const std::string address = "\"" + std::string(absent) + "\"";
    EXPECT_TRUE(load("[web]\naddress = " + address + "\nallow_remote = true\n")) << "it may come later";
    EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:4:11: warning: "));
    EXPECT_THAT(diagnostics.text(),
                HasSubstr("no network interface of this machine has the address " + std::string(absent)));
    EXPECT_TRUE(load("[dds_output]\ninterface_address = " + address + "\n"));
    EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:4:21: warning: "));
  }
  for (const char* own : {"127.0.0.1", "127.8.8.8", "::1", "0.0.0.0", "::"}) {
    EXPECT_TRUE(load("[web]\naddress = \"" + std::string(own) + "\"\nallow_remote = true\n"));
    EXPECT_THAT(diagnostics.text(), testing::Not(HasSubstr("no network interface"))) << own;
  }
}

TEST_F(WebConfig, AllThatIsWrongIsToldAtOnce) {
  EXPECT_FALSE(
      load("[web]\nenabled = 1\nport = 0\naddress = \"x\"\nread_only = \"no\"\norigins = [\"x\"]\ntls = true\n"));
  EXPECT_EQ(diagnostics.errors(), 6U) << diagnostics.text();
  EXPECT_THAT(diagnostics.text(), HasSubstr("the key tls is unknown"));
}

}  // namespace
}  // namespace cellmirror
