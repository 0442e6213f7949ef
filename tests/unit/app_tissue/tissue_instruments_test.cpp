// Commands that concern an instrument: what triggers it, its cylinders, its clip, and suction and irrigation at its
// tip.
#include <fmt/format.h>

#include <numbers>

#include "tests/unit/app_tissue/tissue_desk.hpp"

namespace cellmirror::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct TissueInstrumentCommands : TissueDesk {
  const TissueInstrumentSettings& instrument(std::string_view robot) {
    for (const TissueInstrumentSettings& known : settings().instruments) {
      if (known.robot == robot) return known;
    }
    ADD_FAILURE() << "no settings of " << robot;
    static const TissueInstrumentSettings none;
    return none;
  }
};

TEST_F(TissueInstrumentCommands, EachTestTriggersWhereTheManualSays) {
  struct Row {
    int test;
    double q_true;
    double q_false;
  };
  // Joint 3, JAW, in degrees: 10 and 20.
  for (const Row& row : {Row{1, 10, 9.9}, {2, 9.9, 10}, {3, 20, 20.1}, {3, 10, 9.9}, {4, 9.9, 10}, {4, 20.1, 20}}) {
    do_it(fmt::format("rob_ela_interact 3 {} 10 20 2", row.test));
    const tissue::InstrumentAction& action = last<tissue::SetInstrumentAction>().action;
    EXPECT_EQ(last<tissue::SetInstrumentAction>().instrument, static_cast<int>(slot("LEFT")));
    EXPECT_EQ(action.kind, InstrumentKind::scissors);
    EXPECT_EQ(action.joint, 2);
    EXPECT_TRUE(action.triggered(row.q_true * kDegree)) << row.test;
    EXPECT_FALSE(action.triggered(row.q_false * kDegree)) << row.test;
    EXPECT_EQ(instrument("LEFT").action->test, action.test);
  }
  do_it("rob_ela_interact 3 0 10 20 2");
  EXPECT_EQ(last<tissue::SetInstrumentAction>().action.test, InstrumentTest::off);
  EXPECT_FALSE(last<tissue::SetInstrumentAction>().action.triggered(15 * kDegree));
}

TEST_F(TissueInstrumentCommands, EachInstrumentHasTheManualsNumber) {
  do_it("ela_clip_def clip.mpo 0 0 0 0 0 0");
  for (int kind = 0; kind < 5; ++kind) {
    do_it(fmt::format("rob_ela_interact 3 1 10 0 {}", kind));
    EXPECT_EQ(std::to_underlying(last<tissue::SetInstrumentAction>().action.kind), kind);
  }
  EXPECT_FALSE(send("rob_ela_interact 3 1 10 0 5").done);
  EXPECT_FALSE(send("rob_ela_interact 3 5 10 0 0").done);
}

TEST_F(TissueInstrumentCommands, TestValuesAreInTheUnitOfTheJoint) {
  do_it("rob_ela_interact 2 3 40 200 0");  // SLIDE, mm
  EXPECT_EQ(last<tissue::SetInstrumentAction>().action.joint, 1);
  EXPECT_DOUBLE_EQ(last<tissue::SetInstrumentAction>().action.value_1, 0.04);
  EXPECT_DOUBLE_EQ(last<tissue::SetInstrumentAction>().action.value_2, 0.2);
  do_it("rob_ela_interact 1 1 720 0 0");  // TURN, degrees, has no end
  EXPECT_DOUBLE_EQ(last<tissue::SetInstrumentAction>().action.value_1, 720 * kDegree);
  EXPECT_FALSE(send("rob_ela_interact 0 1 10 0 0").done);
  EXPECT_FALSE(send("rob_ela_interact 4 1 10 0 0").done);
}

TEST_F(TissueInstrumentCommands, ATestThatIsNeverTrueIsDoneWithARemark) {
  const std::pair<const char*, const char*> remarks[] = {
      {"3 1 40 0 0", "the test is never true: JAW stays within 0 rad (0 deg) and"},
      {"3 2 0 0 0", "never true: JAW"},
      {"3 3 40 50 0", "never true: JAW"},
      {"3 3 20 10 0", "testval1 is more than testval2"},
      {"3 4 -1 40 0", "never true: JAW"},
      {"2 1 300 0 0", "never true: SLIDE stays within 0.03 m (30 mm) and 0.26 m (260 mm)"},
      {"3 1 10 0 1", "no clip is defined for LEFT yet: ela_clip_def does it"},
  };
  for (const auto& [values, remark] : remarks) {
    const Answer answer = send(fmt::format("rob_ela_interact {}", values));
    EXPECT_TRUE(answer.done) << values << ": " << answer.text;
    EXPECT_NE(answer.text.find(remark), std::string::npos) << values << ": " << answer.text;
  }
  EXPECT_EQ(port_.taken.size(), std::size(remarks));
}

TEST_F(TissueInstrumentCommands, WithoutAnActiveRobotEachIsRefusedNamingRobact) {
  names_->set_active("");
  for (const char* command : {"rob_ela_interact 3 1 10 0 0", "ela_clip_def clip.mpo 0 0 0 0 0 0",
                              "eladyn_geo_def JAW 0 5 4 0 0", "EFFECTS SUCTION ON", "EFFECTS IRRIGATION ON"}) {
    const Answer answer = send(command);
    EXPECT_FALSE(answer.done) << command;
    EXPECT_NE(answer.text.find("no robot is active"), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("ROBACT"), std::string::npos) << answer.text;
  }
  EXPECT_TRUE(port_.taken.empty());
}

TEST_F(TissueInstrumentCommands, CylindersInMetresByEveryNameOfAGeometry) {
  for (const char* name : {"JAW", "Left.TURN.SLIDE.JAW", "upper_jaw", "shaft"}) {
    do_it(fmt::format("eladyn_geo_def {} 6 5 4 22 9.5", name));
    const tissue::SetInstrumentShape& set = last<tissue::SetInstrumentShape>();
    EXPECT_EQ(set.instrument, static_cast<int>(slot("LEFT")));
    EXPECT_DOUBLE_EQ(set.shape.shaft_radius_m, 0.0025);
    EXPECT_DOUBLE_EQ(set.shape.effector_radius_m, 0.004);
    EXPECT_DOUBLE_EQ(set.shape.effector_length_m, 0.022);
    ASSERT_TRUE(instrument("LEFT").cylinders);
    EXPECT_EQ(instrument("LEFT").cylinders->geometry, name);
    EXPECT_EQ(instrument("LEFT").cylinders->flags, 6U);
    EXPECT_DOUBLE_EQ(instrument("LEFT").cylinders->effector_length_m, 0.022);
    EXPECT_DOUBLE_EQ(instrument("LEFT").cylinders->fourth, 9.5);
  }
  for (const char* length : {"0", "-3"}) {
    do_it(fmt::format("eladyn_geo_def JAW 0 5 4 {} 0", length));
    EXPECT_DOUBLE_EQ(last<tissue::SetInstrumentShape>().shape.effector_length_m, 0.018);
  }
}

TEST_F(TissueInstrumentCommands, AGeometryThatDoesNotMoveWithTheRobotIsRefused) {
  const std::pair<const char*, const char*> wrong[] = {
      {"JAWS", "JAWS is no geometry of LEFT; did you mean JAW?"},
      {"Table", "Table is no geometry of LEFT; it has SLIDE, shaft, JAW, upper_jaw"},
      {"plate", "plate is no geometry of LEFT"},
      {"Right.TURN.SLIDE.JAW", "is no geometry of LEFT"},
      {"sleeve", "sleeve is no geometry of LEFT"},
      {"TIP", "TIP is no geometry of LEFT"},
  };
  for (const auto& [name, why] : wrong) {
    const Answer answer = send(fmt::format("eladyn_geo_def {} 0 5 4 0 0", name));
    EXPECT_FALSE(answer.done) << name;
    EXPECT_NE(answer.text.find(why), std::string::npos) << answer.text;
  }
  EXPECT_TRUE(port_.taken.empty());
}

TEST_F(TissueInstrumentCommands, EachRobotHasItsOwnSettings) {
  names_->set_active("RIGHT");
  do_it("rob_ela_interact 3 1 10 0 4");
  do_it("eladyn_geo_def JAW 0 5 4 0 0");
  EXPECT_EQ(last<tissue::SetInstrumentShape>().instrument, static_cast<int>(slot("RIGHT")));
  names_->set_active("LEFT");
  do_it("rob_ela_interact 3 2 5 0 0");
  ASSERT_EQ(settings().instruments.size(), 2U);
  EXPECT_EQ(settings().instruments[0].robot, "LEFT");
  EXPECT_EQ(instrument("LEFT").action->kind, InstrumentKind::gripper);
  EXPECT_FALSE(instrument("LEFT").cylinders);
  EXPECT_EQ(instrument("RIGHT").action->kind, InstrumentKind::forceps);
  EXPECT_TRUE(instrument("RIGHT").cylinders);
}

TEST_F(TissueInstrumentCommands, AClipHasThePoseOfTheCommand) {
  clip_->length_m = 0.011;
  do_it("ela_clip_def clip 90 0 90 1 -2 3.5");
  EXPECT_EQ(read_, "clip");
  const tissue::SetClip& set = last<tissue::SetClip>();
  EXPECT_EQ(set.instrument, static_cast<int>(slot("LEFT")));
  EXPECT_DOUBLE_EQ(set.clip.length_m, 0.011);
  // About fixed axes: x by 90 degrees, then z by 90 degrees.
  EXPECT_NEAR((set.clip.X_TC.rotation() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR((set.clip.X_TC.rotation() * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((set.clip.X_TC.translation() - Eigen::Vector3d(0.001, -0.002, 0.0035)).norm(), 0, 1e-15);
  ASSERT_TRUE(instrument("LEFT").clip);
  EXPECT_EQ(instrument("LEFT").clip->file, "clip");
  do_it("rob_ela_interact 3 2 5 0 1");
}

TEST_F(TissueInstrumentCommands, AClipThatIsWrongChangesNothing) {
  const auto before = sut_->settings();
  clip_ = fail("clip.mpo: the surface is open", "close it");
  EXPECT_EQ(send("ela_clip_def clip.mpo 0 0 0 0 0 0").text, "clip.mpo: the surface is open; close it");
  EXPECT_TRUE(port_.taken.empty());
  EXPECT_EQ(sut_->settings(), before);
}

// A pedal's file may run while another robot is active.
TEST_F(TissueInstrumentCommands, SuctionAndIrrigationKeepTheirToolUntilTheyAreSwitchedOnAgain) {
  use({{.name = "liver.mpo", .pool = true}});
  for (const TissueEffect effect : {TissueEffect::suction, TissueEffect::irrigation}) {
    const TissueEffectSettings& before = settings().effects.at(std::to_underlying(effect));
    EXPECT_FALSE(before.on);
    names_->set_active("RIGHT");
    do_it(fmt::format("EFFECTS {} ON", word(effect)));
    EXPECT_EQ(last<tissue::SetEffect>().effect, effect);
    EXPECT_TRUE(last<tissue::SetEffect>().on);
    EXPECT_EQ(last<tissue::SetEffect>().instrument, static_cast<int>(slot("RIGHT")));
    names_->set_active("LEFT");
    EXPECT_EQ(settings().effects.at(std::to_underlying(effect)).robot, "RIGHT");
    do_it(fmt::format("EFFECTS {} ON", word(effect)));
    EXPECT_EQ(last<tissue::SetEffect>().instrument, static_cast<int>(slot("LEFT")));
    EXPECT_EQ(settings().effects.at(std::to_underlying(effect)).robot, "LEFT");
    names_->set_active("");
    do_it(fmt::format("EFFECTS {} OFF", word(effect)));
    EXPECT_FALSE(last<tissue::SetEffect>().on);
    EXPECT_EQ(last<tissue::SetEffect>().instrument, static_cast<int>(slot("LEFT")));
    EXPECT_FALSE(settings().effects.at(std::to_underlying(effect)).on);
    EXPECT_EQ(settings().effects.at(std::to_underlying(effect)).slot, -1);
  }
}

// The simulation follows the robots of these settings.
TEST_F(TissueInstrumentCommands, ARobotWithSuctionIsAnInstrument) {
  names_->set_active("RIGHT");
  EXPECT_TRUE(send("EFFECTS SUCTION ON").done);
  ASSERT_EQ(settings().instruments.size(), 1U);
  EXPECT_EQ(settings().instruments[0].slot, slot("RIGHT"));
  EXPECT_FALSE(settings().instruments[0].action);
}

TEST_F(TissueInstrumentCommands, MoreInstrumentsThanTheSimulationHasPlacesForAreRefused) {
  std::string text = "format = 1\nname = \"many\"\n";
  for (std::size_t i = 0; i <= tissue::kMostInstruments; ++i)
    text += fmt::format("[[node]]\nname = \"N{0}\"\nabstract = \"instrument.mpc\"\nrobot_id = \"R{0}\"\n", i);
  write("many.toml", text);
  Diagnostics diagnostics;
  auto loaded = load_cell(folder_ / "many.toml", diagnostics);
  ASSERT_TRUE(loaded) << diagnostics.text();
  sut_.reset();
  names_.reset();
  cell_.emplace(std::move(loaded->cell));
  names_.emplace(*cell_);
  use({object_named("liver.mpo")});
  for (std::size_t i = 0; i < tissue::kMostInstruments; ++i) {
    names_->set_active(fmt::format("R{}", i));
    do_it("rob_ela_interact 3 1 10 0 0");
  }
  names_->set_active(fmt::format("R{}", tissue::kMostInstruments));
  for (const char* command : {"rob_ela_interact 3 1 10 0 0", "EFFECTS IRRIGATION ON", "eladyn_geo_def JAW 0 5 4 0 0"}) {
    const Answer answer = send(command);
    EXPECT_FALSE(answer.done) << command;
    EXPECT_NE(answer.text.find("8 robots are instruments already"), std::string::npos) << answer.text;
  }
  names_->set_active("R0");
  do_it("rob_ela_interact 3 2 10 0 0");
  EXPECT_EQ(settings().instruments.size(), tissue::kMostInstruments);
}

TEST_F(TissueInstrumentCommands, AToolBroughtByAnotherComponentIsAnEffectorToo) {
  const auto connected = cell_->connect("Table", "Left.TURN.SLIDE.TIP", cell_->start_positions());
  ASSERT_TRUE(connected) << connected.error().text();
  do_it("eladyn_geo_def plate 0 5 4 0 0");
}

}  // namespace
}  // namespace cellmirror::app
