// docs/languages/rapid.md tells every instruction, and its example is a program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "scripts/programs/rapid/parser.hpp"
#include "scripts/programs/rapid/rapid.hpp"

namespace {

using namespace cellmirror;

std::string page() {
  const char* const source = std::getenv("CELLMIRROR_SOURCE_DIR");
  std::ifstream file(std::string(source == nullptr ? "." : source) + "/docs/languages/rapid.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RapidPage, TellsEveryInstructionInItsTable) {
  const std::string sut = page();
  const std::size_t table = sut.find("## Instructions");
  ASSERT_NE(table, std::string::npos) << "the page is not there or has no instructions";
  for (const std::string_view word : program::rapid::Parser::instructions()) {
    EXPECT_NE(sut.find("`" + std::string(word), table), std::string::npos) << word;
  }
}

TEST(RapidPage, HasAnExampleThatIsAProgram) {
  const std::string sut = page();
  const std::size_t begin = sut.find("```\n") + 4;
  const std::string example = sut.substr(begin, sut.find("```", begin) - begin);
  ASSERT_GT(example.size(), 500U);
  Diagnostics findings;
  EXPECT_TRUE(program::rapid_language().parse(example, {"example.mod", {}}, findings)) << findings.text();
  EXPECT_EQ(findings.warnings(), 0U) << findings.text();
}

}  // namespace
