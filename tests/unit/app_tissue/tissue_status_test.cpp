// What status, its table and the monitor page say of deformable objects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/report/live_tissue.hpp"
#include "app/report/status_tissue.hpp"
#include "app/subcommands/status_table_tissue.hpp"
#include "tests/unit/app_tissue/sample_report.hpp"

namespace cellmirror::app {
namespace {

using nlohmann::json;
using test::kNow;
using test::sample_cell;
using test::sample_report;
using testing::HasSubstr;
using testing::Not;

json status_of(const TissueReport& report) {
  return tissue_json(std::make_shared<const TissueReport>(report), sample_cell(), kNow);
}

std::string table_of(const json& tissue) { return tissue_table(json{{"tissue", tissue}}); }

json live_of(const TissueReport* report) {
  JsonWriter out;
  out.begin_object();
  add_tissue(out, report, sample_cell(), kNow);
  return json::parse(out.end_object().take()).at("tissue");
}

TEST(StatusOfTissue, IsNullWithoutDeformableObjects) {
  EXPECT_TRUE(tissue_json(nullptr, sample_cell(), kNow).is_null());
  EXPECT_EQ(table_of(nullptr), "");
  EXPECT_EQ(tissue_table(json::object()), "") << "an older gateway";
  EXPECT_TRUE(live_of(nullptr).is_null());
}

TEST(StatusOfTissue, TellsTheStepAndTheObjects) {
  const json sut = status_of(sample_report());
  EXPECT_EQ(sut["calculating"], true);
  EXPECT_EQ(sut["network_shown"], true);
  EXPECT_EQ(sut["step"], 77);
  EXPECT_DOUBLE_EQ(sut["age_s"], 0.002);
  EXPECT_EQ(sut["rate_hz"], 999);
  EXPECT_EQ(sut["late_steps"], 5);
  EXPECT_NEAR(sut["step_us"]["p99"].get<double>(), 250, 4);
  EXPECT_EQ(sut["simd"], "AVX2");
  const json liver = sut["objects"].at(0);
  EXPECT_EQ(liver["name"], "liver");
  EXPECT_EQ(liver["nodes"], 2200);
  EXPECT_EQ(liver["elements"], 10'050);
  EXPECT_EQ(liver["elements_at_start"], 10'000);
  EXPECT_EQ(liver["substeps"], 2);
  EXPECT_EQ(liver["added_mass_share"], 0.015);
  EXPECT_EQ(liver["contacts"], 3);
  EXPECT_EQ(liver["inverted"], 1);
  EXPECT_EQ(liver["parts"], 2);
  EXPECT_EQ(liver["attributes"], (json{"CALCULATE", "CUT", "WET"}));
}

TEST(StatusOfTissue, NamesInstrumentsVesselsAndEvents) {
  const json sut = status_of(sample_report());
  EXPECT_EQ(sut["instruments"].at(0)["robot"], "GRASPER");
  EXPECT_EQ(sut["instruments"].at(0)["kind"], "gripper");
  EXPECT_EQ(sut["instruments"].at(0)["held"], 6);
  EXPECT_EQ(sut["instruments"].at(0)["force_n"], (json{3, 0, -4}));
  EXPECT_EQ(sut["vessels"].at(0), (json{{"object", "liver"},
                                        {"name", "cystic_artery"},
                                        {"kind", "artery"},
                                        {"clips", 2},
                                        {"severed", true},
                                        {"bleeding_ml_min", 12.5}}));
  EXPECT_EQ(sut["vessels"].at(1)["kind"], "vein");
  EXPECT_EQ(sut["events"]["counts"]["clip"], 1);
  EXPECT_EQ(sut["events"]["counts"].size(), kTissueEventWords.size());
  const json clip = sut["events"]["last"].at(1);
  EXPECT_EQ(clip["number"], 2);
  EXPECT_EQ(clip["kind"], "clip");
  EXPECT_EQ(clip["robot"], "GRASPER");
  EXPECT_EQ(clip["object"], "liver");
  EXPECT_EQ(clip["part"], "cystic_artery");
  EXPECT_TRUE(clip["limit"].is_null());
  EXPECT_EQ(clip["at_m"], (json{0.125, -0.5, 1}));
  EXPECT_DOUBLE_EQ(clip["age_s"], 2.5);
}

TEST(StatusOfTissue, LimitsAreAsScriptHasSetThemWithWhatWentBeyond) {
  const json sut = status_of(sample_report());
  EXPECT_EQ(sut["limits"].at(2),
            (json{{"limit", "CONTACT_FORCE"}, {"value", 8}, {"actions", {"COUNT", "REPORT"}}, {"excesses", 7}}));
  EXPECT_EQ(sut["limits"].at(3),
            (json{{"limit", "GRIP_FORCE"}, {"value", 1}, {"actions", {"COUNT", "CLAMP"}}, {"excesses", 0}}))
      << "as at the start";
  EXPECT_EQ(sut["limits"].at(5),
            (json{{"limit", "STRAIN"}, {"value", nullptr}, {"actions", json::array()}, {"excesses", 0}}));
  EXPECT_EQ(sut["effects"]["PULSE"], true);
  EXPECT_EQ(sut["effects"]["BLEEDING"], false);
  EXPECT_EQ(sut["pool"], (json{{"level_m", 0.002}, {"blood", 0.1}}));
  TissueReport dry = sample_report();
  dry.state.pool_present = false;
  EXPECT_TRUE(status_of(dry)["pool"].is_null());
}

TEST(StatusOfTissue, NumbersWithoutANameAreEmpty) {
  TissueReport report = sample_report();
  report.state.events = {test::tissue_event(3, TissueEventKind::bleed)};
  report.state.events[0].instrument = -1;
  report.state.events[0].object = 9;
  const json event = status_of(report)["events"]["last"].at(0);
  EXPECT_EQ(event["robot"], "");
  EXPECT_EQ(event["object"], "");
}

TEST(StatusOfTissue, TableShowsWhatHappensAndWhatWasDone) {
  const std::string table = table_of(status_of(sample_report()));
  EXPECT_THAT(table, HasSubstr("tissue  calculating, 999 Hz, 5 late steps; step p50 25"));
  EXPECT_THAT(table, HasSubstr("(AVX2)"));
  EXPECT_THAT(table,
              HasSubstr("  liver: 2200 nodes, 10050 elements, 1500.0 ml, 3 contacts, 2 substeps, 1.5 % mass added, "
                        "2 parts, 2.0 % coagulated, 1 INVERTED\n"));
  EXPECT_THAT(table, HasSubstr("  GRASPER gripper acting, 5.00 N, holds 6 points\n"));
  EXPECT_THAT(table, HasSubstr("  artery cystic_artery of liver: 2 clips, severed, BLEEDS 12.5 ml/min\n"));
  EXPECT_THAT(table, Not(HasSubstr("portal_vein"))) << "nothing has happened to it";
  EXPECT_THAT(table,
              HasSubstr("bleeding 12.5 ml/min, 3.2 ml lost, pool +2.0 mm, 10 % blood, smoke 50 %, lens fogged 25 %, "
                        "1 of 4 connections torn, effects PULSE, beyond limits: CONTACT_FORCE 7\n"));
  EXPECT_THAT(table, HasSubstr("  2.5 s ago clip GRASPER cystic_artery liver at (125.0, -500.0, 1000.0) mm\n"));
}

TEST(StatusOfTissue, TableSaysThatNothingIsCalculatedAndNoMoreThanThereIs) {
  TissueReport report = sample_report();
  report.state = TissueState{};
  report.state.calculating = false;
  const std::string table = table_of(status_of(report));
  EXPECT_THAT(table, HasSubstr("NOT calculating (eladyn_calc off)"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 2) << table;
}

TEST(LiveTissue, TellsWhatThePanelShows) {
  const TissueReport report = sample_report();
  const json sut = live_of(&report);
  EXPECT_EQ(sut["network_shown"], true);
  EXPECT_NEAR(sut["step_p99_us"].get<double>(), 250, 4);
  EXPECT_EQ(sut["objects"].at(0)["nodes"], 2200);
  EXPECT_EQ(sut["objects"].at(0)["frozen"], false);
  EXPECT_DOUBLE_EQ(sut["instruments"].at(0)["force_n"], 5);
  EXPECT_EQ(sut["vessels"].at(0)["bleeding_ml_min"], 12.5);
  EXPECT_EQ(sut["events"].at(1)["part"], "cystic_artery");
  EXPECT_EQ(sut["events"].at(1)["limit"], "");
  EXPECT_EQ(sut["effects"]["PULSE"], true);
  EXPECT_EQ(sut["excesses"], 7);
  EXPECT_EQ(sut["pool_level_m"], 0.002);
}

TEST(LiveTissue, StaysSmall) {
  TissueReport report = sample_report();
  report.state.objects.resize(500, report.state.objects.front());
  report.state.vessels.resize(500, report.state.vessels.front());
  report.state.events.clear();
  for (std::uint64_t i = 1; i <= 64; ++i) report.state.events.push_back(test::tissue_event(i, TissueEventKind::cut));
  const json sut = live_of(&report);
  EXPECT_EQ(sut["objects"].size(), 50U);
  EXPECT_EQ(sut["vessels"].size(), 50U);
  ASSERT_EQ(sut["events"].size(), 12U);
  EXPECT_EQ(sut["events"].back()["number"], 64) << "the newest are kept";
}

}  // namespace
}  // namespace cellmirror::app
