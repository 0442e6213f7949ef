// The thread that reads long programs, under ThreadSanitizer: the owner of the cell loads, holds, gives up and deletes
// programs, and reads short ones itself, while it reads.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/owner/programs/program_files.hpp"
#include "app/owner/programs/program_loads.hpp"
#include "scripts/programs/languages/languages.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror::app {
namespace {

constexpr std::array<std::string_view, 2> kRobots = {"A", "B"};
constexpr std::array<std::string_view, 4> kPrograms = {"good", "faulty", "missing", "codes"};

std::string long_program(std::string_view record, int records) {
  std::string text = "1, HEADER, long\n2, END_HEADER\n";
  for (int n = 10; n < records + 10; ++n) text += std::to_string(n) + ", " + std::string(record) + "\n";
  return text + "9999, END\n";
}

class ProgramLoadsConcurrency : public testing::Test {
 protected:
  static constexpr int kTurns = 600;
  static constexpr int kRecords = 400;

  void SetUp() override {
    folder_.write("programs/good.ird", long_program("DOUT, 1, ON", kRecords));
    folder_.write("programs/codes.ird", long_program("AOUT, 1, 2.5", kRecords));
    folder_.write("programs/faulty.ird", long_program("NONSENSE, 1", kRecords));
    folder_.write("programs/short.ird", long_program("DOUT, 1, ON", 3));
    home_ = std::make_unique<KismetHome>(*KismetHome::open(folder_.root()));
    loads_ =
        std::make_unique<ProgramLoads>([this](const program::Language& language, const std::filesystem::path& path) {
          return read_program(*home_, language, path);
        });
  }
  [[nodiscard]] std::filesystem::path path(std::string_view program) const {
    return folder_.root() / "programs" / (std::string(program) + ".ird");
  }
  void keep(Result<ActivityHandle> begun) {
    if (begun) activities_.push_back(*std::move(begun));
  }
  void finish(const ProgramLoads::Run& run) { run.activity->finish(); }
  void take() {
    while (auto ended = loads_->take()) {
      ++read_;
      ended->activity->finish();
      for (const ProgramLoads::Run& run : ended->runs) finish(run);
    }
  }
  // What the service does for a command, in any order.
  void act(std::string_view program, std::string_view robot) {
    const Error why{"told so", {}};
    switch (random_() % 10) {
      case 0:
        for (const ProgramLoads::Run& run : loads_->cancel(program, robot, why)) finish(run);
        return;
      case 1:
        loads_->give_up_runs(robot, why);
        return;
      case 2:
        loads_->give_up_queued_runs(robot, why);
        return;
      case 3:
        loads_->hold_runs(robot, random_() % 2 == 0);
        return;
      case 4:
        if (random_() % 4 == 0) loads_->give_up_robot(robot, why);
        return;
      case 5:
      case 6:
        if (loads_->has_to_wait(program, robot)) keep(loads_->add_run(program, robot, ProgramBegin::exec_wait));
        return;
      default:
        keep(loads_->begin(program, robot, irdata_, path(program)));
    }
  }

  TemporaryHome folder_;
  std::unique_ptr<KismetHome> home_;
  const program::Language& irdata_ = **program::find_language("irdata");
  std::unique_ptr<ProgramLoads> loads_;
  std::vector<ActivityHandle> activities_;
  std::mt19937 random_{20261122};
  int read_ = 0;
};

TEST_F(ProgramLoadsConcurrency, WhateverIsDoneWhileProgramsAreReadEverybodyIsAnswered) {
  for (int turn = 0; turn < kTurns; ++turn) {
    act(kPrograms[random_() % kPrograms.size()], kRobots[random_() % kRobots.size()]);
    ASSERT_TRUE(read_program(*home_, irdata_, path("short")).program);  // the owner reads short ones itself
    static_cast<void>(loads_->snapshots());
    take();
  }
  // Some are read to their end, however fast the owner was.
  for (const auto cancel = std::chrono::steady_clock::now() + std::chrono::seconds(60); read_ < 3;) {
    ASSERT_LT(std::chrono::steady_clock::now(), cancel);
    if (loads_->empty()) keep(loads_->begin("good", "A", irdata_, path("good")));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    take();
  }
  keep(loads_->begin("good", "A", irdata_, path("good")));
  loads_->give_up_all({"the gateway ends", {}});
  EXPECT_TRUE(loads_->empty());
  for (const ActivityHandle& activity : activities_) EXPECT_NE(activity->state(), Activity::State::running);
  loads_.reset();  // while it reads
}

}  // namespace
}  // namespace cellmirror::app
