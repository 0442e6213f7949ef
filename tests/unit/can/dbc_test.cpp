// Golden frames by hand: Intel start bit = LSB, Motorola start bit = MSB in saw-tooth numbering.
#include "drivers/can/dbc/dbc.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/can/dbc/session.hpp"
#include "drivers/can/dbc/unit.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using testing::HasSubstr;

Dbc axes() {
  Diagnostics diagnostics;
  const auto dbc = read_dbc(can_data("axes.dbc"), diagnostics);
  EXPECT_EQ(diagnostics.text(), "");
  return dbc.value_or(Dbc{});
}

double value(const Dbc& dbc, const char* message, const char* signal, const CanFrame& frame) {
  return physical_value(*dbc.find(message)->find(signal), frame.payload());
}

TEST(Dbc, ReadsMessagesAndSignals) {
  const Dbc sut = axes();
  ASSERT_EQ(sut.messages.size(), 4U);
  const DbcMessage& axis_1 = *sut.find("Axis_1");
  EXPECT_EQ(axis_1.id, 256U);
  EXPECT_FALSE(axis_1.extended);
  EXPECT_EQ(axis_1.length, 8);
  EXPECT_EQ(axis_1.signals.size(), 3U);
  EXPECT_EQ(axis_1.find("Position")->unit, "deg");
  EXPECT_EQ(axis_1.find("Position")->minimum, -180.0);
  const DbcMessage& axis_2 = *sut.find("Axis_2");
  EXPECT_TRUE(axis_2.extended) << "bit 31 of the identifier";
  EXPECT_EQ(axis_2.id, 2566844416U - 0x80000000U);
}

TEST(Dbc, IntelSignals) {
  const Dbc sut = axes();
  // -90.5 deg = -90500 = 0xFFFE9E7C; -1.2 deg/s = -12 = 0xFFF4; counter 5 in the low nibble of byte 6.
  const CanFrame golden = frame(0x100, {0x7C, 0x9E, 0xFE, 0xFF, 0xF4, 0xFF, 0xA5, 0x00});
  EXPECT_DOUBLE_EQ(value(sut, "Axis_1", "Position", golden), -90.5);
  EXPECT_DOUBLE_EQ(value(sut, "Axis_1", "Velocity", golden), -1.2);
  EXPECT_DOUBLE_EQ(value(sut, "Axis_1", "Counter", golden), 5.0);
}

TEST(Dbc, MotorolaSignalOfWholeBytes) {
  const Dbc sut = axes();
  // 7|16@0-: byte 0 is the high byte. 0x0FA0 = 4000 -> 40 - 90 = -50; 0xFFFF = -1 -> -90.01.
  EXPECT_DOUBLE_EQ(value(sut, "Axis_2", "Position", frame(0, {0x0F, 0xA0, 0, 0, 0, 0, 0, 0})), -50.0);
  EXPECT_DOUBLE_EQ(value(sut, "Axis_2", "Position", frame(0, {0xFF, 0xFF, 0, 0, 0, 0, 0, 0})), -90.01);
}

TEST(Dbc, MotorolaSignalAcrossBytes) {
  DbcSignal sut;
  sut.order = ByteOrder::big_endian;
  // 12 bits from bit 2: bits 2..0 of byte 0, then all of byte 1, then bit 7 of byte 2.
  sut.start = 2;
  sut.length = 12;
  const CanFrame golden = frame(0, {0x05, 0xAB, 0x80});
  EXPECT_EQ(bytes_needed(sut), 3U);
  EXPECT_EQ(raw_value(sut, golden.payload()), 0b1'0110'1010'111U);
}

TEST(Dbc, FloatSignals) {
  const Dbc sut = axes();
  // double 1.5 = 0x3FF8000000000000, float -2.5 = 0xC0200000, little-endian.
  const CanFrame golden = frame(0x101, {0, 0, 0, 0, 0, 0, 0xF8, 0x3F, 0x00, 0x00, 0x20, 0xC0});
  EXPECT_DOUBLE_EQ(value(sut, "Axis_3", "Position", golden), 1.5);
  EXPECT_DOUBLE_EQ(value(sut, "Axis_3", "Torque", golden), -2.5);
}

TEST(Dbc, MultiplexedSignalsAreThereForTheirValueOnly) {
  const Dbc sut = axes();
  const DbcMessage& message = *sut.find("Axes");
  const auto present = [&](const char* signal, const CanFrame& f) {
    return is_present(message, *message.find(signal), f.payload());
  };
  const CanFrame zero = frame(0x102, {0, 0x10, 0x27, 0, 0, 0, 0, 0});
  EXPECT_TRUE(present("Axis", zero));
  EXPECT_TRUE(present("First", zero));
  EXPECT_FALSE(present("Second", zero));
  EXPECT_TRUE(present("Second", frame(0x102, {1, 0, 0, 0, 0, 0, 0, 0})));
  EXPECT_TRUE(present("Deep", frame(0x102, {2, 4, 0, 0, 0, 0, 0, 0}))) << "nested: Axis 2, Page 4";
  EXPECT_TRUE(present("Deep", frame(0x102, {2, 9, 0, 0, 0, 0, 0, 0})));
  EXPECT_FALSE(present("Deep", frame(0x102, {2, 6, 0, 0, 0, 0, 0, 0})));
  EXPECT_FALSE(present("Deep", frame(0x102, {3, 4, 0, 0, 0, 0, 0, 0}))) << "Page itself is not there";
}

TEST(Dbc, PutIsTheInverseOfGet) {
  DbcSignal sut;
  sut.factor = 0.5;
  sut.offset = -3.0;
  sut.is_signed = true;
  for (const ByteOrder order : {ByteOrder::little_endian, ByteOrder::big_endian}) {
    sut.order = order;
    sut.start = 11;
    sut.length = 10;
    CanFrame frame;
    frame.length = 8;
    put_physical_value(sut, -20.5, std::span(frame.data).first(8));
    EXPECT_DOUBLE_EQ(physical_value(sut, frame.payload()), -20.5);
    put_physical_value(sut, 1e9, std::span(frame.data).first(8));
    EXPECT_DOUBLE_EQ(physical_value(sut, frame.payload()), 511 * 0.5 - 3.0) << "clamped to ten bits";
    put_physical_value(sut, -1e9, std::span(frame.data).first(8));
    EXPECT_DOUBLE_EQ(physical_value(sut, frame.payload()), -512 * 0.5 - 3.0);
  }
}

TEST(Dbc, PutClampsToTheFirstValueThatDoesNotFitAndLeavesTheNeighbours) {
  DbcSignal sut;
  sut.start = 8;
  sut.length = 8;
  const auto put = [&sut](double value) {
    CanFrame frame;
    frame.length = 8;
    frame.data.fill(0x55);
    put_physical_value(sut, value, std::span(frame.data).first(8));
    EXPECT_EQ(frame.data[0], 0x55) << value;
    EXPECT_EQ(frame.data[2], 0x55) << value;
    return physical_value(sut, frame.payload());
  };
  EXPECT_EQ(put(255), 255.0);
  EXPECT_EQ(put(256), 255.0);
  EXPECT_EQ(put(-1), 0.0);
  sut.is_signed = true;
  EXPECT_EQ(put(127), 127.0);
  EXPECT_EQ(put(128), 127.0);
  EXPECT_EQ(put(-128), -128.0);
  EXPECT_EQ(put(-129), -128.0);
}

TEST(Dbc, TellsAllMistakesWithTheirPlaces) {
  const std::string text =
      "BO_ 1 A: 8 X\n"
      " SG_ Far : 60|8@1+ (1,0) [0|0] \"\" X\n"
      " SG_ Zero : 0|8@1+ (0,0) [0|0] \"\" X\n"
      " SG_ Order : 0|8@2+ (1,0) [0|0] \"\" X\n"
      " SG_ Twice : 0|8@1+ (1,0) [0|0] \"\" X\n"
      " SG_ Twice : 8|8@1+ (1,0) [0|0] \"\" X\n"
      " SG_ Alone m1 : 8|8@1+ (1,0) [0|0] \"\" X\n"
      "BO_ 4096 B: 8 X\n"
      "BO_ 2 C: 65 X\n"
      "BO_ 1 D: 8 X\n"
      "BO_ x E: 8 X\n"
      "SIG_VALTYPE_ 1 Twice : 1;\n"
      "CM_ \"never ends\n";
  Diagnostics diagnostics;
  const Dbc sut = parse_dbc(text, "f.dbc", diagnostics);
  const std::string told = diagnostics.text();
  for (const char* expected :
       {"f.dbc:2: warning: the signal Far reaches to byte 9, the message A has 8 bytes",
        "f.dbc:3:", "a factor other than 0", "f.dbc:4:", "the byte order, 0 or 1",
        "f.dbc:6: warning: the signal Twice appears twice in A",
        "f.dbc:7: warning: the signal Alone has no multiplexer in A",
        "f.dbc:8: warning: message B: 4096 is not a CAN identifier",
        "f.dbc:9: warning: message C has 65 bytes, a CAN frame holds at most 64",
        "f.dbc:10: warning: message D has the identifier 1 of A", "f.dbc:11:", "f.dbc:13: warning: a string"}) {
    EXPECT_THAT(told, HasSubstr(expected));
  }
  EXPECT_TRUE(diagnostics.ok()) << "the cell does not use these signals";
  EXPECT_TRUE(sut.find("A")->signals.empty());
}

const std::string kAxisOnly = "BO_ 256 Axis: 8 A\n SG_ Angle : 0|32@1- (0.001,0) [0|0] \"rad\" A\n";

TEST(Dbc, WarnsOfFaultsInUnusedParts) {
  for (const char* more :
       {"BO_ 257 Other: 2 A\n SG_ S : 8|16@1+ (1,0) [0|0] \"\" A\n",
        "BO_ 2566844926 Long: 200 A\n SG_ S : 800|16@1+ (1,0) [0|0] \"\" A\nSIG_VALTYPE_ 2566844926 S : 1;\n",
        "BO_ 257 Axis: 8 A\n SG_ Angle : 0|8@1+ (1,0) [0|0] \"\" A\n BO_", "BO_ 1073742080 Strange: 8 A\n",
        "BO_ 257 Other: 8 A\n SG_ \xC3\x96l : 0|8@1+ (1,0) [0|0] \"\" A\n", "CM_ \"never ends\n",
        "VAL_ 256 Angle 1 \"one\"", "SIG_VALTYPE_ 999 Nobody : 1;\n", "SG_MUL_VAL_ 999 Nobody M 0-1;\n", "VERSION 3\n",
        "BO_ 257 Other 8 A\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" A\n", "\xFF\xFE"}) {
    Diagnostics diagnostics;
    // A second message "Axis" would make the first one unusable too, so it gets another name.
    std::string text = kAxisOnly + more;
    if (const std::size_t at = text.find("257 Axis"); at != std::string::npos) text.replace(at, 8, "257 Oxis");
    const Dbc sut = parse_dbc(text, "f.dbc", diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << more << diagnostics.text();
    EXPECT_GE(diagnostics.warnings(), 1U) << more;
    ASSERT_NE(sut.find("Axis"), nullptr) << more;
    EXPECT_NE(sut.find("Axis")->find("Angle"), nullptr) << more;
  }
}

TEST(Dbc, IgnoresTheMessageOfIndependentSignalsWithAnyIdentifier) {
  for (const char* id : {"1073741824", "3221225472", "0"}) {
    Diagnostics diagnostics;
    const std::string text =
        "BO_ " + std::string(id) +
        " VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ X : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX\n"
        "SIG_VALTYPE_ " +
        id + " X : 1;\n" + kAxisOnly;
    const Dbc sut = parse_dbc(text, "f.dbc", diagnostics);
    EXPECT_EQ(diagnostics.text(), "");
    ASSERT_EQ(sut.messages.size(), 1U);
    EXPECT_EQ(sut.messages[0].name, "Axis");
  }
}

TEST(Dbc, AStatementWithoutSemicolonEndsWithItsLine) {
  Diagnostics diagnostics;
  const std::string text = kAxisOnly + "VAL_ 256 Angle 1 \"one\"\nSIG_VALTYPE_ 256 Angle : 1\nVAL_ 256 Angle 1 \"one\"";
  const Dbc sut = parse_dbc(text, "f.dbc", diagnostics);
  EXPECT_EQ(sut.find("Axis")->find("Angle")->type, DbcValueType::float32) << "the next statement is read";
  EXPECT_EQ(diagnostics.warnings(), 3U) << diagnostics.text();
  EXPECT_THAT(diagnostics.text(), HasSubstr("f.dbc:3: warning: the statement does not end with a semicolon"));
}

TEST(Dbc, IgnoresLimitsThatAreNotNumbers) {
  Diagnostics diagnostics;
  const Dbc sut = parse_dbc("BO_ 1 A: 8 X\n SG_ S : 0|32@1- (1,0) [-1.#INF|1.#INF] \"deg\" X\n", "f.dbc", diagnostics);
  ASSERT_NE(sut.find("A")->find("S"), nullptr);
  EXPECT_EQ(sut.find("A")->find("S")->unit, "deg");
  EXPECT_EQ(sut.find("A")->find("S")->maximum, 0.0);
  EXPECT_EQ(diagnostics.warnings(), 1U);
}

TEST(Dbc, FindsMessagesAndSignalsByLongAndShortNames) {
  Diagnostics diagnostics;
  const std::string text =
      "BO_ 256 Shoulder_Axis_Actual_Values_0000: 8 A\n"
      " SG_ Shoulder_Axis_Position_Actua_0001 : 0|32@1- (0.001,0) [0|0] \"rad\" A\n"
      " SG_ Broken_Value_0002 : 60|8@1- (0.001,0) [0|0] \"rad\" A\n"
      "BA_DEF_ BO_ \"SystemMessageLongSymbol\" STRING ;\n"
      "BA_ \"SystemMessageLongSymbol\" BO_ 256 \"Shoulder_Axis_Actual_Values_Of_The_Left_Arm\";\n"
      "BA_ \"SystemSignalLongSymbol\" SG_ 256 Shoulder_Axis_Position_Actua_0001 "
      "\"Shoulder_Axis_Position_Actual_Value\";\n"
      "BA_ \"SystemSignalLongSymbol\" SG_ 256 Broken_Value_0002 \"Broken_Value_Of_The_Left_Arm\";\n";
  const Dbc sut = parse_dbc(text, "f.dbc", diagnostics);
  EXPECT_EQ(diagnostics.warnings(), 1U) << diagnostics.text();
  const DbcMessage* message = sut.find("Shoulder_Axis_Actual_Values_Of_The_Left_Arm");
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(message, sut.find("Shoulder_Axis_Actual_Values_0000"));
  const DbcSignal* signal = message->find("Shoulder_Axis_Position_Actual_Value");
  ASSERT_NE(signal, nullptr);
  EXPECT_EQ(signal, message->find("Shoulder_Axis_Position_Actua_0001"));
  for (const char* name : {"Broken_Value_Of_The_Left_Arm", "Broken_Value_0002"})
    EXPECT_NE(sut.fault_of(message->name, name), nullptr) << name;
}

TEST(Dbc, AFileWithoutMessagesIsAnError) {
  Diagnostics diagnostics;
  (void)parse_dbc("VERSION \"\"\nBU_: A\n", "f.dbc", diagnostics);
  EXPECT_THAT(diagnostics.text(), HasSubstr("error: the file describes no message (BO_); is it a DBC file?"));
}

TEST(Dbc, ReadsFilesOfOthers) {
  const auto folder = shared_data() / "dbc";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "skipped: no shared DBC files on this machine";
  Diagnostics diagnostics;
  const auto motohawk = read_dbc((folder / "cantools_motohawk.dbc").string(), diagnostics);
  ASSERT_TRUE(motohawk);
  // Temperature 0|12@0-: bit 0 of byte 0, all of byte 1, bits 7..5 of byte 2; 250 + 0.01 * raw.
  const CanFrame golden = frame(496, {0xC0, 0x06, 0xE0, 0, 0, 0, 0, 0});
  EXPECT_DOUBLE_EQ(value(*motohawk, "ExampleMessage", "Temperature", golden), 250.0 + 0.01 * 55);
  EXPECT_DOUBLE_EQ(value(*motohawk, "ExampleMessage", "Enable", golden), 1.0);
  EXPECT_DOUBLE_EQ(value(*motohawk, "ExampleMessage", "AverageRadius", golden), 3.2);

  const auto odrive = read_dbc((folder / "odrive-cansimple.dbc").string(), diagnostics);
  ASSERT_TRUE(odrive);
  EXPECT_EQ(odrive->find("Axis0_Get_Encoder_Estimates")->find("Pos_Estimate")->type, DbcValueType::float32);
  const auto actuator = read_dbc((folder / "cantools_open_actuator.dbc").string(), diagnostics);
  ASSERT_TRUE(actuator);
  EXPECT_EQ(diagnostics.text(), "");
}

struct SignalRecorder : DbcSessionOutput {
  std::vector<JointSample> samples;
  std::vector<std::string> reasons;
  void sample(const JointSample& s) override { samples.push_back(s); }
  void rejected(const std::string& why) override { reasons.push_back(why); }
  void outside(const std::string& what) override { beyond.push_back(what); }
  std::vector<std::string> beyond;
};

DbcSignalConfig mapped(const char* message, const char* signal, std::size_t joint,
                       JointQuantity quantity = JointQuantity::position, double scale = 1.0, double offset = 0.0) {
  return {message, signal, joint, "J", quantity, scale, offset, scale != 1.0};
}

struct DbcSessionTest : testing::Test {
  DbcSessionTest() {
    DbcStreamConfig config;
    config.signals = {mapped("Axis_1", "Position", 0, JointQuantity::position, std::numbers::pi / 180, 0.25),
                      mapped("Axis_1", "Velocity", 0, JointQuantity::velocity, std::numbers::pi / 180),
                      mapped("Axis_2", "Position", 1),
                      mapped("Axis_3", "Position", 2),
                      mapped("Axis_3", "Torque", 2, JointQuantity::effort),
                      mapped("Axes", "First", 3),
                      mapped("Axes", "Second", 4)};
    Diagnostics diagnostics;
    auto plan = plan_dbc(config, axes(), diagnostics);
    EXPECT_EQ(diagnostics.errors(), 0U);
    sut = std::make_unique<DbcSession>(std::move(*plan), recorder);
  }
  SignalRecorder recorder;
  std::unique_ptr<DbcSession> sut;
};

TEST_F(DbcSessionTest, MakesASampleOfAFrame) {
  sut->receive(frame(0x100, {0x7C, 0x9E, 0xFE, 0xFF, 0xF4, 0xFF, 0, 0}), {5});
  ASSERT_EQ(recorder.samples.size(), 1U);
  const JointSample& sample = recorder.samples[0];
  EXPECT_EQ(sample.present, 1U);
  EXPECT_EQ(sample.sequence, 1U);
  EXPECT_EQ(sample.receive_time.ns, 5);
  EXPECT_DOUBLE_EQ(sample.position[0], -90.5 * std::numbers::pi / 180 + 0.25);
  EXPECT_DOUBLE_EQ(sample.velocity[0], -1.2 * std::numbers::pi / 180);
}

TEST_F(DbcSessionTest, KeepsExtendedAndBaseIdentifiersApart) {
  const std::uint32_t id = 2566844416U - 0x80000000U;
  sut->receive(frame(id & 0x7FF, {0, 0, 0, 0, 0, 0, 0, 0}), {1});
  EXPECT_TRUE(recorder.samples.empty());
  sut->receive(extended_frame(id, {0x0F, 0xA0, 0, 0, 0, 0, 0, 0}), {1});
  ASSERT_EQ(recorder.samples.size(), 1U);
  EXPECT_EQ(recorder.samples[0].present, 2U);
  EXPECT_DOUBLE_EQ(recorder.samples[0].position[1], -50.0);
}

TEST_F(DbcSessionTest, FdFrameLongerThanTheMessageIsTaken) {
  CanFrame fd = frame(0x101, {0, 0, 0, 0, 0, 0, 0xF8, 0x3F, 0x00, 0x00, 0x20, 0xC0, 0, 0, 0, 0});
  fd.fd = true;
  sut->receive(fd, {1});
  ASSERT_EQ(recorder.samples.size(), 1U);
  EXPECT_DOUBLE_EQ(recorder.samples[0].position[2], 1.5);
  EXPECT_DOUBLE_EQ(recorder.samples[0].effort[2], -2.5);
}

TEST_F(DbcSessionTest, TakesNoValueFromRemoteAndErrorFrames) {
  CanFrame asked = frame(0x100, {0x7C, 0x9E, 0xFE, 0xFF, 0xF4, 0xFF, 0, 0});
  asked.remote = true;
  sut->receive(asked, {1});
  asked.remote = false;
  asked.error = true;
  sut->receive(asked, {2});
  EXPECT_TRUE(recorder.samples.empty());
  EXPECT_EQ(sut->counters().rejected, 0U);
}

TEST_F(DbcSessionTest, RefusesShortFramesAndCountsThem) {
  sut->receive(frame(0x100, {1, 2, 3, 4}), {1});
  EXPECT_TRUE(recorder.samples.empty());
  EXPECT_EQ(sut->counters().rejected, 1U);
  EXPECT_EQ(recorder.reasons[0], "Axis_1: 4 bytes, the DBC says 8");
}

TEST_F(DbcSessionTest, RefusesValuesThatAreNotFinite) {
  // A quiet NaN as double.
  sut->receive(frame(0x101, {0, 0, 0, 0, 0, 0, 0xF8, 0x7F, 0, 0, 0x80, 0x3F}), {1});
  ASSERT_EQ(recorder.samples.size(), 1U);
  EXPECT_EQ(recorder.samples[0].present, 0U);
  EXPECT_EQ(recorder.samples[0].refused, 4U);
  EXPECT_EQ(recorder.samples[0].position[2], 0.0);
  EXPECT_EQ(recorder.samples[0].effort[2], 1.0) << "the other values of the frame stay usable";
  EXPECT_EQ(sut->counters().rejected, 1U);
}

TEST_F(DbcSessionTest, EffortIsNotKnownAnyMoreWhenItsFrameStopsOrItsNewestValueIsRefused) {
  const CanFrame good = frame(0x101, {0, 0, 0, 0, 0, 0, 0xF8, 0x3F, 0, 0, 0x80, 0x3F});
  const CanFrame no_number = frame(0x101, {0, 0, 0, 0, 0, 0, 0xF8, 0x3F, 0, 0, 0xC0, 0x7F});
  const CanFrame other = frame(0x100, {0, 0, 0, 0, 0, 0, 0, 0});
  sut->receive(good, {1});
  sut->receive(other, Timestamp{1} + StreamAges{}.lost_after);
  EXPECT_EQ(recorder.samples.back().effort[2], 1.0);
  sut->receive(other, Timestamp{2} + StreamAges{}.lost_after);
  EXPECT_EQ(recorder.samples.back().effort[2], 0.0);
  sut->receive(good, {3'000'000'000});
  sut->receive(no_number, {3'000'000'001});
  EXPECT_EQ(recorder.samples.back().effort[2], 0.0);
}

TEST_F(DbcSessionTest, MultiplexedSignalsOfOneMessageReachTheirJoints) {
  sut->receive(frame(0x102, {0, 0x10, 0x27, 0, 0, 0, 0, 0}), {1});
  sut->receive(frame(0x102, {1, 0xF0, 0xD8, 0, 0, 0, 0, 0}), {2});
  ASSERT_EQ(recorder.samples.size(), 2U);
  EXPECT_EQ(recorder.samples[0].present, 8U);
  EXPECT_EQ(recorder.samples[0].position[3], 10000.0);
  EXPECT_EQ(recorder.samples[1].present, 16U);
  EXPECT_EQ(recorder.samples[1].position[4], -10000.0);
  EXPECT_EQ(recorder.samples[1].position[3], 10000.0) << "the newest value of the other joints goes along";
}

TEST(DbcPlan, TellsAllUnknownNamesWithTheNearest) {
  DbcStreamConfig config;
  config.signals = {mapped("Axis1", "Position", 0), mapped("Axis_1", "Positon", 1), mapped("Axis_1", "Position", 99)};
  Diagnostics diagnostics;
  EXPECT_FALSE(plan_dbc(config, axes(), diagnostics));
  EXPECT_EQ(diagnostics.errors(), 3U);
  EXPECT_THAT(diagnostics.text(), HasSubstr("Axis_1"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("did you mean Position"));
}

TEST_F(DbcSessionTest, ValuesBeyondTheLimitsOfTheDbcAreTakenAndToldOnceAnOccurrence) {
  const auto at = [this](std::int32_t thousandths, std::int64_t ms) {
    const auto raw = static_cast<std::uint32_t>(thousandths);
    const auto byte = [raw](int i) { return static_cast<std::uint8_t>(raw >> (8 * i)); };
    sut->receive(frame(0x100, {byte(0), byte(1), byte(2), byte(3), 0, 0, 0, 0}), {1 + ms * 1'000'000});
  };
  at(180'000, 0);  // on the limit
  EXPECT_TRUE(recorder.beyond.empty());
  at(200'500, 1);
  at(201'000, 2);
  ASSERT_EQ(recorder.beyond.size(), 1U);
  EXPECT_EQ(recorder.beyond[0], "Axis_1.Position is 200.5 deg, beyond -180 .. 180 of the DBC; it is taken as it is");
  EXPECT_DOUBLE_EQ(recorder.samples.back().position[0], 201.0 * std::numbers::pi / 180 + 0.25);
  EXPECT_EQ(sut->counters().outside, 2U);
  EXPECT_EQ(sut->counters().rejected, 0U);
  for (std::int64_t ms = 3; ms < 1000; ++ms) at(ms % 2 == 0 ? 190'000 : 0, ms);
  EXPECT_EQ(recorder.beyond.size(), 1U) << "one that swings about its limit fills no log";
  at(190'000, 20'000);
  EXPECT_EQ(recorder.beyond.size(), 2U);
}

TEST(DbcTurns, TheCounterOfAContinuousJointContinuesAcrossItsWrap) {
  Diagnostics diagnostics;
  DbcStreamConfig config;
  config.signals = {mapped("Axis", "Angle", 0)};
  config.signals[0].turns = true;
  SignalRecorder recorder;
  auto plan = plan_dbc(
      config, parse_dbc("BO_ 256 Axis: 2 A\n SG_ Angle : 0|16@1+ (0.001,0) [0|0] \"rad\" A\n", "f.dbc", diagnostics),
      diagnostics);
  ASSERT_TRUE(plan) << diagnostics.text();
  DbcSession sut(std::move(*plan), recorder);
  sut.receive(frame(256, {0xFA, 0xFF}), {1});  // 65530
  sut.receive(frame(256, {0x04, 0x00}), {2});
  ASSERT_EQ(recorder.samples.size(), 2U);
  EXPECT_NEAR(recorder.samples[1].position[0] - recorder.samples[0].position[0], 0.010, 1e-9);
  sut.restart();
  sut.receive(frame(256, {0x04, 0x00}), {3});
  EXPECT_NEAR(recorder.samples[2].position[0], 0.004, 1e-9) << "a repeated log starts from its own values";
}

// The source sends 0 to 360 degrees in hundredths; its signal could hold 655.35 degrees.
TEST(DbcTurns, ASourceThatWrapsAtOneTurnContinuesInBothDirections) {
  Diagnostics diagnostics;
  DbcStreamConfig config;
  config.signals = {mapped("Axis", "Angle", 0)};
  config.signals[0].turns = true;
  config.signals[0].scale = std::numbers::pi / 180;
  SignalRecorder recorder;
  auto plan = plan_dbc(
      config, parse_dbc("BO_ 256 Axis: 2 A\n SG_ Angle : 0|16@1+ (0.01,0) [0|360] \"deg\" A\n", "f.dbc", diagnostics),
      diagnostics);
  ASSERT_TRUE(plan) << diagnostics.text();
  DbcSession sut(std::move(*plan), recorder);
  for (const int direction : {1, -1}) {
    sut.restart();
    for (int i = 0; i <= 300; ++i) {
      const double real_deg = direction * 7.0 * i;
      const double sent = std::fmod(std::fmod(real_deg, 360.0) + 360.0, 360.0);
      const auto raw = static_cast<std::uint16_t>(std::lround(100 * sent));
      sut.receive(frame(256, {static_cast<std::uint8_t>(raw), static_cast<std::uint8_t>(raw >> 8)}), {1 + i});
      ASSERT_NEAR(recorder.samples.back().position[0], real_deg * std::numbers::pi / 180, 1e-9) << i;
    }
  }
}

TEST_F(DbcSessionTest, EqualLimitsAreNone) {
  sut->receive(extended_frame(2566844416U - 0x80000000U, {0x7F, 0xFF, 0, 0, 0, 0, 0, 0}), {1});
  ASSERT_EQ(recorder.samples.size(), 1U);
  EXPECT_TRUE(recorder.beyond.empty());
}

TEST(DbcPlan, WarnsOfAUnitThatIsNotSiWhereNoScaleIsGiven) {
  DbcStreamConfig config;
  config.signals = {mapped("Axis_1", "Position", 0), mapped("Axis_3", "Position", 1)};
  config.signals[0].place = {"cell.toml", 12, 10};
  Diagnostics diagnostics;
  EXPECT_TRUE(plan_dbc(config, axes(), diagnostics));
  EXPECT_EQ(diagnostics.text(),
            "cell.toml:12:10: warning: signal Axis_1.Position is in deg and scale is 1; write scale = "
            "0.017453292519943295\n");
  config.signals[0].scale_given = true;
  diagnostics = {};
  EXPECT_TRUE(plan_dbc(config, axes(), diagnostics));
  EXPECT_EQ(diagnostics.text(), "") << "1 is meant where it is written";
}

TEST(DbcUnit, IsKnownInItsUsualSpellings) {
  constexpr double kDegree = std::numbers::pi / 180;
  for (const char* degree : {"deg", "Deg", " degrees ", "\xB0", "\xC2\xB0", "deg/s"})
    EXPECT_EQ(si_scale_of(degree), kDegree);
  EXPECT_EQ(si_scale_of("rev"), 2 * std::numbers::pi);
  EXPECT_EQ(si_scale_of("rpm"), 2 * std::numbers::pi / 60);
  EXPECT_EQ(si_scale_of("mm"), 1e-3);
  EXPECT_EQ(si_scale_of("mNm"), 1e-3);
  EXPECT_EQ(si_scale_of("kNm"), 1e3);
  for (const char* other : {"", "rad", "rad/s", "m", "Nm", "N", "%", "MNm", "furlong"})
    EXPECT_EQ(si_scale_of(other), std::nullopt);
}

TEST(DbcPlan, MistakesStandAtTheirPlaceInTheCellFile) {
  DbcStreamConfig config;
  config.place = {"cell.toml", 3, 1};
  config.signals = {mapped("Axis1", "Position", 0, JointQuantity::velocity),
                    mapped("Axis_1", "Positon", 1, JointQuantity::velocity)};
  config.signals[0].message_place = {"cell.toml", 8, 11};
  config.signals[1].place = {"cell.toml", 13, 10};
  Diagnostics diagnostics;
  EXPECT_FALSE(plan_dbc(config, axes(), diagnostics));
  for (const char* expected : {"cell.toml:8:11: error: the DBC has no message Axis1",
                               "cell.toml:13:10: error: the message Axis_1 has no signal Positon",
                               "cell.toml:3:1: error: none of the signals is a position"}) {
    EXPECT_THAT(diagnostics.text(), HasSubstr(expected));
  }
}

TEST(DbcPlan, AFaultInAUsedMessageOrSignalIsAnErrorInTheDbc) {
  const auto told = [](const std::string& text) {
    Diagnostics diagnostics;
    DbcStreamConfig config;
    config.signals = {mapped("Axis", "Angle", 0)};
    EXPECT_FALSE(plan_dbc(config, parse_dbc(text, "f.dbc", diagnostics), diagnostics)) << text;
    EXPECT_EQ(diagnostics.errors(), 1U) << diagnostics.text();
    return diagnostics.text(Severity::error);
  };
  EXPECT_THAT(told("BO_ 1 Axis: 2 A\n SG_ Angle : 8|16@1+ (1,0) [0|0] \"\" A\n SG_ B : 0|8@1+ (1,0) [0|0] \"\" A\n"),
              HasSubstr("f.dbc:2: error: the stream uses Axis.Angle: the signal Angle reaches to byte 3"));
  EXPECT_THAT(told("BO_ 1 Axis: 200 A\n SG_ Angle : 8|16@1+ (1,0) [0|0] \"\" A\n"),
              HasSubstr("f.dbc:1: error: the stream uses Axis: message Axis has 200 bytes"));
  EXPECT_THAT(told("BO_ 1 Axis: 8 A\n SG_ Angle : 8|16@1+ (x,0) [0|0] \"\" A\n"),
              HasSubstr("error: the stream uses Axis.Angle: expected (factor,offset)"));
  EXPECT_THAT(told(kAxisOnly + "SIG_VALTYPE_ 256 Angle : 9;\n"),
              HasSubstr("error: the stream uses Axis.Angle: expected the type of the value"))
      << "otherwise a float would be read as an integer";
  EXPECT_THAT(told(kAxisOnly + "BO_ 257 Axis: 8 A\n SG_ Angle : 0|8@1+ (1,0) [0|0] \"\" A\n"),
              HasSubstr("error: the stream uses Axis: the message Axis appears twice"));
}

TEST(DbcPlan, MissingFileIsTold) {
  DbcStreamConfig config;
  config.dbc_file = "/does/not/exist.dbc";
  Diagnostics diagnostics;
  EXPECT_FALSE(plan_dbc(config, diagnostics));
  EXPECT_THAT(diagnostics.text(), HasSubstr("cannot read the DBC file"));
}

}  // namespace
}  // namespace cellmirror::can
