// docs/languages/srcl.md tells every word, and its example is a program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "scripts/programs/srcl/keywords.hpp"
#include "scripts/programs/srcl/srcl.hpp"

namespace {

using namespace cellmirror;

std::string page() {
  const char* const source = std::getenv("CELLMIRROR_SOURCE_DIR");
  std::ifstream file(std::string(source == nullptr ? "." : source) + "/docs/languages/srcl.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

bool has_word(const std::string& text, std::string_view word) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !in_word(text[at - 1])) && (end == text.size() || !in_word(text[end]))) return true;
  }
  return false;
}

TEST(SrclPage, TellsEveryWordInItsGrammarAndInItsTables) {
  const std::string sut = page();
  const std::size_t tables = sut.find("## Declarations");
  ASSERT_NE(tables, std::string::npos) << "the page is not there or has no declarations";
  for (const program::srcl::KeywordRow& row : program::srcl::keyword_rows())
    EXPECT_TRUE(has_word(sut.substr(tables), row.word)) << row.word;
}

TEST(SrclPage, HasAnExampleThatIsAProgram) {
  const std::string sut = page();
  const std::size_t begin = sut.find("```\n") + 4;
  const std::string example = sut.substr(begin, sut.find("```", begin) - begin);
  ASSERT_GT(example.size(), 500U);
  Diagnostics findings;
  EXPECT_TRUE(program::srcl_language().parse(example, {"example.src", {}}, findings)) << findings.text();
}

}  // namespace
