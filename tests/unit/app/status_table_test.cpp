#include "app/subcommands/status_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cellmirror::app {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kDocument = R"({
  "version":"0.1.0","instance":"default","cell":"demo","uptime_s":12.0,
  "loop":{"rate_hz":1000,"scheduler":"SCHED_OTHER","scheduler_note":"not permitted; run as root","memory_note":"","ticks":5,
          "missed":2,"wakeup_latency_us":{"p50":1,"p99":2,"p999":3,"max":4},"compute_us":{"p50":1,"p99":2,"p999":3,"max":4},
          "faults":1,"last_fault":"the loop stood still"},
  "robots":[{"id":"PUMA","mode":"mirrored","active":true,"sending":false,
    "stream":{"kind":"dds","endpoint":"domain 0","state":"stale","age_s":0.25,"rate_hz":100,"received":3,"lost":1,"rejected":2,
              "condition":"no publisher"},
    "joints":[{"name":"J_1","position":1.5707963267948966,"unit":"rad","state":"stale"},
              {"name":"J_2","position":0.25,"unit":"m","state":"fresh"}]}],
  "script":{"received":3,"done":2,"refused":1,"running":0,"language":"irdata","last_errors":["bad command"]},
  "messages":[{"text":"hello","age_s":1.5}],
  "queues":[{"name":"commands","dropped":0},{"name":"sensor","dropped":4}]})";

TEST(StatusTable, ShowsWhichRobotMovesAndHowManyMovesWait) {
  std::string text(kDocument);
  const std::string_view sending = R"("sending":false,)";
  text.insert(text.find(sending) + sending.size(), R"("motion":{"moving":true,"waiting":2},)");
  const auto table = status_table(text, false);
  ASSERT_TRUE(table);
  EXPECT_THAT(*table, HasSubstr("moving, 2 more"));
  EXPECT_THAT(*status_table(kDocument, false), Not(HasSubstr("moving")));
}

TEST(StatusTable, ShowsWhatIsStaleLateRefusedAndDropped) {
  const auto table = status_table(kDocument, false);
  ASSERT_TRUE(table);
  EXPECT_THAT(*table, HasSubstr("stale, age 250 ms"));
  EXPECT_THAT(*table, HasSubstr("J_1 90.00 deg (stale)"));
  EXPECT_THAT(*table, HasSubstr("J_2 250.0 mm "));
  EXPECT_THAT(*table, HasSubstr("no publisher"));
  EXPECT_THAT(*table, HasSubstr("not permitted; run as root"));
  EXPECT_THAT(*table, HasSubstr("fault: the loop stood still"));
  EXPECT_THAT(*table, HasSubstr("bad command"));
  EXPECT_THAT(*table, HasSubstr("sensor 4"));
}

TEST(StatusTable, TellsWhereARecordingIsInPlaceOfTheLoop) {
  std::string text(kDocument);
  text.insert(
      1, R"("replay":{"file":"day.mcap","state":"paused","now":"2026-11-24 13:01:08.384","position_s":9.5,"length_s":10,
                              "speed":0.5,"note":"a gap of 2 s"},)");
  const std::string table = *status_table(text, false);
  EXPECT_THAT(table, HasSubstr("replay    day.mcap: paused at 2026-11-24 13:01:08.384, 9.5 of 10.0 s, speed 0.5"));
  EXPECT_THAT(table, HasSubstr("a gap of 2 s"));
  EXPECT_THAT(table, Not(HasSubstr("loop 1000 Hz")));
}

TEST(StatusTable, AQueueThatNobodyReadsHasLostNothing) {
  std::string text(kDocument);
  const std::string_view queue = R"({"name":"sensor","dropped":4})";
  text.replace(text.find(queue), queue.size(), R"({"name":"sensor","dropped":825,"unread":825})");
  const std::string table = *status_table(text, false);
  EXPECT_THAT(table, HasSubstr("nothing dropped; nobody reads sensor"));
  EXPECT_THAT(table, Not(HasSubstr("825")));
  text.replace(text.find(R"("unread":825)"), 12, R"("unread":800)");
  EXPECT_THAT(*status_table(text, false), HasSubstr("dropped: sensor 25; nobody reads sensor"));
}

TEST(StatusTable, TellsJointsThatNothingGivesAndThoseBeyondTheirRange) {
  std::string text(kDocument);
  const std::string_view joint = R"({"name":"J_2","position":0.25,"unit":"m","state":"fresh"})";
  text.replace(text.find(joint), joint.size(),
               R"({"name":"J_2","position":0.25,"unit":"m","state":"fresh","range":[0,0.2],"beyond_range":true},
                  {"name":"J_3","position":0,"unit":"rad","state":"none","range":[-1,1],"beyond_range":false})");
  EXPECT_THAT(*status_table(text, false), HasSubstr("J_2 250.0 mm (beyond 0 .. 200 mm)"));
  EXPECT_THAT(*status_table(text, false), HasSubstr("J_3 0.00 deg (none)"));
  text.replace(text.find("mirrored"), 8, "simulated");
  EXPECT_THAT(*status_table(text, false), Not(HasSubstr("(none)")));
  EXPECT_THAT(*status_table(text, false), HasSubstr("(beyond 0 .. 200 mm)"));
}

TEST(StatusTable, TellsTheNewestErrorAndTheNodesOfAStreamInTrouble) {
  std::string text(kDocument);
  const std::string_view condition = R"("condition":"no publisher")";
  const auto with = [&](const std::string& counters, const std::string& is, const std::string& more) {
    std::string out = text;
    out.replace(out.find(condition), condition.size(), "\"condition\":\"" + is + "\"" + more);
    const std::string_view counted = R"("lost":1,"rejected":2)";
    return *status_table(out.replace(out.find(counted), counted.size(), counters), false);
  };
  const std::string details = R"x(,"details":{"bus":"active","node 3 (J_1)":"fault","last channel error":"broken"},)x"
                              R"("last_errors":["first","newest of all"])";
  const std::string bad = with(R"("lost":0,"rejected":2)", "node 3 (J_1): fault", details);
  EXPECT_THAT(bad, HasSubstr("    node 3 (J_1): fault\n    newest error: newest of all\n"));
  EXPECT_THAT(bad, Not(HasSubstr("first")));
  EXPECT_THAT(bad, Not(HasSubstr("bus: active")));
  EXPECT_THAT(
      with(R"("lost":1,"rejected":0)", "operational", R"(,"details":{"last channel error":"broken"},"last_errors":[])"),
      HasSubstr("    newest error: broken\n"));
  const std::string good = with(R"("lost":0,"rejected":0)", "operational", details);
  EXPECT_THAT(good, Not(HasSubstr("newest")));
  EXPECT_THAT(good, Not(HasSubstr("    node 3")));
}

TEST(StatusTable, ShowsRobotProgramsWithWhatTheyWaitForTheirTimesSignalsAndADeadlock) {
  std::string text(kDocument);
  text.insert(text.rfind('}'), R"(,"programs":{"loaded":[
    {"robot":"PUMA","program":"fetch","language":"srcl","file":"programs/fetch.src","state":"waiting","waits_for":"semaphore TABLE",
     "step":"line 12","line":12,"statements":20,"reversible":false,"direction":"forward","elapsed_s":12.34,"expected_s":45.67,
     "runs":2,"error":""},
    {"robot":"PUMA","program":"far","language":"irdata","file":"programs/far.ird","state":"failed","waits_for":"","step":"N40",
     "line":4,"statements":5,"reversible":false,"direction":"backward","elapsed_s":1.5,"expected_s":null,"runs":1,
     "error":"programs/far.ird:4:1: error: out of reach"}],
    "deadlock":{"text":"deadlock: PUMA fetch waits","waiting":[]},"semaphores":{"TABLE":0},
    "signals":[{"robot":"PUMA","inputs_on":[3,7],"outputs_on":[],"analogue_inputs":[],"analogue_outputs":[{"number":1,"value":2.5}]}],
    "loading":[{"robot":"PUMA","program":"long"}],
    "recordings":[{"robot":"PUMA","program":"taught","language":"jet_boom","points":4}],"failures":1,"last_failure":"x"})");
  const auto table = status_table(text, false);
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_THAT(*table, HasSubstr("programs  2 loaded, 1 failures"));
  EXPECT_THAT(*table, HasSubstr("fetch of PUMA  srcl waiting for semaphore TABLE, at line 12  12.3 of 45.7 s"));
  EXPECT_THAT(*table, HasSubstr("far of PUMA  irdata failed, backward, at N40  1.5 s"));
  EXPECT_THAT(*table, HasSubstr("programs/far.ird:4:1: error: out of reach"));
  EXPECT_THAT(*table, HasSubstr("loading long of PUMA"));
  EXPECT_THAT(*table, HasSubstr("recording taught of PUMA, 4 check points"));
  EXPECT_THAT(*table, HasSubstr("signals of PUMA:  inputs on 3 7  analogue outputs 1=2.5"));
  EXPECT_THAT(*table, HasSubstr("semaphores TABLE=0"));
  EXPECT_THAT(*table, HasSubstr("deadlock: PUMA fetch waits"));
  EXPECT_THAT(*status_table(kDocument, false), Not(HasSubstr("programs")));
}

TEST(StatusTable, ColoursOnlyWhereItIsAskedFor) {
  EXPECT_THAT(*status_table(kDocument, true), HasSubstr("\x1b[33mstale"));
  EXPECT_THAT(*status_table(kDocument, false), testing::Not(HasSubstr("\x1b")));
}

TEST(StatusTable, RefusesADocumentOfAnotherShape) {
  EXPECT_FALSE(status_table("{}", false));
  EXPECT_FALSE(status_table("not json", false));
}

}  // namespace
}  // namespace cellmirror::app
