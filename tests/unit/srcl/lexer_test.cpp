#include "scripts/programs/srcl/lexer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace cellmirror::program::srcl;

std::vector<Token> tokens_of(std::string_view text) {
  Lexer sut(text);
  std::vector<Token> tokens;
  while (sut.token().kind != TokenKind::end_of_text) {
    tokens.push_back(sut.token());
    sut.advance();
  }
  return tokens;
}

TEST(SrclLexer, CutsALineIntoWordsNumbersAndSigns) {
  const auto tokens = tokens_of("lin P1_a*(2, 0.5)<=1E3");
  ASSERT_EQ(tokens.size(), 10U);
  EXPECT_EQ(tokens[0].keyword, Keyword::linear);
  EXPECT_EQ(tokens[1].kind, TokenKind::name);
  EXPECT_EQ(tokens[1].text, "P1_a");
  EXPECT_EQ(tokens[2].sign, Sign::times);
  EXPECT_EQ(tokens[4].integer, 2);
  EXPECT_EQ(tokens[5].sign, Sign::comma);
  EXPECT_EQ(tokens[6].real, 0.5);
  EXPECT_EQ(tokens[8].sign, Sign::less_equal);
  EXPECT_EQ(tokens[9].real, 1000.0);
}

TEST(SrclLexer, CountsLinesAndColumnsInBytes) {
  const auto tokens = tokens_of(
      "\xef\xbb\xbf"
      "PTP\r\n\n  A ; \xc3\xa4\nB");
  ASSERT_EQ(tokens.size(), 6U);
  EXPECT_EQ(tokens[0].column, 1U);
  EXPECT_EQ(tokens[3].text, "A");
  EXPECT_EQ(tokens[3].line, 3U);
  EXPECT_EQ(tokens[3].column, 3U);
  EXPECT_EQ(tokens[5].line, 4U);
}

TEST(SrclLexer, GoesOnInTheNextLineBehindAComma) {
  const auto tokens = tokens_of("A, ; one\n\n ; two\n B\nC");
  ASSERT_EQ(tokens.size(), 5U);
  EXPECT_EQ(tokens[2].text, "B");
  EXPECT_EQ(tokens[2].line, 4U);
  EXPECT_EQ(tokens[3].kind, TokenKind::end_of_line);
  EXPECT_EQ(tokens[4].line, 5U);
}

TEST(SrclLexer, GathersTheCommentsThatBeginWithPercent) {
  Lexer sut("A ; %ROBACT X ;\n; 50 % of it\n;%  B\n");
  while (sut.token().kind != TokenKind::end_of_text) sut.advance();
  ASSERT_EQ(sut.scripts().size(), 2U);
  EXPECT_EQ(sut.scripts()[0].text, "ROBACT X ;");
  EXPECT_EQ(sut.scripts()[0].column, 5U);
  EXPECT_EQ(sut.scripts()[1].text, "B");
  EXPECT_EQ(sut.scripts()[1].line, 3U);
}

TEST(SrclLexer, TellsNumbersThatAreNone) {
  for (const char* const text : {"12AB", "1E999", "9223372036854775808", "1E", "0x10", "1.5E+"}) {
    const auto tokens = tokens_of(text);
    EXPECT_EQ(tokens.front().kind, TokenKind::bad_number) << text;
  }
  EXPECT_EQ(tokens_of("9223372036854775807").front().integer, 9223372036854775807LL);
  EXPECT_EQ(tokens_of("5.").front().real, 5.0);
  EXPECT_EQ(tokens_of(".5").front().real, 0.5);
}

TEST(SrclLexer, KnowsEveryWordInAnyCase) {
  for (const KeywordRow& row : keyword_rows()) {
    std::string lower;
    for (const char c : row.word) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    EXPECT_EQ(find_keyword(row.word), row.keyword) << row.word;
    EXPECT_EQ(find_keyword(lower), row.keyword) << lower;
    EXPECT_EQ(find_keyword(lower + "_"), Keyword::none) << lower;
  }
  EXPECT_EQ(find_keyword(""), Keyword::none);
}

}  // namespace
