// Golden bytes from the MessagePack specification and python-can's order of keys.
#include "drivers/can/channel/udp_datagram.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using namespace std::string_literals;

std::string key(const std::string& name) { return static_cast<char>(0xA0 + name.size()) + name; }

// id: the MessagePack bytes of the identifier; flags "C2" false, "C3" true.
std::string datagram(const std::string& id, bool extended, const std::string& data, bool fd = false,
                     const std::string& stamp = "\xCB\x00\x00\x00\x00\x00\x00\x00\x00"s) {
  const auto flag = [](bool set) { return set ? "\xC3"s : "\xC2"s; };
  return "\x8B"s + key("timestamp") + stamp + key("arbitration_id") + id + key("is_extended_id") + flag(extended) +
         key("is_remote_frame") + flag(false) + key("is_error_frame") + flag(false) + key("channel") + "\xC0"s +
         key("dlc") + static_cast<char>(data.size()) + key("data") + "\xC4"s + static_cast<char>(data.size()) + data +
         key("is_fd") + flag(fd) + key("bitrate_switch") + flag(fd) + key("error_state_indicator") + flag(false);
}

std::string encoded(const CanFrame& frame) {
  const UdpDatagram result = encode_udp_datagram(frame, 0.0);
  return {reinterpret_cast<const char*>(result.bytes.data()), result.size};
}

auto decoded(const std::string& bytes) {
  return decode_udp_datagram({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

TEST(UdpDatagram, ClassicFrameWith11BitIdentifier) {
  const std::string golden = datagram("\xCD\x01\x81"s, false, "\x01\x02\x03\x04"s);
  EXPECT_EQ(golden.size(), 158U);
  EXPECT_EQ(encoded(frame(0x181, {1, 2, 3, 4})), golden);
  EXPECT_EQ(decoded(golden).value(), frame(0x181, {1, 2, 3, 4}));
}

TEST(UdpDatagram, SmallIdentifierTakesOneByte) {
  EXPECT_EQ(encoded(frame(0x7F, {})), datagram("\x7F"s, false, ""));
  EXPECT_EQ(encoded(frame(0x80, {})), datagram("\xCC\x80"s, false, ""));
}

TEST(UdpDatagram, ExtendedIdentifier) {
  const CanFrame expected = extended_frame(0x1ABCDEF0, {1, 2, 3, 4, 5, 6, 7, 8});
  const std::string golden = datagram("\xCE\x1A\xBC\xDE\xF0"s, true, "\x01\x02\x03\x04\x05\x06\x07\x08"s);
  EXPECT_EQ(golden.size(), 164U);
  EXPECT_EQ(encoded(expected), golden);
  EXPECT_EQ(decoded(golden).value(), expected);
}

TEST(UdpDatagram, FdFrameOf64Bytes) {
  CanFrame expected = extended_frame(0x1ABCDEF0, {});
  expected.fd = true;
  expected.bit_rate_switch = true;
  expected.length = 64;
  expected.data.fill(0x5A);
  const std::string golden = datagram("\xCE\x1A\xBC\xDE\xF0"s, true, std::string(64, '\x5A'), true);
  EXPECT_EQ(encoded(expected), golden);
  EXPECT_EQ(decoded(golden).value(), expected);
}

TEST(UdpDatagram, TimestampIsABigEndianDouble) {
  const UdpDatagram result = encode_udp_datagram(frame(1, {}), 1.5);  // 0x3FF8000000000000
  const std::string expected = datagram("\x01"s, false, "", false, "\xCB\x3F\xF8\x00\x00\x00\x00\x00\x00"s);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(result.bytes.data()), result.size), expected);
}

TEST(UdpDatagram, MissingKeysHavePythonCansDefaults) {
  const auto result = decoded("\x81"s + key("arbitration_id") + "\x05"s);
  ASSERT_TRUE(result);
  EXPECT_EQ(*result, extended_frame(5, {}));
  EXPECT_EQ(decoded("\x80"s).value(), extended_frame(0, {}));
}

TEST(UdpDatagram, KeysMayComeInAnyOrderAndAnyEncoding) {
  // data as bin 16, dlc as uint 32, the key's text as str 8, the map as map 16.
  const std::string bytes = "\xDE\x00\x04"s + "\xD9\x04"s + "data" + "\xC5\x00\x02\xAA\xBB"s + key("dlc") +
                            "\xCE\x00\x00\x00\x02"s + key("is_extended_id") + "\xC2"s + key("arbitration_id") +
                            "\xD1\x01\x81"s;
  EXPECT_EQ(decoded(bytes).value(), frame(0x181, {0xAA, 0xBB}));
}

TEST(UdpDatagram, RemoteFrameHasALengthButNoData) {
  CanFrame expected = frame(0x123, {});
  expected.remote = true;
  expected.length = 4;
  EXPECT_EQ(decoded(encoded(expected)).value(), expected);
}

TEST(UdpDatagram, RefusesWhatPythonCanWouldRefuse) {
  EXPECT_EQ(decoded("\x81"s + key("colour") + "\x01"s).error(), "unknown key");
  EXPECT_EQ(decoded("\x81"s + key("is_extended_id") + "\x01"s).error(), "a flag is neither true nor false");
  EXPECT_EQ(decoded("\x82"s + key("is_extended_id") + "\xC2"s + key("arbitration_id") + "\xCD\x08\x00"s).error(),
            "the identifier is too large");
  EXPECT_EQ(decoded("\x81"s + key("arbitration_id") + "\xFF"s).error(), "the identifier or the length is no number");
  EXPECT_EQ(decoded("\x82"s + key("dlc") + "\x03"s + key("data") + "\xC4\x02\x01\x02"s).error(),
            "length and data do not match");
  EXPECT_EQ(decoded("\x82"s + key("dlc") + "\x09"s + key("data") + "\xC4\x09"s + std::string(9, 'x')).error(),
            "the length is beyond that of the kind of frame");
  EXPECT_EQ(decoded("\x81"s + key("bitrate_switch") + "\xC3"s).error(), "an FD flag on a classic frame");
  EXPECT_EQ(decoded("\x82"s + key("is_remote_frame") + "\xC3"s + key("is_fd") + "\xC3"s).error(),
            "a remote frame that is FD or an error");
}

TEST(UdpDatagram, RefusesBrokenMessagePack) {
  const std::string good = datagram("\xCD\x01\x81"s, false, "\x01\x02\x03\x04"s);
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(decoded(good.substr(0, size))) << size;
  EXPECT_EQ(decoded(good + "\x00"s).error(), "bytes behind the map");
  EXPECT_FALSE(decoded("\x90"s));
  EXPECT_FALSE(decoded("\xDF\xFF\xFF\xFF\xFF"s));
  EXPECT_FALSE(decoded("\x81"s + key("data") + "\xC6\xFF\xFF\xFF\xFF"s));
  EXPECT_FALSE(decoded("\x81"s + key("data") + "\x91\x01"s));
}

}  // namespace
}  // namespace cellmirror::can
