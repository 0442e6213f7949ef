// Every SCRIPT file of good/ and bad/ against the committed trace of what the gateway was asked to do and what was
// found. CELLMIRROR_UPDATE_GOLDEN=1 writes the traces anew: read the difference before committing it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "rt_core/base/home.hpp"
#include "rt_core/base/log.hpp"
#include "scripts/lang/reader.hpp"
#include "scripts/runner/script_runner.hpp"
#include "tests/golden/scripts/recording_host.hpp"

namespace cellmirror::script {
namespace {

namespace fs = std::filesystem;

fs::path golden_folder() {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  std::error_code error;
  return fs::canonical(fs::path(source == nullptr ? "." : source) / "tests" / "golden" / "scripts", error);
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Case {
  std::string kind;  // good, bad
  std::string name;
};

void PrintTo(const Case& test_case, std::ostream* out) { *out << test_case.kind << "/" << test_case.name; }

// Files whose name begins with "called_" are called by others and are no cases of their own.
std::vector<Case> cases() {
  std::vector<Case> all;
  std::error_code error;
  for (const std::string kind : {"good", "bad"}) {
    for (const auto& entry : fs::directory_iterator(golden_folder() / kind / "scripts", error)) {
      const std::string name = entry.path().stem().string();
      if (entry.path().extension() == ".spt" && !name.starts_with("called_")) all.push_back({kind, name});
    }
  }
  std::sort(all.begin(), all.end(), [](const Case& a, const Case& b) { return a.kind + a.name < b.kind + b.name; });
  return all;
}

class GoldenScript : public ::testing::TestWithParam<Case> {};

// A good script does everything that it says.
std::string run_script(const Case& test_case, bool& clean) {
  const fs::path home_folder = golden_folder() / test_case.kind;
  const auto home = KismetHome::open(home_folder);
  if (!home) return home.error().text();
  cellmirror::testing::RecordingHost gateway;
  const SystemClock clock;
  std::string out;
  const auto run_ended = [&](const RunReport& report) {
    clean = report.diagnostics.all().empty();
    out = fmt::format("done {}, refused {}\n{}", report.counters.done, report.counters.refused,
                      report.diagnostics.text());
  };
  ScriptRunner runner(gateway.host(), *home, clock, {.run_ended = run_ended});
  Diagnostics findings;
  if (!runner.start_file(test_case.name, &findings)) {
    clean = false;
    return "nothing of it ran\n" + findings.text();
  }
  while (runner.step(1000) != 0) {
  }
  if (!runner.idle()) out += "still waiting\n";
  return gateway.trace() + out;
}

// The place of the checkout is no part of the expectation.
std::string without_place(std::string text) {
  const std::string place = golden_folder().string();
  for (std::size_t at = text.find(place); at != std::string::npos; at = text.find(place))
    text.replace(at, place.size(), "GOLDEN");
  return text;
}

TEST_P(GoldenScript, GivesTheExpectedTrace) {
  set_log_level(LogLevel::error);
  bool clean = true;
  const std::string trace = without_place(run_script(GetParam(), clean));
  const fs::path expected = golden_folder() / GetParam().kind / "expected" / (GetParam().name + ".txt");
  if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr) std::ofstream(expected, std::ios::binary) << trace;
  EXPECT_EQ(trace, content(expected)) << expected;
  EXPECT_EQ(clean, GetParam().kind == "good") << trace;
}

INSTANTIATE_TEST_SUITE_P(Scripts, GoldenScript, ::testing::ValuesIn(cases()),
                         [](const auto& param_info) { return param_info.param.kind + "_" + param_info.param.name; });

}  // namespace
}  // namespace cellmirror::script
