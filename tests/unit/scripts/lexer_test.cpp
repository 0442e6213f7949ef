// How text is cut into commands and words.
#include "scripts/lang/lexer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scripts/lang/values.hpp"
#include "tests/unit/scripts/test_text.hpp"

namespace cellmirror::script {
namespace {

std::vector<FormId> forms_in(std::string_view text) {
  std::vector<FormId> forms;
  CommandReader reader(text, "file.spt", TextKind::file);
  ParsedCommand command;
  Diagnostics findings;
  for (;;) {
    const CommandReader::Step step = reader.next(nullptr, command, findings);
    if (step == CommandReader::Step::end) break;
    if (step == CommandReader::Step::command) forms.push_back(command.id());
  }
  EXPECT_TRUE(findings.ok()) << findings.text();
  return forms;
}

Token token(std::string_view text) {
  Token word;
  Lexer lexer(text);
  EXPECT_TRUE(lexer.word(word));
  return word;
}

using Forms = std::vector<FormId>;

TEST(Lexer, EndsCommandsAtSemicolonsAndAtTheEndOfTheText) {
  EXPECT_EQ(forms_in("DRAW_SCENE;WAIT ; DRAW_SCENE"), (Forms{FormId::draw_scene, FormId::wait, FormId::draw_scene}));
}

TEST(Lexer, ReadsCommandsOverSeveralLinesWithAnyLineEnd) {
  EXPECT_EQ(forms_in("CONNECT\r\n a\r\n\r\nTO\tb\r\n;\r\nWAIT\r\n"), (Forms{FormId::connect, FormId::wait}));
}

TEST(Lexer, PassesOverCommentLinesBetweenAndWithinCommands) {
  EXPECT_EQ(forms_in("# a; b\nCONNECT a\n# TO c;\nTO b;\n#\n#WAIT;\n"), Forms{FormId::connect});
}

TEST(Lexer, PassesOverFormatTagOnTheFirstLineOnly) {
  EXPECT_EQ(forms_in("RBv01r01\nWAIT;"), Forms{FormId::wait});
  EXPECT_EQ(forms_in("\xef\xbb\xbfRBv01r01\r\nWAIT;"), Forms{FormId::wait});
  EXPECT_EQ(findings_of_file("WAIT;\nRBv01r01\nWAIT;").size(), 1U);
}

TEST(Lexer, PassesOverEmptyCommandsOfAFile) {
  EXPECT_EQ(forms_in(";;\n;WAIT;;"), Forms{FormId::wait});
  EXPECT_EQ(forms_in(""), Forms{});
  EXPECT_EQ(forms_in("\n\n  "), Forms{});
}

TEST(Lexer, CountsLinesAndColumnsFromOne) {
  Lexer sut("ab cd\n  ef");
  Token word;
  ASSERT_TRUE(sut.word(word));
  EXPECT_EQ(word.begin.line, 1);
  EXPECT_EQ(word.begin.column, 1);
  EXPECT_TRUE(word.first_in_line);
  ASSERT_TRUE(sut.word(word));
  EXPECT_EQ(word.begin.column, 4);
  EXPECT_FALSE(word.first_in_line);
  ASSERT_TRUE(sut.word(word));
  EXPECT_EQ(word.begin.line, 2);
  EXPECT_EQ(word.begin.column, 3);
  EXPECT_TRUE(word.first_in_line);
  EXPECT_FALSE(sut.word(word));
}

TEST(Lexer, CommentIsOnlyAHashInTheFirstColumn) {
  EXPECT_EQ(findings_of_file("WAIT; # no comment\n").size(), 1U);
  EXPECT_EQ(findings_of_file(" # no comment\n;").size(), 1U);
}

TEST(Lexer, MessageMayBeACommentAndMayEndWithSemicolonAndNul) {
  Diagnostics findings;
  ParsedCommand command;
  CommandReader comment("# a remark", "message", TextKind::message);
  EXPECT_EQ(comment.next(nullptr, command, findings), CommandReader::Step::comment);
  CommandReader with_nul(std::string_view("WAIT;\0\0", 7), "message", TextKind::message);
  EXPECT_EQ(with_nul.next(nullptr, command, findings), CommandReader::Step::command);
  EXPECT_EQ(with_nul.next(nullptr, command, findings), CommandReader::Step::end);
  EXPECT_TRUE(findings.ok());
}

std::string text_of_message(std::string_view message) {
  Diagnostics findings;
  ParsedCommand command;
  CommandReader reader(message, "message", TextKind::message);
  if (reader.next(nullptr, command, findings) != CommandReader::Step::command) return "refused: " + findings.text();
  EXPECT_EQ(reader.next(nullptr, command, findings), CommandReader::Step::end);
  return std::string(command.text(0));
}

// No ';' delimits a message (manual 1.1): those within a text belong to it.
TEST(Lexer, TextOfAMessageIsAllOfItsRest) {
  EXPECT_EQ(text_of_message("hot_message Ready; go"), "Ready; go");
  EXPECT_EQ(text_of_message("hot_message Ready; go;"), "Ready; go") << "one at the end is tolerated";
  EXPECT_EQ(text_of_message("hot_message Ready ; ; "), "Ready ;");
  EXPECT_EQ(text_of_message("hot_message ;Ready"), ";Ready");
  EXPECT_NE(text_of_message("hot_message ;").find("the text is missing"), std::string::npos);
  EXPECT_NE(text_of_message("WAIT; hot_message Ready").find("more text after the command"), std::string::npos);
}

TEST(Lexer, InAFileASemicolonEndsTheTextAndWhatFollowsIsToldWhy) {
  const auto findings = findings_of_file("hot_message Ready; go;\nhot_message on; hot_message off;");
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].message, "there is no command go");
  EXPECT_EQ(findings[0].remedy, "in a file a ';' ends the text of hot_message: leave it out of the text");
}

TEST(Lexer, TextTooLargeIsRefusedAsAWhole) {
  const std::string text(kMaxScriptBytes + 1, ' ');
  EXPECT_EQ(findings_of_file(text).size(), 1U);
}

TEST(Numbers, AreDecimalOrExponent) {
  EXPECT_EQ(number_of(token("12")), 12.0);
  EXPECT_EQ(number_of(token("+1.5")), 1.5);
  EXPECT_EQ(number_of(token(".5")), 0.5);
  EXPECT_EQ(number_of(token("5.")), 5.0);
  EXPECT_EQ(number_of(token("1.507E-03")), 0.001507);
  for (const char* text : {"", "1e", "--1", "+-1", "1.2.3", "0x10", "nan", "-inf", "infinity", "1_000", "1'0"})
    EXPECT_FALSE(number_of(Token{.text = text, .begin = {}})) << text;
}

TEST(Numbers, TakeTypographicDashesForMinus) {
  for (const char* dash : {"\xe2\x80\x92", "\xe2\x80\x93", "\xe2\x80\x94", "\xe2\x88\x92", "\x96", "\x97"}) {
    EXPECT_EQ(number_of(token(std::string(dash) + "78.5")), -78.5);
    EXPECT_EQ(number_of(token("2e" + std::string(dash) + "3")), 0.002);
    EXPECT_FALSE(number_of(token(std::string(dash) + dash + "1")));
  }
  EXPECT_FALSE(number_of(token("\xe2\x80\x93" + std::string(100, '1'))));
}

TEST(Numbers, WholeOnesMayBeHexadecimal) {
  EXPECT_EQ(integer_of(token("0x51D")), 1309.0);
  EXPECT_EQ(integer_of(token("-3")), -3.0);
  EXPECT_FALSE(integer_of(token("1.0")));
  EXPECT_FALSE(integer_of(token("0x")));
  EXPECT_FALSE(integer_of(token("9223372036854775808")));
  EXPECT_FALSE(integer_of(token("9007199254740993")));  // no double holds it exactly
}

TEST(JoinedLines, MakesOneLineOfSeveral) {
  EXPECT_EQ(joined_lines("a  b"), "a  b");
  EXPECT_EQ(joined_lines("a\n  b \r\n\n# comment; c\n # d"), "a b # d");
  EXPECT_EQ(joined_lines(""), "");
}

}  // namespace
}  // namespace cellmirror::script
