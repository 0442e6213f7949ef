#include "ipc/wire/script_message.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>

namespace cellmirror {
namespace {

using namespace std::string_literals;
using namespace std::string_view_literals;

ScriptEnvelope parsed(std::string_view message) { return parse_script_message({message.data(), message.size()}); }

TEST(ScriptMessage, PlainCommandAsksForNoReply) {
  const auto sut = parsed("ROBACT PUMA_762");
  EXPECT_EQ(sut.tag, 0);
  EXPECT_EQ(sut.text.value(), "ROBACT PUMA_762");
}

TEST(ScriptMessage, WholeBuffersOfCProgramsAreUnderstood) {
  for (const auto message : {"DRAW_SCENE\0"sv, "DRAW_SCENE\n\0"sv, "DRAW_SCENE\r\n"sv, "  DRAW_SCENE\t"sv,
                             "DRAW_SCENE\0\xFF\xFEjunk of an old buffer"sv}) {
    EXPECT_EQ(parsed(message).text.value(), "DRAW_SCENE");
  }
}

TEST(ScriptMessage, LineBreaksWithinStay) { EXPECT_EQ(parsed("POS_ROB\nR1").text.value(), "POS_ROB\nR1"); }

TEST(ScriptMessage, TypographicDashIsText) {
  EXPECT_EQ(parsed("POS_ROB R JOINT_INC \xE2\x80\x93"
                   "5")
                .text.value(),
            "POS_ROB R JOINT_INC \xE2\x80\x93"
            "5");
}

TEST(ScriptMessage, TagIsTakenOff) {
  const auto sut = parsed("@4711 ROBACT R\n\0"sv);
  EXPECT_EQ(sut.tag, 4711);
  EXPECT_EQ(sut.text.value(), "ROBACT R");
  EXPECT_EQ(parsed("@1 X").tag, 1);
  EXPECT_EQ(parsed("@2147483647 X").tag, 2147483647);
  EXPECT_EQ(parsed("  @007   X").tag, 7);
}

TEST(ScriptMessage, UnreadableTagsAreRefusedWithoutAReply) {
  for (const auto message : {"@ X", "@0 X", "@-1 X", "@+1 X", "@2147483648 X", "@99999999999999999999999 X", "@x X",
                             "@ 1 X", "@@1 X", "@1X", "@1@ X", "@0x10 X"}) {
    const auto sut = parsed(message);
    EXPECT_EQ(sut.tag, 0) << message;
    EXPECT_FALSE(sut.text) << message;
  }
}

TEST(ScriptMessage, SenderWithATagIsToldWhatIsWrong) {
  EXPECT_EQ(parsed("@5").tag, 5);
  EXPECT_FALSE(parsed("@5").text);
  EXPECT_EQ(parsed("@5  \n").tag, 5);
  const auto sut = parsed("@5 ROB\x01");
  EXPECT_EQ(sut.tag, 5);
  ASSERT_FALSE(sut.text);
  EXPECT_NE(sut.text.error().what.find("byte 7"), std::string::npos) << sut.text.error().what;
}

TEST(ScriptMessage, EmptyTextIsRefused) {
  for (const auto message : {""sv, "\0"sv, " \n"sv, "\0DRAW_SCENE"sv}) EXPECT_FALSE(parsed(message).text);
}

TEST(ScriptMessage, WhatIsNoUtf8OrControlsATerminalIsRefused) {
  for (const auto message : {"A\x80"sv, "A\xC0\xAF"sv, "A\xED\xA0\x80"sv, "A\xF4\x90\x80\x80"sv, "A\xE2\x80"sv,
                             "A\xFF"sv, "A\x1B[2J"sv, "A\x7F"sv, "A\xC2\x9B"sv, "A\x08"sv}) {
    EXPECT_FALSE(parsed(message).text);
  }
}

TEST(ScriptMessage, LengthIsBounded) {
  EXPECT_TRUE(parsed(std::string(8192, 'A')).text);
  EXPECT_FALSE(parsed(std::string(8193, 'A')).text);
  const auto sut = parsed("@9 " + std::string(8190, 'A'));
  EXPECT_EQ(sut.tag, 9) << "the sender of a message that is too long is told";
  EXPECT_FALSE(sut.text);
}

// Printable ASCII can hardly come out of 8,192 bytes at random.
TEST(ScriptMessage, NoiseIsRefused) {
  std::mt19937 random(20);
  for (int i = 0; i < 200; ++i) {
    std::string noise(8192, '\0');
    for (char& c : noise) c = static_cast<char>(random() & 0xFFu);
    const auto sut = parsed(noise);
    // A NUL early on may leave a short text; what is accepted is clean.
    if (sut.text) {
      EXPECT_LT(sut.text->size(), 16u);
    }
  }
  std::string noise(8192, '\0');
  for (char& c : noise) c = static_cast<char>(1 + random() % 255);
  EXPECT_FALSE(parsed(noise).text);
}

TEST(ScriptMessageText, IsWhatTheReceiverReads) {
  EXPECT_EQ(script_message_text(0, "ROBACT R"), "ROBACT R");
  EXPECT_EQ(script_message_text(17, "ROBACT R"), "@17 ROBACT R");
}

TEST(ReplyText, HasThreeForms) {
  EXPECT_EQ(reply_text({true, ""}), "done");
  EXPECT_EQ(reply_text({true, "3 robots"}), "done 3 robots");
  EXPECT_EQ(reply_text({false, "unknown robot X"}), "refused unknown robot X");
}

TEST(ReplyText, IsCleanAndBounded) {
  EXPECT_EQ(reply_text({false,
                        "a\x1B"
                        "b\0c\xFF\nd"s}),
            "refused a b c?\nd");
  std::string cents;
  for (int i = 0; i < 5000; ++i) cents += "\xC2\xA2";
  const std::string sut = reply_text({true, cents});
  EXPECT_LE(sut.size(), kMaxReplyBytes);
  EXPECT_GE(sut.size(), kMaxReplyBytes - 1);
  EXPECT_EQ(sut.size() % 2, 1u) << "done and a blank, then whole characters";
}

TEST(ParseReply, ReadsWhatReplyTextWrites) {
  for (const ScriptReply& reply : {ScriptReply{true, ""}, ScriptReply{true, "text"}, ScriptReply{false, "why"},
                                   ScriptReply{true, "done"}, ScriptReply{false, " two blanks"}}) {
    const std::string text = reply_text(reply);
    EXPECT_EQ(parse_reply({text.data(), text.size()}), reply);
  }
}

TEST(ParseReply, RefusesWhatIsNoReply) {
  for (const auto text : {""sv, "doner"sv, "Done"sv, "ok"sv, "refusedX"sv, "\0done"sv}) {
    EXPECT_FALSE(parse_reply({text.data(), text.size()})) << text;
  }
}

}  // namespace
}  // namespace cellmirror
