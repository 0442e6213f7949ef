// TF_LOAD of a long program and what waits for it. What is read comes to the service in follow() only, so everything
// before that meets a program that is being loaded.
#include "app/owner/programs/program_service.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/owner/motion/guarded_motion.hpp"
#include "app/owner/programs/program_motion.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "scripts/programs/languages/languages.hpp"
#include "tests/unit/app/transfer_cell.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror::app {
namespace {

// `first`: before some thousand records that are jumped over.
std::string program_that_is_read_aside(std::string_view first = {}) {
  std::string text = fmt::format("1, HEADER, long\n2, END_HEADER\n{}5, JUMP, last\n", first);
  constexpr int kRecords = 2000;
  for (int n = 10; n < kRecords + 10; ++n) text += fmt::format("{}, DOUT, 1, ON\n", n);
  return text + "5000, LABEL, last\n5001, DOUT, 7, ON\n5002, END\n";
}

class ProgramDeskTest : public testing::Test {
 protected:
  static constexpr std::string_view kArm = "PUMA_762";
  static constexpr std::string_view kArmNode = "Puma";

  void SetUp() override {
    set_log_level(LogLevel::error);
    folder_.write("programs/long.ird", program_that_is_read_aside());
    folder_.write("programs/other.ird", program_that_is_read_aside());
    folder_.write("programs/short.ird", "1, HEADER, short\n2, END_HEADER\n3, DOUT, 7, ON\n4, END\n");
    folder_.write("programs/waits.ird", "1, HEADER, waits\n2, END_HEADER\n3, WAIT_INPUT, 3, ON\n4, END\n");
    auto home = KismetHome::open(folder_.root());
    ASSERT_TRUE(home);
    home_.emplace(*std::move(home));
    parts_ = std::make_unique<Gateway>(transfer_cell(), *home_, events_);
  }

  [[nodiscard]] ProgramService& sut() { return parts_->programs; }
  ActivityHandle load(std::string_view program) {
    auto loaded = sut().load_program(program, kArm);
    EXPECT_TRUE(loaded) << loaded.error().text();
    return loaded.value_or(nullptr);
  }
  ActivityHandle run(std::string_view program, ProgramBegin begin = ProgramBegin::now) {
    auto accepted = sut().run_program(program, kArm, begin);
    EXPECT_TRUE(accepted) << accepted.error().text();
    return accepted.value_or(nullptr);
  }
  void follow() { parts_->follow(); }
  void follow_until_all_is_read() {
    constexpr std::chrono::seconds kObserverTimeout{60};
    const auto cancel = std::chrono::steady_clock::now() + kObserverTimeout;
    while (!sut().snapshot().loading.empty()) {
      ASSERT_LT(std::chrono::steady_clock::now(), cancel);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      follow();
    }
    for (int turn = 0; turn < 10; ++turn) follow();
  }
  [[nodiscard]] bool happened(std::string_view event) const {
    return std::ranges::find(events_, event) != events_.end();
  }
  static void expect_refused(const ActivityHandle& activity, std::string_view why) {
    ASSERT_NE(activity, nullptr);
    EXPECT_EQ(activity->state(), Activity::State::refused);
    EXPECT_NE(activity->error().text().find(why), std::string::npos) << activity->error().text();
  }
  static void expect_done(const ActivityHandle& activity) {
    ASSERT_NE(activity, nullptr);
    EXPECT_EQ(activity->state(), Activity::State::done) << activity->error().text();
  }

  // What the owner of the cell has, and the tick, driven by hand.
  struct Gateway {
    Gateway(Cell with, const KismetHome& home, std::vector<std::string>& events)
        : cell(std::move(with)),
          display({cell, names, home, clock, [this] { return fleet.positions(); }, {}, {}, {}}, {}),
          programs({.cell = cell,
                    .home = home,
                    .fleet = fleet,
                    .motion = motion,
                    .display = display,
                    .moves = moves,
                    .clock = clock,
                    .event =
                        [&events](const program::ProgramEvent& event) {
                          events.push_back(std::string(name_of(event.kind)) + " " + event.program);
                        },
                    .read_aside = true}) {
      EXPECT_TRUE(fleet.follow_cell());
      follow();
    }
    void follow() {
      clock.advance(Nanoseconds(1'000'000));
      CycleContext context;
      context.now = context.scheduled = clock.now();
      context.cycle = cycle++;
      context.period = Nanoseconds(1'000'000);
      engine->run(context);
      motion.follow();
      programs.follow();
    }

    Cell cell;
    ManualClock clock;
    NoNames names;
    Watchdog watchdog{std::chrono::seconds(1), {}};
    std::unique_ptr<engine::Engine> engine = std::make_unique<engine::Engine>(watchdog);
    Fleet fleet{cell, *engine, {}, clock, 0};
    MotionService motion{cell, names, [] { return Eigen::Matrix3d::Identity().eval(); }, fleet, clock};
    CellProgramMotion moves{cell, motion, fleet, clock};
    DisplayService display;
    ProgramService programs;
    struct NobodyFollows final : CoupledRobots {
      [[nodiscard]] std::uint16_t coupled_joints(std::string_view /*robot*/) const override { return 0; }
      [[nodiscard]] std::string_view master_of(std::string_view /*robot*/) const override { return {}; }
    } nobody;
    ControllerService controllers{{.cell = cell,
                                   .fleet = fleet,
                                   .motion = motion,
                                   .coupled = nobody,
                                   .moving_program = {},
                                   .clock = clock,
                                   .controllers = {},
                                   .wake = {},
                                   .make_endpoint = {}}};
    GuardedMotion guarded{motion, programs, controllers};
    std::uint64_t cycle = 0;
  };

  TemporaryHome folder_;
  std::optional<KismetHome> home_;
  std::vector<std::string> events_;
  std::unique_ptr<Gateway> parts_;
};

TEST_F(ProgramDeskTest, AnUnknownProgramIsAnsweredWithTheNearestOnes) {
  const auto refused = sut().load_program("shrot", kArm);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("did you mean short?"), std::string::npos) << refused.error().text();
}

TEST_F(ProgramDeskTest, RunsALongProgramWhenItIsRead) {
  const auto loaded = load("long");
  const auto begun = run("long");
  follow_until_all_is_read();
  expect_done(loaded);
  expect_done(begun);
  EXPECT_TRUE(happened("ended long"));
}

TEST_F(ProgramDeskTest, ADeadlockFailsWhoWaitsOnlyWhileItLasts) {
  folder_.write("programs/takes.ird",
                "1, HEADER, takes\n2, SEMAPHORE, table, 0\n3, END_HEADER\n4, ACQUIRE, table\n5, END\n");
  folder_.write("programs/gives.ird",
                "1, HEADER, gives\n2, SEMAPHORE, table, 0\n3, END_HEADER\n4, RELEASE, table\n5, END\n");
  const std::uint64_t before = sut().failures();
  load("takes");
  run("takes");
  follow();
  parts_->clock.advance(program::Controllers::kGrace);
  follow();
  EXPECT_FALSE(sut().busy());
  EXPECT_FALSE(sut().verdict(before));
  constexpr std::string_view kOther = "MANTEC_R3";
  ASSERT_TRUE(sut().load_program("gives", kOther));
  ASSERT_TRUE(sut().run_program("gives", kOther, ProgramBegin::now));
  EXPECT_TRUE(sut().busy()) << "it may end now";
  for (int turn = 0; turn < 10; ++turn) follow();
  EXPECT_TRUE(happened("ended takes"));
  EXPECT_FALSE(sut().busy());
  EXPECT_TRUE(sut().verdict(before));
}

TEST_F(ProgramDeskTest, StopRobEndsWhatWaitsUntilItIsLoaded) {
  const auto loaded = load("long");
  const auto begun = run("long");
  EXPECT_TRUE(parts_->guarded.stop(kArm));
  expect_refused(begun, "long was not started: stopped by STOP_ROB");
  follow_until_all_is_read();
  expect_done(loaded);
  EXPECT_FALSE(happened("started long"));
}

TEST_F(ProgramDeskTest, StopRobEndsTheProgramThatRunsAndWhatWaitsUntilItIsLoaded) {
  load("waits");
  run("waits");
  follow();
  load("long");
  const auto begun = run("long", ProgramBegin::exec_wait);
  EXPECT_TRUE(parts_->guarded.stop(kArm));
  expect_refused(begun, "STOP_ROB");
  follow_until_all_is_read();
  EXPECT_TRUE(happened("stopped waits"));
  EXPECT_FALSE(happened("started long"));
}

TEST_F(ProgramDeskTest, WhatWaitsUntilItIsLoadedBeginsHeldAfterTfHold) {
  load("long");
  const auto begun = run("long");
  EXPECT_TRUE(sut().hold_program(kArm));
  follow_until_all_is_read();
  expect_done(begun);
  ASSERT_EQ(sut().controllers().status().size(), 1U);
  EXPECT_EQ(sut().controllers().status()[0].state, program::ProgramState::held);
  EXPECT_FALSE(happened("ended long"));
  EXPECT_TRUE(sut().resume_program(kArm));
  for (int turn = 0; turn < 10; ++turn) follow();
  EXPECT_TRUE(happened("ended long"));
}

TEST_F(ProgramDeskTest, WhatWaitsBehindOneThatIsHeldBeginsHeldInItsPlace) {
  folder_.write("programs/other.ird", program_that_is_read_aside() + "5003, OOPS\n");
  load("other");
  run("other");
  EXPECT_TRUE(sut().hold_program(kArm));
  load("long");
  run("long", ProgramBegin::exec_wait);
  follow_until_all_is_read();
  EXPECT_TRUE(happened("held long"));
  EXPECT_FALSE(happened("ended long"));
}

TEST_F(ProgramDeskTest, TfResumeTakesTfHoldBackBeforeTheProgramBegins) {
  load("long");
  run("long");
  EXPECT_FALSE(sut().resume_program(kArm));
  EXPECT_TRUE(sut().hold_program(kArm));
  EXPECT_TRUE(sut().resume_program(kArm));
  follow_until_all_is_read();
  EXPECT_FALSE(happened("held long"));
  EXPECT_TRUE(happened("ended long"));
}

TEST_F(ProgramDeskTest, ARobotThatGoesOnlineEndsWhatWaitsUntilItIsLoaded) {
  const auto loaded = load("long");
  const auto begun = run("long");
  sut().cancel(kArm, {"the robot PUMA_762 went online", {}});
  expect_refused(begun, "went online");
  follow_until_all_is_read();
  expect_done(loaded);
  EXPECT_FALSE(happened("started long"));
}

TEST_F(ProgramDeskTest, ADeletedRobotTakesWhatIsBeingLoadedForItAlong) {
  const auto loaded = load("long");
  const auto begun = run("long");
  ASSERT_TRUE(parts_->cell.delete_node(kArmNode));
  sut().follow_cell();
  expect_refused(loaded, "PUMA_762 was deleted");
  expect_refused(begun, "PUMA_762 was deleted");
  EXPECT_TRUE(sut().snapshot().loading.empty());
}

TEST_F(ProgramDeskTest, TfDeleteOfAProgramThatRunsIsRefusedWhileItIsBeingLoadedAnew) {
  load("waits");
  run("waits");
  follow();
  folder_.write("programs/waits.ird", program_that_is_read_aside());
  const auto loaded = load("waits");
  const auto deleted = sut().delete_program("waits", kArm);
  ASSERT_FALSE(deleted);
  EXPECT_NE(deleted.error().text().find("runs or is queued"), std::string::npos) << deleted.error().text();
  // What is refused changes nothing: the file is read, and it is known by then whether the program still runs.
  EXPECT_EQ(loaded->state(), Activity::State::running);
  ASSERT_TRUE(sut().stop_programs(kArm));
  EXPECT_TRUE(sut().delete_program("waits", kArm));
  expect_refused(loaded, "TF_DELETE");
  EXPECT_TRUE(sut().controllers().status().empty());
}

TEST_F(ProgramDeskTest, TfDeleteKeepsTheOrderOfRunsThatStillWait) {
  load("short");
  load("long");
  load("other");
  const auto first = run("long");
  const auto second = run("other", ProgramBegin::exec_wait);
  const auto third = run("short", ProgramBegin::exec_wait);
  EXPECT_TRUE(sut().delete_program("other", kArm));
  expect_refused(second, "TF_DELETE");
  EXPECT_EQ(third->state(), Activity::State::running);
  follow_until_all_is_read();
  expect_done(first);
  expect_done(third);
  const auto ended = std::ranges::find(events_, "ended long");
  EXPECT_NE(std::find(ended, events_.end(), "started short"), events_.end());
}

TEST_F(ProgramDeskTest, TfDeleteOfTheLastThatWasWaitedForBeginsTheOthers) {
  load("short");
  load("other");
  run("other");
  const auto behind = run("short", ProgramBegin::exec_wait);
  EXPECT_TRUE(sut().delete_program("other", kArm));
  expect_done(behind);
}

// Fails on its first move.
constexpr const char* kFails = "1, HEADER, fails\n2, END_HEADER\n3, LIN, POSE(9999999, 0, 0, 0, 0, 0)\n4, END\n";

TEST_F(ProgramDeskTest, TfWaitTellsWhyTheFirstProgramFailedAndNotThatThoseBehindItDidNotStart) {
  folder_.write("programs/fails.ird", kFails);
  load("fails");
  load("short");
  run("fails");
  run("short", ProgramBegin::exec_wait);
  const auto awaited = sut().await_programs(kArm);
  ASSERT_TRUE(awaited) << awaited.error().text();
  for (int turn = 0; turn < 10; ++turn) follow();
  EXPECT_TRUE(happened("failed short"));
  expect_refused(*awaited, "fails.ird:3:");
}

// However far it has been read by then.
TEST_F(ProgramDeskTest, WhatIsQueuedBehindAProgramThatFailsDoesNotStartWhenItIsLoadedLater) {
  folder_.write("programs/fails.ird", kFails);
  load("fails");
  const auto loaded = load("long");
  run("fails");
  const auto queued = run("long", ProgramBegin::exec_wait);
  follow_until_all_is_read();
  expect_done(loaded);
  EXPECT_TRUE(happened("failed fails"));
  EXPECT_FALSE(happened("started long"));
  EXPECT_NE(queued->state(), Activity::State::running);
}

TEST(ProgramLoads, WhatIsQueuedBehindAProgramThatFailsIsRefusedUpToTheNextThatIsStartedAnew) {
  ProgramLoads sut([](const program::Language& /*language*/, const std::filesystem::path& /*path*/) {
    return ProgramText{fail("is not looked at"), {}};
  });
  const program::Language& language = **program::find_language("irdata");
  for (const char* name : {"first", "second", "third"}) ASSERT_TRUE(sut.begin(name, "R", language, {}));
  ASSERT_TRUE(sut.begin("first", "Q", language, {}));
  const ActivityHandle first = *sut.add_run("first", "R", ProgramBegin::exec_wait);
  const ActivityHandle second = *sut.add_run("second", "R", ProgramBegin::exec_wait);
  const ActivityHandle anew = *sut.add_run("second", "R", ProgramBegin::now);
  const ActivityHandle behind = *sut.add_run("third", "R", ProgramBegin::exec_wait);
  const ActivityHandle other = *sut.add_run("first", "Q", ProgramBegin::exec_wait);
  sut.give_up_queued_runs("R", {"runs before it has failed", {}});
  for (const ActivityHandle& refused : {first, second}) ASSERT_EQ(refused->state(), Activity::State::refused);
  EXPECT_EQ(second->error().text(), "second was not started: runs before it has failed");
  for (const ActivityHandle& kept : {anew, behind, other}) EXPECT_EQ(kept->state(), Activity::State::running);
  sut.give_up_queued_runs("R", {"another before it has failed", {}});
  EXPECT_EQ(behind->state(), Activity::State::running);
}

}  // namespace
}  // namespace cellmirror::app
