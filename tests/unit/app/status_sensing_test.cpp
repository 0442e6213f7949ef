// What status says of collisions and ranges, as JSON and in the table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/report/status_collisions.hpp"
#include "app/report/status_ranges.hpp"
#include "app/subcommands/status_table_sensing.hpp"

namespace cellmirror::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr Timestamp kMeasuredAt{10'000'000'000};
constexpr Timestamp kPosture{9'998'000'000};

CollisionReport report() {
  auto table = std::make_shared<collision::PairTable>();
  table->bodies.resize(3);
  table->triangles = 1234;
  table->rigid_pairs = 5;
  using enum collision::PairState;
  for (const auto state : {tested, rule_test, neighbours, never, never, always, rule_ignore})
    table->pairs.push_back({0, 1, state, {}});
  auto state = std::make_shared<ProximityState>();
  state->posture_time = kPosture;
  state->sequence = 42;
  state->names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"Arm.J1", "Box", "Wall"});
  TouchingPair touching;
  touching.b = 1;
  touching.depth_m = 0.0125;
  touching.contact_time = Timestamp{9'990'000'000};
  touching.point_m = {1, 2, 3};
  touching.points.push_back({{1, 2, 3}, {0, 0, 1}, 0.0125});
  state->touching.push_back(touching);
  NearPair contact;
  contact.b = 1;
  contact.within_warning = true;
  NearPair near;
  near.b = 2;
  near.distance_m = 0.04;
  near.within_warning = true;
  near.closing_speed_m_s = 0.2;
  near.time_to_contact_s = 0.2;
  near.doubtful = true;
  state->near = {contact, near};
  state->doubts = {"something is odd"};
  CollisionReport out;
  out.active = true;
  out.warning_distance_m = 0.05;
  out.state = state;
  out.pairs = table;
  out.events.push_back({7, ProximityChange::touched, "Arm.J1", "Box", 0.0, Timestamp{9'000'000'000}});
  LatencyHistogram ages;
  ages.record(Nanoseconds(2'000'000));
  out.age = ages.snapshot();
  return out;
}

TEST(StatusOfCollisions, TellsWhatIsTestedAndWhyTheOthersAreNot) {
  const json sut = collisions_json(report(), kMeasuredAt);
  EXPECT_EQ(sut["bodies"], 3);
  EXPECT_EQ(sut["triangles"], 1234);
  EXPECT_EQ(sut["pairs"]["tested"], 2);
  EXPECT_EQ(sut["pairs"]["left_out"],
            (json{{"rigid", 5}, {"neighbours", 1}, {"always", 1}, {"never", 2}, {"rule", 1}}));
}

TEST(StatusOfCollisions, TellsFindingsWithTheAgeOfTheirPosture) {
  const json sut = collisions_json(report(), kMeasuredAt);
  EXPECT_DOUBLE_EQ(sut["age_s"].get<double>(), 0.002);
  ASSERT_EQ(sut["touching"].size(), 1U);
  EXPECT_EQ(sut["touching"][0]["a"], "Arm.J1");
  EXPECT_EQ(sut["touching"][0]["depth_m"], 0.0125);
  EXPECT_DOUBLE_EQ(sut["touching"][0]["contact_age_s"].get<double>(), 0.01);
  EXPECT_EQ(sut["touching"][0]["points"][0]["normal"], (json{0.0, 0.0, 1.0}));
  EXPECT_EQ(sut["near"][1]["b"], "Wall");
  EXPECT_EQ(sut["near"][1]["time_to_contact_s"], 0.2);
  EXPECT_TRUE(sut["near"][0]["time_to_contact_s"].is_null());
  EXPECT_EQ(sut["nearest"]["distance_m"], 0.0);
  EXPECT_EQ(sut["events"][0]["change"], "touched");
  EXPECT_DOUBLE_EQ(sut["events"][0]["age_s"].get<double>(), 1.0);
  EXPECT_EQ(sut["doubts"][0], "something is odd");
  EXPECT_NEAR(sut["age_ms"]["p99"].get<double>(), 2.0, 0.05);
}

TEST(StatusOfCollisions, HasEveryKeyBeforeAnythingWasComputed) {
  CollisionReport nothing;
  nothing.note = "pairs are being derived";
  const json full = collisions_json(report(), kMeasuredAt);
  const json sut = collisions_json(nothing, kMeasuredAt);
  for (const auto& [key, value] : full.items()) EXPECT_TRUE(sut.contains(key)) << key;
  EXPECT_TRUE(sut["age_s"].is_null());
  EXPECT_TRUE(sut["nearest"].is_null());
  EXPECT_TRUE(sut["age_ms"]["p99"].is_null());
  EXPECT_EQ(sut["note"], "pairs are being derived");
}

TEST(StatusOfCollisions, StaysBoundedWhereVeryManyPairsTouch) {
  CollisionReport many = report();
  auto state = std::make_shared<ProximityState>(*many.state);
  state->touching.resize(5000);
  state->near.resize(5000);
  many.state = state;
  const json sut = collisions_json(many, kMeasuredAt);
  EXPECT_LT(sut["touching"].size(), 1000U);
  EXPECT_EQ(sut["touching_count"], 5000);
  EXPECT_EQ(sut["near_count"], 5000);
}

struct StatusOfRanges : testing::Test {
  StatusOfRanges() {
    auto cell = std::make_shared<CompiledCell>();
    cell->paths = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"", "Arm.USS", "Bed.USS"});
    SensorDefinition on;
    on.active = true;
    cell->sensors = {{"USS", 1, on}, {"USS", 2, SensorDefinition{}}};
    cell_state.cell = cell;
    cell_state.range_send_mode = RangeSendMode::one_message_for_all;
    auto readings = std::make_shared<RangeReadings>();
    readings->posture_time = kPosture;
    RangeReading reading;
    reading.id = "USS";
    reading.path = "Arm.USS";
    reading.posture_time = kPosture;
    reading.distance_m = 0.75;
    reading.point_m = {1, 2, 3};
    reading.object = "Box";
    readings->readings.push_back(reading);
    reading.path = "Bed.USS";  // it was switched off since
    readings->readings.push_back(reading);
    BarrierReading gate;
    gate.name = "gate";
    gate.posture_time = kPosture;
    gate.interrupted = true;
    gate.interruptions = 2;
    gate.object = "Cell.Arm.hand";
    gate.short_object = "Arm.hand";
    BarrierReading door;
    door.name = "door";
    door.posture_time = kPosture;
    readings->barriers = {gate, door};
    ranges.readings = readings;
  }
  CellState cell_state;
  RangeReport ranges;
};

TEST_F(StatusOfRanges, TellsTheReadingsOfActiveSensorsByPath) {
  const json sut = ranges_json(ranges, cell_state, kMeasuredAt);
  EXPECT_EQ(sut["sendmode"], 1);
  ASSERT_EQ(sut["sensors"].size(), 2U);
  EXPECT_EQ(sut["sensors"][0]["path"], "Arm.USS");
  EXPECT_EQ(sut["sensors"][0]["distance_m"], 0.75);
  EXPECT_EQ(sut["sensors"][0]["object"], "Box");
  EXPECT_DOUBLE_EQ(sut["sensors"][0]["age_s"].get<double>(), 0.002);
  EXPECT_FALSE(sut["sensors"][1]["active"].get<bool>());
  EXPECT_TRUE(sut["sensors"][1]["distance_m"].is_null());
  EXPECT_TRUE(sut["sensors"][1]["age_s"].is_null());
}

TEST_F(StatusOfRanges, TellsLightBarriers) {
  const json sut = ranges_json(ranges, cell_state, kMeasuredAt);
  ASSERT_EQ(sut["light_barriers"].size(), 2U);
  EXPECT_EQ(sut["light_barriers"][0]["interruptions"], 2);
  EXPECT_EQ(sut["light_barriers"][0]["object_short"], "Arm.hand");
  EXPECT_TRUE(sut["light_barriers"][1]["object_short"].is_null());
  const std::string table = sensing_table({{"ranges", sut}});
  EXPECT_THAT(table, HasSubstr("gate: interrupted by Arm.hand, 2 interruptions"));
  EXPECT_THAT(table, HasSubstr("door: free, 0 interruptions"));
}

TEST_F(StatusOfRanges, TableShowsTouchesNearPairsAndReadings) {
  const json status = {{"collisions", collisions_json(report(), kMeasuredAt)},
                       {"ranges", ranges_json(ranges, cell_state, kMeasuredAt)}};
  const std::string sut = sensing_table(status);
  EXPECT_THAT(sut, HasSubstr("on of 3 bodies, 2 pairs tested"));
  EXPECT_THAT(sut, HasSubstr("TOUCH Arm.J1 - Box: 12.5 mm deep"));
  EXPECT_THAT(sut, HasSubstr("Arm.J1 - Wall: 40.0 mm (doubtful), contact in 0.20 s"));
  EXPECT_THAT(sut, HasSubstr("doubt: something is odd"));
  EXPECT_THAT(sut, HasSubstr("1.0 s ago touched: Arm.J1 - Box"));
  EXPECT_THAT(sut, HasSubstr("USS: 750.0 mm to Box"));
  EXPECT_EQ(sensing_table(json::object()), "") << "a gateway that is older than this program";
}

}  // namespace
}  // namespace cellmirror::app
