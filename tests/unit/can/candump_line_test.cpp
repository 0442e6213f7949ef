// Lines as candump -l writes them (can-utils).
#include "drivers/can/channel/candump_line.hpp"

#include <gtest/gtest.h>

#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

TEST(CandumpLine, ClassicFrame) {
  const auto line = parse_candump_line("(1436509052.249713) vcan0 044#2A366C2BBA");
  ASSERT_TRUE(line);
  EXPECT_EQ(line->time_ns, 1'436'509'052'249'713'000);
  EXPECT_EQ(line->interface, "vcan0");
  EXPECT_EQ(line->frame, frame(0x044, {0x2A, 0x36, 0x6C, 0x2B, 0xBA}));
  EXPECT_EQ(format_candump_line(line->time_ns, "vcan0", line->frame), "(1436509052.249713) vcan0 044#2A366C2BBA");
}

TEST(CandumpLine, ExtendedIdentifierHasEightDigits) {
  const auto line = parse_candump_line("(0000000001.000001) can0 00000123#");
  ASSERT_TRUE(line);
  EXPECT_EQ(line->frame, extended_frame(0x123, {}));
  EXPECT_EQ(format_candump_line(1'000'001'000, "can0", line->frame), "(0000000001.000001) can0 00000123#");
}

TEST(CandumpLine, FdFrameHasFlags) {
  CanFrame expected = extended_frame(0x1ABCDEF0, {0xDE, 0xAD, 0xBE, 0xEF});
  expected.fd = true;
  expected.bit_rate_switch = true;
  const std::string text = "(0000000001.000000) can0 1ABCDEF0##1DEADBEEF";
  EXPECT_EQ(parse_candump_line(text)->frame, expected);
  EXPECT_EQ(format_candump_line(1'000'000'000, "can0", expected), text);
  EXPECT_TRUE(parse_candump_line("(1.0) can0 123##300").value().frame.error_state_indicator);
}

TEST(CandumpLine, RemoteFrame) {
  CanFrame expected = frame(0x123, {});
  expected.remote = true;
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#R")->frame, expected);
  expected.length = 4;
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#R4")->frame, expected);
}

TEST(CandumpLine, ErrorFrameHasTheErrorFlagInItsIdentifier) {
  CanFrame expected = frame(0x004, {0, 0x0C, 0, 0, 0, 0, 0, 0});
  expected.error = true;
  const std::string text = "(0000000001.000000) can0 20000004#000C000000000000";
  EXPECT_EQ(parse_candump_line(text)->frame, expected);
  EXPECT_EQ(format_candump_line(1'000'000'000, "can0", expected), text);
}

TEST(CandumpLine, ToleratesWhatToolsAdd) {
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#11.22.33")->frame, frame(0x123, {0x11, 0x22, 0x33}));
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#1122 R\r")->frame, frame(0x123, {0x11, 0x22}));
  EXPECT_EQ(parse_candump_line("(1.0)  can0\t123#1122334455667788_F")->frame.length, 8);
}

TEST(CandumpLine, RefusesBrokenLinesWithTheReason) {
  EXPECT_EQ(parse_candump_line("").error(), "no time stamp as (1436509052.249713)");
  EXPECT_EQ(parse_candump_line("1.0 can0 123#").error(), "no time stamp as (1436509052.249713)");
  EXPECT_EQ(parse_candump_line("(99999999999.0) can0 123#").error(), "no time stamp as (1436509052.249713)");
  EXPECT_EQ(parse_candump_line("(1.0)").error(), "no name of an interface");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123").error(), "no # between identifier and data");
  EXPECT_EQ(parse_candump_line("(1.0) can0 1234#").error(), "the identifier has neither 3 nor 8 digits");
  EXPECT_EQ(parse_candump_line("(1.0) can0 12x#").error(), "the identifier is not hexadecimal");
  EXPECT_EQ(parse_candump_line("(1.0) can0 800#").error(), "the identifier is too large");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#123").error(), "an odd number of digits of data");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#1g").error(), "the data are not hexadecimal");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#112233445566778899").error(), "too many bytes of data");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123##").error(), "no flags behind ##");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#R9").error(), "the length of a remote frame is one digit from 0 to 8");
  EXPECT_EQ(parse_candump_line("(1.0) can0 123#11 junk").error(), "text behind the frame");
}

}  // namespace
}  // namespace cellmirror::can
