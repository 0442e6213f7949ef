// Every folder beside this file: the bits of a foot-switch memory over time, the scripts of a home, and the expected
// row of what was told and executed. CELLMIRROR_UPDATE_GOLDEN=1 writes the rows anew: read the difference before
// committing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/footswitch/switch_edges.hpp"
#include "rt_core/base/log.hpp"
#include "scripts/runner/input_scripts.hpp"
#include "tests/golden/scripts/recording_host.hpp"

namespace cellmirror::script {
namespace {

namespace fs = std::filesystem;
using footswitch::SwitchEdge;
using footswitch::SwitchEdges;

constexpr Nanoseconds kPeriod{1'000'000};

fs::path golden_folder() {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return fs::path(source == nullptr ? "." : source) / "tests" / "golden" / "footswitch";
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> cases() {
  std::vector<std::string> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(golden_folder(), error)) {
    if (fs::exists(entry.path() / "timeline.txt")) all.push_back(entry.path().filename().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

// "debounce 10", "busy 20" (how often WAIT finds a robot moving) and "end 100", then lines of "<ms> <bytes in binary,
// bit 7 first>": from then on the memory holds these bytes.
struct Timeline {
  struct Row {
    int at_ms = 0;
    std::vector<std::uint8_t> bytes;
  };
  int debounce_ms = 0;
  int end_ms = 0;
  int busy = 0;
  std::vector<Row> rows;

  explicit Timeline(const fs::path& path) {
    std::istringstream text(content(path));
    for (std::string line; std::getline(text, line);) {
      std::istringstream words(line);
      std::string first;
      if (!(words >> first) || first.starts_with("#")) continue;
      if (first == "debounce") words >> debounce_ms;
      if (first == "end") words >> end_ms;
      if (first == "busy") words >> busy;
      if (std::isdigit(static_cast<unsigned char>(first.front())) == 0) continue;
      Row row{std::stoi(first), {}};
      for (std::string byte; words >> byte;)
        row.bytes.push_back(static_cast<std::uint8_t>(std::stoul(byte, nullptr, 2)));
      rows.push_back(std::move(row));
    }
  }
};

// A gateway's owner with a clock that stands still between the looks.
class Owner {
 public:
  explicit Owner(const fs::path& folder) : home_(*KismetHome::open(folder)), runner_(host.host(), home_, clock_) {}

  // A look at the bytes, and what the owner does within the same millisecond.
  void turn(SwitchEdges& edges, std::span<const std::uint8_t> bytes, int ms) {
    clock_.set(Timestamp{1'000'000'000} + ms * kPeriod);
    std::vector<SwitchEdge> found;
    edges.look(bytes, clock_.now(), found);
    for (const SwitchEdge& edge : found) {
      row += fmt::format("{:4} ms  input {} {}\n", ms, edge.input, edge.on ? "on" : "off");
      scripts.add({edge.input, edge.on, edge.not_told});
    }
    while (scripts.follow() || runner_.step(32) != 0) write_calls(ms);
    write_calls(ms);
  }

  [[nodiscard]] std::string end() const {
    const InputScripts::Counters& c = scripts.counters();
    return fmt::format("changes {}, started {}, missing {}, refused {}, dropped {}, with errors {}, waiting {}\n",
                       c.changes, c.started, c.missing, c.refused, c.dropped, c.with_errors, scripts.waiting());
  }

  cellmirror::testing::RecordingHost host;
  std::string row;

 private:
  void write_calls(int ms) {
    for (; written_ < host.calls.size(); ++written_) row += fmt::format("{:4} ms    {}\n", ms, host.calls[written_]);
  }

  KismetHome home_;
  ManualClock clock_;
  ScriptRunner runner_;
  std::size_t written_ = 0;

 public:
  InputScripts scripts{runner_, home_, clock_};
};

std::string run_case(const fs::path& folder) {
  const Timeline timeline(folder / "timeline.txt");
  Owner sut(folder);
  sut.host.busy_checks = timeline.busy;
  std::vector<std::uint8_t> bytes(timeline.rows.front().bytes.size());
  SwitchEdges edges(bytes.size(), timeline.debounce_ms * kPeriod);
  std::size_t next = 0;
  for (int ms = 0; ms <= timeline.end_ms; ++ms) {
    for (; next < timeline.rows.size() && timeline.rows[next].at_ms <= ms; ++next) bytes = timeline.rows[next].bytes;
    sut.turn(edges, bytes, ms);
  }
  return sut.row + sut.end() + fmt::format("bounces {}\n", edges.bounces());
}

class GoldenFootSwitch : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenFootSwitch, GivesTheExpectedRow) {
  set_log_level(LogLevel::error);
  const fs::path folder = golden_folder() / GetParam();
  const std::string row = run_case(folder);
  if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr)
    std::ofstream(folder / "expected.txt", std::ios::binary) << row;
  EXPECT_EQ(row, content(folder / "expected.txt"));
}

INSTANTIATE_TEST_SUITE_P(FootSwitches, GoldenFootSwitch, ::testing::ValuesIn(cases()),
                         [](const auto& test_case) { return test_case.param; });

TEST(GoldenFootSwitches, AreThere) { EXPECT_GE(cases().size(), 8U); }

// Thousands of changes of all inputs in random order, while the scripts lag behind: each runs once, none passes
// another.
TEST(FootSwitchesUnderLoad, EveryChangeRunsOnceInItsOrder) {
  const fs::path folder = golden_folder() / "all_eight_at_once";
  Owner sut(folder);
  SwitchEdges edges(1, Nanoseconds(0));
  std::mt19937 random(5);
  std::vector<std::uint8_t> bytes(1);
  std::string expected;
  std::uint8_t before = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    bytes[0] = ms == 0 ? 0 : static_cast<std::uint8_t>(random());
    for (unsigned bit = 0; bit < 8; ++bit) {
      const unsigned mask = 1U << bit;
      if (((bytes[0] ^ before) & mask) != 0)
        expected += fmt::format("show_message [{} {}]\n", bit + 1, (bytes[0] & mask) != 0 ? "on" : "off");
    }
    before = bytes[0];
    sut.turn(edges, bytes, ms);
  }
  EXPECT_EQ(sut.host.trace(), expected);
  EXPECT_GT(sut.scripts.counters().changes, 10'000U);
  EXPECT_EQ(sut.scripts.counters().started, sut.scripts.counters().changes);
}

TEST(FootSwitchesUnderLoad, TooManyWaitingChangesAreDroppedAndCounted) {
  set_log_level(LogLevel::error);
  Owner sut(golden_folder() / "slow_script");
  constexpr std::size_t kMore = 100;
  for (std::size_t i = 0; i < InputScripts::kMostWaiting; ++i) EXPECT_TRUE(sut.scripts.add({1, i % 2 == 0, {}}));
  for (std::size_t i = 0; i < kMore; ++i) EXPECT_FALSE(sut.scripts.add({1, true, {}}));
  EXPECT_EQ(sut.scripts.counters().dropped, kMore);
  sut.scripts.forget();
  EXPECT_EQ(sut.scripts.waiting(), 0U);
  EXPECT_EQ(sut.scripts.counters().dropped, kMore + InputScripts::kMostWaiting);
}

}  // namespace
}  // namespace cellmirror::script
