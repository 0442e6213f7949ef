// Each kind of mistake is found at its place and answered with what helps. (The golden files of bad/ show more.)
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/scripts/test_text.hpp"

namespace cellmirror::script {
namespace {

struct Mistake {
  const char* name;
  std::string text;
  int line;
  int column;
  const char* message;  // part of it
  const char* remedy;   // part of it
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

const Mistake kMistakes[] = {
    {"UnknownCommand", "ROBAKT PUMA_762", 1, 1, "there is no command ROBAKT", "did you mean ROBACT"},
    {"UnknownRobot", "  ROBACT\n PUMA_76", 2, 2, "no robot PUMA_76", "PUMA_762"},
    {"NamesKeepTheirCase", "ROBACT puma_762", 1, 8, "no robot puma_762", "PUMA_762"},
    {"UnknownFrame", "SWAP_NODE Testlab_1.FL_Kleim", 1, 11, "no frame Testlab_1.FL_Kleim", "Testlab_1.FL_Klein"},
    {"UnknownCamera", "SET_CAMPAR CAMERA_4 1 20", 1, 12, "no camera CAMERA_4", "CAMERA_5"},
    {"UnknownSensor", "SET_USSPAR range USS_7 100", 1, 18, "no sensor USS_7", "USS_5"},
    {"SensorRangeIsPositive", "SET_USSPAR range USS_5 0", 1, 24, "range 0 is not more than 0 mm", ""},
    {"SensorSwitch", "SET_USSPAR active USS_5 2", 1, 25, "switch 2 is not one of 0, 1", ""},
    {"SensorParameter", "SET_USSPAR actve USS_5 1", 1, 12, "actve", "active"},
    {"SendMode", "SET_USSPAR sendmode 2", 1, 21, "sending mode 2 is not one of 0, 1", ""},
    {"WarningDistance", "SET_COLLPAR warning -1", 1, 21, "warning distance -1 is not in 0..100000 mm", ""},
    {"PairTreatment", "SET_COLLPAR pair Toolbox.Tool1 Mantec_1.HAND tset", 1, 46,
     "tset is not one of ignore, test, derive", "did you mean test"},
    {"PairOfUnknownFrames", "SET_COLLPAR pair Toolbox.Tool1 Mantec_1.HANT test", 1, 32, "no frame Mantec_1.HANT",
     "Mantec_1.HAND"},
    {"UnknownWorkframe", "FRAME_TO_WFRM Toolbox.Tool1 TO Mantec_1.HAND Tool1_WFRN", 1, 46, "no workframe",
     "Tool1_WFRM"},
    {"UnknownMode", "POS_ROB PUMA_762 JOINT_ABSS 1", 1, 18, "JOINT_ABSS is not one of JOINT_ABS",
     "did you mean JOINT_ABS"},
    {"UnknownChoice", "rob_vel_profile sinus", 1, 17, "sinus is not one of sine, ramp", "did you mean sine"},
    {"Range", "rob_cart_vel_scal 3", 1, 19, "velocity scale 3 is not in 0.01..1",
     "expected: rob_cart_vel_scal <scale>"},
    {"RangeLow", "rob_cart_acc_scal 0.009", 1, 19, "acceleration scale 0.009 is not in 0.01..1", ""},
    {"ViewWithoutParameters", "STVW 3", 1, 7, "gives no value to change", "give VP, LP"},
    {"ViewWithAPaceAlone", "STVW 3 TIME 2", 1, 14, "gives no value to change", "give VP, LP"},
    {"BracketsOfTheSynopsis", "SWAP_NODE (Testlab_1.FL_Klein)", 1, 11, "is in brackets", "write Testlab_1.FL_Klein"},
    {"BracketsAboutAnUnknownName", "ROBACT <PUMA_76>", 1, 8, "no robot PUMA_76", "did you mean PUMA_762?"},
    {"TestWithoutItsValues", "SET_EXT_TCP_TEST on", 1, 20, "force along x <v1> is missing", ""},
    {"TestWithTwoValues", "SET_EXT_TCP_TEST off 1 2", 1, 25, "force along z <v3> is missing", ""},
    {"RangeOpen", "TAG_DRAWLEN 0", 1, 13, "length 0 is not more than 0 mm", ""},
    {"RangeOfFlyAngle", "rob_cart_fly_radius 2 181", 1, 23, "is not in 0..180 degrees", ""},
    {"RangeOfClippingPlane", "VV_CLIP_POS CLP1 ELE 90.5 AZI 0 DIST 0", 1, 22, "elevation 90.5 is not in -90..90", ""},
    {"WrongType", "rob_cart_lin_vel fast", 1, 18, "velocity fast is not a number",
     "expected: rob_cart_lin_vel <lin_vel>"},
    {"NotFinite", "rob_cart_lin_vel inf", 1, 18, "is not a finite number", ""},
    {"BeyondDouble", "rob_cart_lin_vel 1e400", 1, 18, "is beyond the range of numbers", ""},
    {"NotWhole", "STDP 1.5 FULL", 1, 6, "display 1.5 is not a whole number", ""},
    {"DecimalComma", "rob_cart_vel_scal 0,5", 1, 21, "a comma before 5 is not allowed here", "decimal point"},
    {"Missing", "CONNECT Toolbox.Tool1", 1, 22, "TO is missing", "expected: CONNECT <frame_2> TO <frame_1>"},
    {"TooMany", "DRAW_SCENE at once", 1, 12, "at is a surplus word", "expected: DRAW_SCENE"},
    {"TooManyJoints", "POS_ROB ZELLENKRAN JOINT_ABS 1 2 3 4", 1, 36, "4 values given, but ZELLENKRAN has 3 joints", ""},
    {"TooFewParameters", "rob_jnt_max_range 1 2", 1, 19, "2 values given, but MANTEC_RM3 has 6 joints", "each joint"},
    {"TwoCommands", "DRAW_SCENE; DRAW_SCENE", 1, 13, "more text after the command", "one command per message"},
    {"NoCommand", " ; ", 1, 2, "there is no command", ""},
    {"Empty", "", 1, 1, "there is no command", ""},
    {"ForgottenSemicolon", "ROBACT PUMA_762\nDRAW_SCENE", 2, 1, "DRAW_SCENE is within the command", "';'"},
    {"NulByte", std::string("ROBACT PUMA\0 762", 16), 1, 12, "NUL byte", ""},
    {"ControlByte", "ROBACT PUMA\x02", 1, 8, "contains a control byte", ""},
    {"NotUtf8", "ROBACT \xc4rm", 1, 8, "is not UTF-8", "UTF-8"},
    {"EmptyPathPart", "ACTIVATE a..b", 1, 10, "has an empty part", "single dots"},
    {"LongName", "ROBACT " + std::string(64, 'a'), 1, 8, "more than 63", ""},
    {"LongCommand", "POS_ROB MANTEC_RM3 JOINT_ABS" + std::string(9000, '\n') + std::string(9000, ' ') + "1", 1, 1,
     "longer than", "missing"},
    {"ManyWords",
     [] {
       std::string text = "DRAW_SCENE";
       for (int i = 0; i < 1000; ++i) text += " 1";
       return text;
     }(),
     1, 1, "longer than", "missing"},
    {"EffectorJoint", "rob_ela_interact 7 1 0 0 0", 1, 18, "MANTEC_RM3 has 6 joints", ""},
    {"AttributeFlags", "eladyn_geo_def ALL 0x1000", 1, 20, "0x1000 is not in 0..4095", "eladyn_geo_def"},
    {"Attribute", "eladyn_geo_def ALL CUTS on", 1, 20, "attribute (table A.1) CUTS is not one of", "did you mean CUT"},
    {"LimitFlags", "eladyn_plaus_param STRAIN 64 1", 1, 27, "64 is not in 0..63", ""},
    {"LimitToken", "eladyn_plaus_param STRAINS 1 1", 1, 20, "STRAINS is not one of", "did you mean STRAIN"},
    {"LimitBelowZero", "eladyn_plaus_param STRAIN 1 -1", 1, 29, "is not at least 0", ""},
    {"ShaftDiameter", "eladyn_geo_def jaw 0 0 4 18 0", 1, 22, "more than 0 and at most 200 mm", ""},
    {"EffectorRadius", "eladyn_geo_def jaw 0 5 1e9 18 0", 1, 24, "more than 0 and at most 200 mm", ""},
    {"EffectorLength", "eladyn_geo_def jaw 0 5 4 1e9 0", 1, 26, "at most 1000 mm", ""},
    {"EffectWithoutSwitch", "EFFECTS SUCTION", 1, 16, "ON | OFF", "EFFECTS SUCTION"},
    {"EffectThatHasNoSwitch", "EFFECTS RESET_POOL ON", 1, 20, "ON is a surplus word", ""},
    {"SlaveJoint", "MASTER_SLAVE on PUMA_762 1 MANTEC_RM3 1 J_1 J_9", 1, 45, "MANTEC_RM3 has no joint J_9", "J_1"},
    {"KeyZero", "rob_ela_shm 0 0x0 64", 1, 15, "shared memory key 0x0 is not in 1..4294967295", ""},
};

class ScriptMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(ScriptMistake, IsFoundAtItsPlaceWithRemedy) {
  cellmirror::testing::FakeNames names;
  names.active = "MANTEC_RM3";
  const std::vector<Diagnostic> sut = findings_of(GetParam().text, &names);
  ASSERT_FALSE(sut.empty());
  EXPECT_EQ(sut[0].severity, Severity::error);
  EXPECT_EQ(sut[0].place.file, "message");
  EXPECT_EQ(sut[0].place.line, GetParam().line) << sut[0].text();
  EXPECT_EQ(sut[0].place.column, GetParam().column) << sut[0].text();
  EXPECT_NE(sut[0].message.find(GetParam().message), std::string::npos) << sut[0].text();
  EXPECT_NE(sut[0].remedy.find(GetParam().remedy), std::string::npos) << sut[0].text();
}

INSTANTIATE_TEST_SUITE_P(Each, ScriptMistake, ::testing::ValuesIn(kMistakes),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(ScriptMistakes, OfOneCommandAreAllFound) {
  const cellmirror::testing::FakeNames names;
  const auto sut = findings_of("SET_CAMPAR CAMERA_9 -1 200", &names);
  ASSERT_EQ(sut.size(), 3U);
  EXPECT_EQ(sut[0].place.column, 12);
  EXPECT_EQ(sut[1].place.column, 21);
  EXPECT_EQ(sut[2].place.column, 24);
}

TEST(ScriptMistakes, OfAFileAreAllFoundAndCorrectCommandsBetweenThemAreRead) {
  std::string text;
  for (int i = 0; i < 10; ++i) text += "ROBAKT x;\nDRAW_SCENE;\n";
  Diagnostics findings;
  EXPECT_EQ(check_script(text, "file.spt", nullptr, findings), 20U);
  ASSERT_EQ(findings.errors(), 10U);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(findings.all()[i].place.line, static_cast<int>(2 * i + 1));
}

TEST(ScriptMistakes, ActiveRobotIsAskedForByName) {
  const cellmirror::testing::FakeNames names;
  const auto sut = findings_of("rob_cart_lin_vel 100", &names);
  ASSERT_EQ(sut.size(), 1U);
  EXPECT_EQ(sut[0].message, "rob_cart_lin_vel: no robot is active");
  EXPECT_NE(sut[0].remedy.find("ROBACT"), std::string::npos);
}

TEST(ScriptMistakes, ToolNeedsAnActiveRobotOnlyToBeSwitchedOn) {
  const cellmirror::testing::FakeNames names;
  for (const std::string effect : {"SUCTION", "IRRIGATION"}) {
    const auto sut = findings_of("EFFECTS " + effect + " ON", &names);
    ASSERT_EQ(sut.size(), 1U);
    EXPECT_EQ(sut[0].message, "EFFECTS: no robot is active");
    EXPECT_TRUE(findings_of("EFFECTS " + effect + " OFF", &names).empty());
  }
}

TEST(CheckAhead, FollowsRobact) {
  const cellmirror::testing::FakeNames names;
  EXPECT_TRUE(findings_of_file("ROBACT ZELLENKRAN;\nrob_jnt_max_vel 1 2 3;", &names).empty());
  const auto sut = findings_of_file("ROBACT ZELLENKRAN;\nrob_jnt_max_vel 1 2 3 4;", &names);
  ASSERT_EQ(sut.size(), 1U);
  EXPECT_EQ(sut[0].place.line, 2);
}

TEST(CheckAhead, MissingActiveRobotIsAWarningSinceACallerMaySetIt) {
  const cellmirror::testing::FakeNames names;
  const auto sut = findings_of_file("rob_jnt_max_vel 1 2 3;", &names);
  ASSERT_EQ(sut.size(), 1U);
  EXPECT_EQ(sut[0].severity, Severity::warning);
}

TEST(CheckAhead, UnknownFramesAreErrorsUntilSomethingMayHaveLoadedThem) {
  const cellmirror::testing::FakeNames names;
  const auto sut = findings_of_file("SWAP_NODE a.b;\nLEVEL_DOWN Testlab_1;\nSWAP_NODE a.b;\nROBACT no;", &names);
  ASSERT_EQ(sut.size(), 3U);
  EXPECT_EQ(sut[0].severity, Severity::error);
  EXPECT_EQ(sut[1].severity, Severity::warning);
  EXPECT_EQ(sut[2].severity, Severity::error);
}

TEST(CheckAhead, KeepsAtMostTheBoundedNumberOfFindings) {
  std::string text;
  for (std::size_t i = 0; i < Diagnostics::kKept + 500; ++i) text += "X;\n";
  Diagnostics findings;
  check_script(text, "file.spt", nullptr, findings);
  EXPECT_EQ(findings.all().size(), Diagnostics::kKept);
  EXPECT_EQ(findings.errors(), Diagnostics::kKept + 500);
}

}  // namespace
}  // namespace cellmirror::script
