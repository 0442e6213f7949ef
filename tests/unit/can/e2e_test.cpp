// End-to-end protection: the check values of the catalogue of CRCs, the examples of PRS_E2EProtocol, and what a checker
// finds of each fault.
#include "drivers/can/e2e/e2e.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/dbc/session.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using Bytes = std::vector<std::uint8_t>;

const DbcMessage& message_of_8_bytes() {
  static const DbcMessage kMessage = [] {
    DbcMessage message;
    message.name = "Axis";
    message.length = 8;
    return message;
  }();
  return kMessage;
}

E2eFormat format_of(E2eProfile profile, std::vector<std::uint16_t> id, E2eDataIdMode mode = E2eDataIdMode::both,
                    std::uint8_t max_delta = 1) {
  E2eConfig config;
  config.profile = profile;
  config.data_id = std::move(id);
  config.data_id_mode = mode;
  config.max_delta = max_delta;
  auto format = make_e2e_format(config, message_of_8_bytes());
  EXPECT_TRUE(format) << format.error().text();
  return format.value_or(E2eFormat());
}

std::vector<std::uint16_t> numbers(std::uint16_t first) {
  std::vector<std::uint16_t> out;
  for (std::uint16_t i = 0; i < 16; ++i) out.push_back(static_cast<std::uint16_t>(first + i));
  return out;
}

Bytes protected_bytes(const E2eFormat& format, std::uint16_t counter, Bytes data = Bytes(8, 0)) {
  protect(format, counter, data);
  return data;
}

TEST(Crc, HasTheCheckValuesOfTheCatalogue) {
  const std::string check = "123456789";
  const Bytes data(check.begin(), check.end());
  EXPECT_EQ(crc_of(kCrc8SaeJ1850, data), 0x4B);
  EXPECT_EQ(crc_of(kCrc8H2f, data), 0xDF);
  EXPECT_EQ(crc_of(kCrc16Ccitt, data), 0x29B1);
}

TEST(Crc, HasTheExamplesOfTheCrcLibrary) {
  // AUTOSAR SWS CRC Library, tables of CRC8, CRC8H2F and CRC16 over the same data.
  const Bytes zeros(4, 0x00);
  const Bytes other{0xF2, 0x01, 0x83};
  EXPECT_EQ(crc_of(kCrc8SaeJ1850, zeros), 0x59);
  EXPECT_EQ(crc_of(kCrc8SaeJ1850, other), 0x37);
  EXPECT_EQ(crc_of(kCrc8H2f, zeros), 0x12);
  EXPECT_EQ(crc_of(kCrc8H2f, other), 0xC2);
  EXPECT_EQ(crc_of(kCrc16Ccitt, zeros), 0x84C0);
  EXPECT_EQ(crc_of(kCrc16Ccitt, other), 0xD374);
}

TEST(E2eProtect, HasTheExamplesOfProfile1) {
  const E2eFormat both = format_of(E2eProfile::p01, {0x123});
  EXPECT_EQ(protected_bytes(both, 0), (Bytes{0xCC, 0x00, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(protected_bytes(both, 1), (Bytes{0x91, 0x01, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(protected_bytes(format_of(E2eProfile::p01, {0x123}, E2eDataIdMode::alternating), 0)[0], 0xCE);
  EXPECT_EQ(protected_bytes(format_of(E2eProfile::p01, {0x123}, E2eDataIdMode::low), 0)[0], 0xCE);
  EXPECT_EQ(protected_bytes(format_of(E2eProfile::p01, {0x123}, E2eDataIdMode::nibble), 0),
            (Bytes{0x2A, 0x10, 0, 0, 0, 0, 0, 0}));
}

TEST(E2eProtect, HasTheExamplesOfProfile2) {
  const E2eFormat ids_from_1 = format_of(E2eProfile::p02, numbers(1));
  EXPECT_EQ(protected_bytes(ids_from_1, 1), (Bytes{0x1B, 0x01, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(protected_bytes(ids_from_1, 2), (Bytes{0x98, 0x02, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(protected_bytes(ids_from_1, 3), (Bytes{0x31, 0x03, 0, 0, 0, 0, 0, 0}));
  const E2eFormat ids_from_0 = format_of(E2eProfile::p02, numbers(0));
  EXPECT_EQ(protected_bytes(ids_from_0, 2, {0, 1, 2, 3, 4, 5, 6, 7}), (Bytes{0xBC, 2, 2, 3, 4, 5, 6, 7}));
}

TEST(E2eProtect, HasTheExampleOfProfile5) {
  EXPECT_EQ(protected_bytes(format_of(E2eProfile::p05, {0x1234}), 0), (Bytes{0x1C, 0xCA, 0x00, 0, 0, 0, 0, 0}));
}

struct E2eFaults : testing::TestWithParam<E2eProfile> {
  E2eFaults() : format(format_of(GetParam(), GetParam() == E2eProfile::p02 ? numbers(1) : id, {}, 3)), sut(format) {}
  E2eChecker::Verdict receive(std::uint16_t counter) { return sut.check(protected_bytes(format, counter, data)); }

  std::vector<std::uint16_t> id{0x123};
  Bytes data{0, 0, 0, 4, 5, 6, 7, 8};
  E2eFormat format;
  E2eChecker sut;
};

TEST_P(E2eFaults, ACounterThatGoesOnIsSoundAllTheWayRound) {
  EXPECT_EQ(receive(0).status, E2eStatus::initial);
  for (int i = 1; i < 600; ++i)
    ASSERT_EQ(receive(static_cast<std::uint16_t>(i % (format.last_counter + 1))).status, E2eStatus::ok) << i;
}

TEST_P(E2eFaults, RepetitionLossAndWrongSequenceAreTold) {
  receive(format.last_counter);
  EXPECT_EQ(receive(0).status, E2eStatus::ok);
  EXPECT_EQ(receive(0).status, E2eStatus::repeated);
  EXPECT_FALSE(receive(0).good());
  const auto lost = receive(3);
  EXPECT_EQ(lost.status, E2eStatus::ok_some_lost);
  EXPECT_EQ(lost.missing, 2U);
  EXPECT_TRUE(lost.good());
  const auto gap = receive(7);
  EXPECT_EQ(gap.status, E2eStatus::wrong_sequence);
  EXPECT_EQ(gap.missing, 3U);
  EXPECT_FALSE(gap.good());
  EXPECT_EQ(receive(8).status, E2eStatus::ok) << "it is compared with the newest";
  EXPECT_EQ(receive(6).status, E2eStatus::wrong_sequence) << "out of order";
}

TEST_P(E2eFaults, EachSingleBitThatFlipsIsAWrongCrc) {
  receive(0);
  const Bytes good = protected_bytes(format, 1, data);
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1U << bit % 8);
    EXPECT_EQ(sut.check(bad).status, E2eStatus::wrong_crc) << bit;
  }
  EXPECT_EQ(sut.check(good).status, E2eStatus::ok) << "wrong ones do not count";
}

TEST_P(E2eFaults, AMessageOfAnotherIdIsAWrongCrc) {
  receive(0);
  const auto other =
      format_of(GetParam(), GetParam() == E2eProfile::p02 ? numbers(2) : std::vector<std::uint16_t>{0x124});
  EXPECT_EQ(sut.check(protected_bytes(other, 1, data)).status, E2eStatus::wrong_crc);
}

INSTANTIATE_TEST_SUITE_P(Profiles, E2eFaults, testing::Values(E2eProfile::p01, E2eProfile::p02, E2eProfile::p05));

TEST(E2eFormat, RefusesWhatDoesNotFitTheMessage) {
  const auto why = [](const E2eConfig& config, const DbcMessage& message) {
    const auto format = make_e2e_format(config, message);
    return format ? std::string() : format.error().what;
  };
  E2eConfig config{.message = "Axis", .profile = E2eProfile::p01, .data_id = {1}};
  EXPECT_EQ(why(config, message_of_8_bytes()), "");
  DbcMessage small = message_of_8_bytes();
  small.length = 1;
  EXPECT_EQ(why(config, small), "Axis has 1 bytes, its protection needs 2");
  config.data_id = {1, 2};
  EXPECT_EQ(why(config, message_of_8_bytes()), "data_id has 2 numbers, the profile 1");
  config.data_id = {0x1234};
  config.data_id_mode = E2eDataIdMode::nibble;
  EXPECT_EQ(why(config, message_of_8_bytes()), "data_id has more than the 12 bits of the nibble mode");
  config.data_id_mode = E2eDataIdMode::low;
  config.max_delta = 14;
  EXPECT_EQ(why(config, message_of_8_bytes()), "max_delta is 14, but has to be 1 to 13");
}

constexpr const char* kDescribed =
    "BO_ 252 ControlStatus: 4 Actuator\n"
    " SG_ CRC8_STAT1 : 0|8@1+ (1,0) [0|255] \"\" Driver\n"
    " SG_ Counter_STAT1 : 12|4@1+ (1,0) [0|15] \"\" Driver\n"
    " SG_ Angle : 16|16@1- (0.001,0) [0|0] \"rad\" Driver\n";

struct SessionOutput : DbcSessionOutput {
  std::vector<JointSample> samples;
  std::vector<std::string> reasons;
  void sample(const JointSample& s) override { samples.push_back(s); }
  void rejected(const std::string& why) override { reasons.push_back(why); }
  void outside(const std::string&) override {}
};

struct ProtectedSession : testing::Test {
  ProtectedSession() {
    config.signals = {{"ControlStatus", "Angle", 0, "J_1", JointQuantity::position, 1.0, 0.0, true}};
    E2eConfig protection{.message = "ControlStatus", .profile = E2eProfile::described};
    protection.counter_signal = "Counter_STAT1";
    protection.crc_signal = "CRC8_STAT1";
    protection.crc = kCrc8SaeJ1850;
    protection.data_id = {0xFC};
    config.protections = {protection};
  }
  // The diagnostics, where there is no plan.
  std::string plan() {
    Diagnostics diagnostics;
    Dbc dbc = parse_dbc(kDescribed, "actuator.dbc", diagnostics);
    auto planned = plan_dbc(config, std::move(dbc), diagnostics);
    if (!planned) return diagnostics.text();
    format = planned->protections.at(0).format;
    sut = std::make_unique<DbcSession>(std::move(*planned), out);
    return {};
  }
  CanFrame status(std::uint16_t counter, int angle = 0) const {
    CanFrame sent = frame(252, {0, 0, angle & 0xFF, angle >> 8 & 0xFF});
    protect(format, counter, std::span(sent.data).first(4));
    return sent;
  }
  void receive(const CanFrame& frame) {
    now = now + Nanoseconds(10'000'000);
    sut->receive(frame, now);
  }

  DbcStreamConfig config;
  SessionOutput out;
  E2eFormat format;
  std::unique_ptr<DbcSession> sut;
  Timestamp now{1'000'000'000};
};

TEST_F(ProtectedSession, TakesSoundFramesAndRefusesTheOthers) {
  ASSERT_EQ(plan(), "");
  receive(status(14, 100));
  receive(status(15, 200));
  receive(status(0, 300));
  ASSERT_EQ(out.samples.size(), 3U);
  EXPECT_EQ(out.samples.back().present, 1U);
  EXPECT_DOUBLE_EQ(out.samples.back().position[0], 0.3);
  CanFrame corrupt = status(1, 400);
  corrupt.data[2] = static_cast<std::uint8_t>(corrupt.data[2] ^ 0x40);
  receive(corrupt);
  EXPECT_EQ(out.samples.back().present, 0U);
  EXPECT_EQ(out.samples.back().refused, 1U);
  EXPECT_EQ(sut->counters().wrong_crc, 1U);
  EXPECT_EQ(out.reasons.back(), "ControlStatus: wrong CRC");
  receive(status(1, 400));
  EXPECT_EQ(out.samples.back().present, 1U);
  const std::size_t before = out.samples.size();
  receive(status(1, 500));
  EXPECT_EQ(out.samples.size(), before) << "nothing new";
  EXPECT_EQ(sut->counters().repeated, 1U);
  EXPECT_EQ(sut->trouble().status, E2eStatus::repeated);
  EXPECT_EQ(sut->trouble().protection, now);
  receive(status(5, 500));
  EXPECT_EQ(out.samples.back().refused, 1U);
  EXPECT_EQ(sut->counters().wrong_sequence, 1U);
  EXPECT_EQ(sut->counters().lost, 3U);
  receive(status(6, 500));
  EXPECT_EQ(out.samples.back().present, 1U);
}

TEST_F(ProtectedSession, WhatDoesNotFitTheDbcIsAnError) {
  config.protections[0].crc_signal = "CRC8_STAT2";
  EXPECT_NE(plan().find("the message ControlStatus has no signal CRC8_STAT2; did you mean CRC8_STAT1?"),
            std::string::npos)
      << plan();
  config.protections[0].crc_signal = "Angle";
  EXPECT_NE(plan().find("Angle has 16 bits, crc_bits is 8"), std::string::npos) << plan();
  config.protections[0].crc_signal = "CRC8_STAT1";
  config.protections[0].counter_signal = "CRC8_STAT1";
  EXPECT_NE(plan().find("the counter and the CRC of ControlStatus overlap"), std::string::npos) << plan();
  config.protections[0].counter_signal = "Counter_STAT1";
  config.protections.push_back(config.protections[0]);
  EXPECT_NE(plan().find("ControlStatus is protected twice"), std::string::npos) << plan();
  config.protections[1].message = "Nothing";
  EXPECT_NE(plan().find("the DBC has no message Nothing"), std::string::npos) << plan();
}

TEST(OpenActuator, EachOfItsMessagesCanBeDescribed) {
  const std::filesystem::path file = shared_data() / "dbc/cantools_open_actuator.dbc";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no shared DBC files on this machine";
  Diagnostics diagnostics;
  const auto dbc = read_dbc(file.string(), diagnostics);
  ASSERT_TRUE(dbc);
  std::size_t described = 0;
  for (const DbcMessage& message : dbc->messages) {
    E2eConfig config{.message = message.name, .profile = E2eProfile::described};
    for (const DbcSignal& signal : message.signals) {
      if (signal.name.starts_with("CRC8")) config.crc_signal = signal.name;
      if (signal.name.starts_with("Counter")) config.counter_signal = signal.name;
    }
    if (config.crc_signal.empty()) continue;
    config.crc = kCrc8SaeJ1850;
    const auto format = make_e2e_format(config, message);
    ASSERT_TRUE(format) << message.name << ": " << format.error().text();
    Bytes data(message.length, 0xA5);
    E2eChecker checker(*format);
    protect(*format, 3, data);
    EXPECT_EQ(checker.check(data).status, E2eStatus::initial) << message.name;
    protect(*format, 4, data);
    EXPECT_EQ(checker.check(data).status, E2eStatus::ok) << message.name;
    data.back() = static_cast<std::uint8_t>(data.back() ^ 1U);
    EXPECT_EQ(checker.check(data).status, E2eStatus::wrong_crc) << message.name;
    ++described;
  }
  EXPECT_EQ(described, 5U);
}

}  // namespace
}  // namespace cellmirror::can
