// The summary of a cell as a document: written, read, and what a hostile one does.
#include "ipc/wire/cell_summary_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror {
namespace {

CellSummary full_summary() {
  CellSummary out;
  out.cell = "welding";
  out.host = "cell-7";
  out.instance = "default";
  out.run = "18a-77";
  out.sequence = 12;
  out.time_ns = 1'764'000'000'000'000'001;
  out.uptime_s = 3600.5;
  out.health = CellHealth::attention;
  out.reasons = {"R1: stale"};
  out.loop = {1000, 3, 1, true};
  out.robots = {{"R1", true, DataState::stale, 0.25}, {"R2", false, DataState::none, {}}};
  out.robots_left_out = 2;
  out.nearest = NearestPair{{"R1.hand", "TABLE"}, 0.0125};
  out.touching = 1;
  out.touching_pairs = {{"R2.hand", "POST"}};
  out.alarms = {2, 1};
  out.page_port = 8420;
  return out;
}

TEST(CellSummaryText, HasTheMembersOfTheDocumentation) {
  EXPECT_EQ(cell_summary_text(full_summary()),
            R"({"cellmirror_summary":1,"cell":"welding","host":"cell-7","instance":"default","run":"18a-77",)"
            R"("sequence":12,"time_ns":1764000000000000001,"uptime_s":3600.5,"replay":false,"health":"attention",)"
            R"("reasons":["R1: stale"],"loop":{"rate_hz":1000,"on_time":true,"missed":3,"faults":1},)"
            R"("robots":[{"id":"R1","mode":"mirrored","state":"stale","age_s":0.250},{"id":"R2","mode":"simulated"}],)"
            R"("robots_left_out":2,"nearest":{"bodies":["R1.hand","TABLE"],"distance_m":0.0125},"touching":1,)"
            R"("touching_pairs":[["R2.hand","POST"]],"alarms":{"active":2,"unacknowledged":1},"page_port":8420})");
}

TEST(CellSummaryText, IsReadAsItWasWritten) {
  const auto read = parse_cell_summary(cell_summary_text(full_summary()));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(*read, full_summary());
}

TEST(CellSummaryText, StaysWithinItsLimitWhateverTheNamesAre) {
  CellSummary large = full_summary();
  const std::string worst(4000, '\x01');  // six bytes each in JSON
  large.cell = large.host = large.instance = large.run = worst;
  large.reasons.assign(100, worst);
  large.touching_pairs.assign(100, {worst, worst});
  large.robots.assign(500, {worst, true, DataState::implausible, 1e9});
  const std::string text = cell_summary_text(large);
  EXPECT_LE(text.size(), kMostSummaryBytes);
  const auto read = parse_cell_summary(text);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->robots.size() + read->robots_left_out, 502U);
  EXPECT_EQ(read->reasons.size(), kMostSummaryReasons);
}

TEST(CellSummaryText, ADocumentOfANewerVersionIsReadAsFarAsItIsKnown) {
  const auto read = parse_cell_summary(
      R"({"cellmirror_summary": 7, "cell": "x", "health": "superb", "robots": [{"id": "R", "mode": "dreaming"}, 3],
          "loop": "fast", "touching": -1, "touching_pairs": [["a"], ["a", "b"]], "more": {"deep": [1]}})");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->version, 7);
  EXPECT_EQ(read->health, CellHealth::attention);  // a word that nobody knows does not say that all is well
  ASSERT_EQ(read->robots.size(), 1U);
  EXPECT_FALSE(read->robots[0].mirrored);
  EXPECT_EQ(read->touching, 0U);
  EXPECT_EQ(read->touching_pairs, (std::vector<BodyPair>{{"a", "b"}}));
}

TEST(CellSummaryText, WhatIsNoSummaryIsRefusedWithTheReason) {
  const auto why = [](std::string_view text) {
    const auto read = parse_cell_summary(text);
    return read ? std::string() : read.error().what;
  };
  EXPECT_NE(why("").find("not a JSON object"), std::string::npos);
  EXPECT_NE(why("[1, 2]").find("not a JSON object"), std::string::npos);
  EXPECT_NE(why(R"({"cell": "x"})").find("cellmirror_summary"), std::string::npos);
  EXPECT_NE(why(R"({"cellmirror_summary": 0, "cell": "x"})").find("cellmirror_summary"), std::string::npos);
  EXPECT_NE(why(R"({"cellmirror_summary": 1, "cell": ""})").find("without the name"), std::string::npos);
  EXPECT_NE(why(std::string(kMostSummaryBytes + 1, ' ')).find("the limit is"), std::string::npos);
  EXPECT_NE(why(std::string(kMostSummaryBytes, '[')).find("not a JSON object"), std::string::npos);
}

TEST(CellSummaryNews, AgesTimesAndCountersAreNoNews) {
  CellSummary next = full_summary();
  next.sequence = 99;
  next.time_ns += 500'000'000;
  next.uptime_s += 0.5;
  next.robots[0].age_s = 0.75;
  next.loop.missed = 44;
  next.nearest->distance_m = 0.5;
  EXPECT_FALSE(has_news(full_summary(), next));
}

TEST(CellSummaryNews, HealthRobotsContactsAndAlarmsAre) {
  const auto changed = [](auto change) {
    CellSummary next = full_summary();
    change(next);
    return has_news(full_summary(), next);
  };
  EXPECT_TRUE(changed([](CellSummary& next) { next.health = CellHealth::fault; }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.robots[0].state = DataState::lost; }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.robots[1].mirrored = true; }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.robots.pop_back(); }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.touching = 2; }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.touching_pairs[0].a = "R3"; }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.alarms.unacknowledged = 0; }));
  EXPECT_TRUE(changed([](CellSummary& next) { next.loop.on_time = false; }));
}

}  // namespace
}  // namespace cellmirror
