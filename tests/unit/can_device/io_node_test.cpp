// A CiA 401 I/O node: inputs as TPDOs by their interrupt objects, outputs by RPDO and SDO, and their error values.
#include "drivers/can/cia401/io_node.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/eds.hpp"
#include "drivers/can/cia401/io_objects.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

struct Io : testing::Test, FrameOutput {
  Io() { node.power_on(now); }
  void send(const CanFrame& sent) override { frames.push_back(sent); }
  void operate() {
    node.receive(frame(0x000, {0x01, 0x07}), now);
    frames.clear();
  }
  // Frames with the identifier that came since the last call.
  std::vector<CanFrame> take(std::uint32_t id) {
    std::vector<CanFrame> found;
    for (const CanFrame& sent : frames) {
      if (sent.id == id) found.push_back(sent);
    }
    frames.clear();
    return found;
  }
  void set(std::uint32_t digital, std::int16_t analogue = 0) {
    IoInputs inputs;
    inputs.digital = digital;
    inputs.analogue[0] = analogue;
    now = now + 1ms;
    node.set_inputs(inputs, now);
  }
  // Of 1, 2 or 4 bytes; the abort code, 0 where it was taken.
  std::uint32_t write(std::uint16_t index, std::uint8_t subindex, std::uint32_t value, std::size_t bytes) {
    CanFrame request = frame(0x607, {static_cast<int>(0x23 | (4 - bytes) << 2), 0, 0, subindex, 0, 0, 0, 0});
    put_le(std::span(request.data).subspan(1), index, 2);
    put_le(std::span(request.data).subspan(4), value, bytes);
    node.receive(request, now);
    const auto answers = take(0x587);
    if (answers.empty()) return 1;
    return answers[0].data[0] == 0x80 ? get_le32(std::span(answers[0].data).subspan(4)) : 0;
  }

  Timestamp now{1'000'000'000};
  std::vector<CanFrame> frames;
  IoNode node{7, 0, *this};
};

TEST_F(Io, BootsAndTellsWhatItIs) {
  EXPECT_EQ(take(0x707).size(), 1U);
  EXPECT_EQ(node.nmt_state(), NmtState::pre_operational);
  EXPECT_EQ(node.objects().integer({0x1000, 0}), 0x70191);
}

TEST_F(Io, TellsItsInputsWhenItBecomesOperational) {
  set(0x80000001, -5);
  EXPECT_TRUE(take(0x187).empty()) << "pre-operational";
  node.receive(frame(0x000, {0x01, 0x07}), now);
  const std::vector<CanFrame> all = frames;
  const auto digital = take(0x187);
  ASSERT_EQ(digital.size(), 1U);
  EXPECT_EQ(get_le32(digital[0].data), 0x80000001U);
  frames = all;
  const auto analogue = take(0x287);
  ASSERT_EQ(analogue.size(), 1U);
  EXPECT_EQ(static_cast<std::int16_t>(get_le16(analogue[0].data)), -5);
}

TEST_F(Io, AChangedInputIsAnEvent) {
  operate();
  set(0x2);
  const auto sent = take(0x187);
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].length, 4);
  EXPECT_EQ(get_le32(sent[0].data), 0x2U);
  set(0x2);
  EXPECT_TRUE(frames.empty()) << "nothing has changed";
}

TEST_F(Io, MasksChooseTheInputsWhoseChangeIsAnEvent) {
  operate();
  EXPECT_EQ(write(0x6006, 1, 0xFE, 1), 0U);
  set(0x1);
  EXPECT_TRUE(take(0x187).empty());
  set(0x3);
  ASSERT_EQ(take(0x187).size(), 1U);
  EXPECT_EQ(write(0x6005, 0, 0, 1), 0U);
  set(0x0);
  EXPECT_TRUE(take(0x187).empty()) << "no events at all";
  EXPECT_EQ(node.objects().integer({0x6000, 1}), 0) << "but the value is there to be read";
}

TEST_F(Io, AnalogueInputsAreEventsWhereEnabledAndBeyondTheirDelta) {
  operate();
  set(0, 1000);
  EXPECT_TRUE(take(0x287).empty()) << "not enabled at power-on";
  EXPECT_EQ(node.objects().integer({0x6401, 1}), 1000);
  EXPECT_EQ(write(0x6423, 0, 1, 1), 0U);
  EXPECT_EQ(write(0x6426, 1, 100, 4), 0U);
  set(0, 1001);
  ASSERT_EQ(take(0x287).size(), 1U) << "far from what was sent last: 0";
  set(0, 1101);
  EXPECT_TRUE(take(0x287).empty()) << "by 100, not by more";
  set(0, 1102);
  ASSERT_EQ(take(0x287).size(), 1U);
  set(0, -32768);
  ASSERT_EQ(take(0x287).size(), 1U) << "the whole range is no overflow";
}

TEST_F(Io, OutputsByPdoAndBySdo) {
  node.receive(frame(0x207, {0x01, 0x00, 0x00, 0x80}), now);
  EXPECT_EQ(node.outputs().digital, 0U) << "pre-operational: no PDOs";
  operate();
  node.receive(frame(0x207, {0x01, 0x00, 0x00, 0x80}), now);
  EXPECT_EQ(node.outputs().digital, 0x80000001U);
  EXPECT_EQ(write(0x6200, 2, 0x04, 1), 0U);
  EXPECT_EQ(node.outputs().digital, 0x80000401U);
  EXPECT_EQ(write(0x6000, 1, 1, 1), 0x06010002U) << "an input";
}

TEST_F(Io, AStoppedNodeHasErrorValuesAtItsOutputs) {
  operate();
  EXPECT_EQ(write(0x6206, 1, 0x0F, 1), 0U);  // the upper four stay
  EXPECT_EQ(write(0x6207, 1, 0x05, 1), 0U);
  node.receive(frame(0x207, {0xFF, 0xFF, 0x00, 0x00}), now);
  node.receive(frame(0x000, {0x02, 0x07}), now);
  EXPECT_EQ(node.outputs().digital, 0xF5U);
  EXPECT_EQ(node.objects().integer({0x6200, 1}), 0xF5);
}

TEST_F(Io, ALostMasterIsAnError) {
  operate();
  EXPECT_EQ(write(0x1016, 1, 0x007F0032, 4), 0U);  // node 127, 50 ms
  node.receive(frame(0x77F, {0x05}), now);
  node.receive(frame(0x207, {0xFF, 0x00, 0x00, 0x00}), now);
  now = now + 60ms;
  node.advance(now);
  EXPECT_EQ(node.outputs().digital, 0U);
  const auto emcy = take(0x087);
  ASSERT_EQ(emcy.size(), 1U);
  EXPECT_EQ(get_le16(emcy[0].data), 0x8130);
}

TEST_F(Io, AResetSwitchesTheOutputsOff) {
  operate();
  node.receive(frame(0x207, {0xFF, 0x00, 0x00, 0x00}), now);
  set(0x10);
  node.receive(frame(0x000, {0x81, 0x07}), now);
  EXPECT_EQ(node.outputs().digital, 0U);
  EXPECT_EQ(node.objects().integer({0x6000, 1}), 0x10) << "the inputs are what they are";
}

TEST(IoEds, DescribesTheNode) {
  constexpr std::uint8_t kNode = 5;
  const std::string file = (source_dir() / "config/devices/cellmirror_io_node.eds").string();
  Diagnostics diagnostics;
  const auto description = read_eds(file, kNode, diagnostics);
  ASSERT_TRUE(description);
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  const ObjectDictionary node = make_io_objects(kNode, 0);
  for (const auto& [address, entry] : node.entries()) {
    const ObjectEntry* described = description->objects.find(address);
    ASSERT_NE(described, nullptr) << text(address);
    EXPECT_EQ(described->type, entry.type) << text(address);
    EXPECT_EQ(described->access, entry.access) << text(address);
    EXPECT_EQ(described->pdo_mappable, entry.pdo_mappable) << text(address);
    EXPECT_EQ(described->value, entry.value) << text(address);
  }
  EXPECT_EQ(description->objects.size(), node.size());
}

}  // namespace
}  // namespace cellmirror::can
