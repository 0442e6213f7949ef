// Every program of <language>/good and <language>/bad against its committed trace or diagnostics.
// CELLMIRROR_UPDATE_GOLDEN=1 writes them anew: read the difference before committing it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scripts/programs/languages/languages.hpp"
#include "tests/golden/programs/trace_run.hpp"

namespace cellmirror::program {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastCases = 25;  // good ones, and bad ones, of each language

fs::path golden_folder() {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return fs::path(source == nullptr ? "." : source) / "tests" / "golden" / "programs";
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Case {
  std::string language;
  std::string kind;  // good, bad
  std::string name;
  [[nodiscard]] fs::path folder() const { return golden_folder() / language / kind / name; }
};

void PrintTo(const Case& test_case, std::ostream* out) { *out << test_case.folder().string(); }

std::vector<Case> cases_of(const std::string& language, const std::string& kind) {
  std::vector<Case> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(golden_folder() / language / kind, error)) {
    if (entry.is_directory()) all.push_back({language, kind, entry.path().filename().string()});
  }
  std::sort(all.begin(), all.end(), [](const Case& a, const Case& b) { return a.name < b.name; });
  return all;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Language& language : languages()) {
    for (const char* kind : {"good", "bad"}) {
      const auto some = cases_of(std::string(language.name), kind);
      all.insert(all.end(), some.begin(), some.end());
    }
  }
  return all;
}

fs::path program_file(const Case& test_case) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(test_case.folder(), error)) {
    if (entry.path().stem() == "program") return entry.path();
  }
  return {};
}

struct Outcome {
  bool ok = false;
  std::string text;
};

Outcome trace_of(const Case& test_case, const fs::path& file) {
  const auto language = find_language(test_case.language);
  if (!language) return {false, language.error().text()};
  Diagnostics diagnostics;
  ParseContext context{.file = file.filename().string(), .codes = content(test_case.folder() / "codes.tsv")};
  const auto program = (*language)->parse(content(file), context, diagnostics);
  EXPECT_EQ(program == nullptr, !diagnostics.ok()) << "a program there is where there are no errors";
  if (program != nullptr) program->check_for(testing::golden_joints(), diagnostics);
  std::string text = diagnostics.text();
  if (!text.empty() && text.back() != '\n') text += '\n';
  if (!diagnostics.ok() || program == nullptr) return {false, text};
  return {true, text + testing::golden_trace(program, content(test_case.folder() / "inputs.txt"))};
}

class GoldenProgram : public ::testing::TestWithParam<Case> {};

TEST_P(GoldenProgram, GivesTheExpectedTrace) {
  const bool good = GetParam().kind == "good";
  const fs::path file = program_file(GetParam());
  ASSERT_FALSE(file.empty()) << "no program in " << GetParam().folder();
  EXPECT_FALSE(content(GetParam().folder() / "why.txt").empty()) << "why.txt says what the case is for";
  const Outcome outcome = trace_of(GetParam(), file);
  const fs::path expected = GetParam().folder() / (good ? "trace.txt" : "diagnostics.txt");
  if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr) std::ofstream(expected, std::ios::binary) << outcome.text;
  EXPECT_EQ(outcome.ok, good) << outcome.text;
  EXPECT_EQ(outcome.text, content(expected)) << expected;
}

INSTANTIATE_TEST_SUITE_P(Programs, GoldenProgram, ::testing::ValuesIn(cases()), [](const auto& param_info) {
  return param_info.param.language + "_" + param_info.param.kind + "_" + param_info.param.name;
});

TEST(GoldenPrograms, AreEnoughOfEachLanguage) {
  for (const Language& language : languages()) {
    for (const char* kind : {"good", "bad"}) {
      EXPECT_GE(cases_of(std::string(language.name), kind).size(), kLeastCases) << language.name << " " << kind;
    }
  }
}

}  // namespace
}  // namespace cellmirror::program
