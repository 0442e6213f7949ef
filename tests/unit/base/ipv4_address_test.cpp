#include "rt_core/base/ipv4_address.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror {
namespace {

TEST(Ipv4AddressTest, WithAndWithoutPort) {
  EXPECT_EQ(parse_ipv4_address("127.0.0.1"), (Ipv4Address{"127.0.0.1", 0}));
  EXPECT_EQ(parse_ipv4_address("10.1.2.3:1"), (Ipv4Address{"10.1.2.3", 1}));
  EXPECT_EQ(parse_ipv4_address("10.1.2.3:65535"), (Ipv4Address{"10.1.2.3", 65535}));
}

TEST(Ipv4AddressTest, NothingElse) {
  for (const char* wrong : {"", ":", ":80", "host", "host:80", "10.1.2", "10.1.2.256", "10.1.2.3:", "10.1.2.3:0",
                            "10.1.2.3:65536", "10.1.2.3: 80", "10.1.2.3:+80", "10.1.2.3:0x50", "::1", "10.1.2.3:80:80"})
    EXPECT_FALSE(parse_ipv4_address(wrong)) << wrong;
  EXPECT_FALSE(parse_ipv4_address(std::string("10.1.2.3\0x", 10)));
}

}  // namespace
}  // namespace cellmirror
