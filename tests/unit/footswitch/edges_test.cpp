#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <vector>

#include "drivers/footswitch/switch_edges.hpp"

namespace cellmirror::footswitch {
namespace {

constexpr Nanoseconds kMs{1'000'000};

class Looks {
 public:
  Looks(std::size_t bytes, int debounce_ms) : sut(bytes, debounce_ms * kMs) {}
  std::vector<SwitchEdge> at(int ms, std::vector<std::uint8_t> bytes) {
    std::vector<SwitchEdge> edges;
    sut.look(bytes, when(ms), edges);
    return edges;
  }
  static Timestamp when(int ms) { return Timestamp{1'000'000'000} + ms * kMs; }

  SwitchEdges sut;
};

TEST(SwitchEdges, TheFirstStateIsNoChange) {
  Looks sut(2, 10);
  EXPECT_TRUE(sut.at(0, {0xff, 0x01}).empty());
  EXPECT_TRUE(sut.at(1, {0xff, 0x01}).empty());
  EXPECT_EQ(sut.sut.reported()[0], 0xff);
}

TEST(SwitchEdges, AChangeIsToldAtOnceWithItsTimeAndTheLookBefore) {
  Looks sut(1, 10);
  sut.at(0, {0});
  sut.at(7, {0});
  const auto edges = sut.at(8, {1});
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0].input, 1U);
  EXPECT_TRUE(edges[0].on);
  EXPECT_EQ(edges[0].time, Looks::when(8));
  EXPECT_EQ(edges[0].not_told, Looks::when(7));
}

TEST(SwitchEdges, LowerInputsComeFirst) {
  Looks sut(2, 10);
  sut.at(0, {0, 0});
  const auto edges = sut.at(1, {0x82, 0x41});
  std::vector<std::uint32_t> inputs;
  for (const SwitchEdge& edge : edges) inputs.push_back(edge.input);
  EXPECT_EQ(inputs, (std::vector<std::uint32_t>{2, 8, 9, 15}));
}

TEST(SwitchEdges, ALateLookTellsBothWhatSettledAndWhatChangedSince) {
  Looks sut(1, 10);
  sut.at(0, {0});
  sut.at(1, {1});
  EXPECT_TRUE(sut.at(2, {0}).empty());  // a bounce
  const auto edges = sut.at(50, {1});   // was off from 2 to 49, and is on again
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_FALSE(edges[0].on);
  EXPECT_EQ(edges[0].time, Looks::when(2));
  EXPECT_TRUE(edges[1].on);
  EXPECT_EQ(edges[1].time, Looks::when(50));
}

TEST(SwitchEdges, WithoutDebouncingEveryChangeCounts) {
  Looks sut(1, 0);
  sut.at(0, {0});
  for (int ms = 1; ms < 100; ++ms) EXPECT_EQ(sut.at(ms, {static_cast<std::uint8_t>(ms % 2)}).size(), 1U);
  EXPECT_EQ(sut.sut.bounces(), 0U);
}

TEST(SwitchEdges, AShorterCopyLeavesTheRestAsItWas) {
  Looks sut(2, 0);
  sut.at(0, {0, 0xff});
  EXPECT_EQ(sut.at(1, {1}).size(), 1U);
  EXPECT_EQ(sut.sut.reported()[1], 0xff);
}

// For any row of looks: what is reported alternates, is never more than what changed, comes in order, and ends, when
// the bits have been quiet for long enough, with the bits as they are.
TEST(SwitchEdges, HoldTheirPromisesForAnyTimeline) {
  rc::check([] {
    const auto debounce_ms = *rc::gen::inRange(0, 20);
    const auto count = *rc::gen::inRange<std::size_t>(1, 4);
    const auto steps = *rc::gen::container<std::vector<std::pair<int, std::vector<std::uint8_t>>>>(rc::gen::pair(
        rc::gen::inRange(1, 12),
        rc::gen::container<std::vector<std::uint8_t>>(count, rc::gen::element<std::uint8_t>(0, 1, 2, 3, 128, 255))));
    Looks sut(count, debounce_ms);
    std::vector<std::uint8_t> last(count, 0);
    sut.at(0, last);
    std::map<std::uint32_t, bool> reported;
    std::map<std::uint32_t, Timestamp> told_at;
    std::size_t changes = 0;
    std::size_t edges_told = 0;
    int ms = 0;
    const auto look = [&](const std::vector<std::uint8_t>& bytes) {
      for (std::size_t i = 0; i < count; ++i)
        changes += static_cast<std::size_t>(__builtin_popcount(bytes[i] ^ last[i]));
      last = bytes;
      std::uint32_t before = 0;
      for (const SwitchEdge& edge : sut.at(ms, bytes)) {
        ++edges_told;
        RC_ASSERT(edge.input >= 1U && edge.input <= 8 * count);
        RC_ASSERT(edge.input >= before);
        before = edge.input;
        RC_ASSERT(edge.on != reported[edge.input]);
        reported[edge.input] = edge.on;
        RC_ASSERT(edge.time > told_at[edge.input]);
        RC_ASSERT(edge.time <= Looks::when(ms));
        RC_ASSERT(edge.not_told < Looks::when(ms));
        told_at[edge.input] = edge.time;
      }
    };
    for (const auto& [wait, bytes] : steps) {
      ms += wait;
      look(bytes);
    }
    ms += debounce_ms;
    look(last);
    RC_ASSERT(edges_told <= changes);
    RC_ASSERT(edges_told + sut.sut.bounces() >= changes);
    for (std::size_t i = 0; i < count; ++i) {
      RC_ASSERT(sut.sut.reported()[i] == last[i]);
      for (unsigned bit = 0; bit < 8; ++bit)
        RC_ASSERT(reported[static_cast<std::uint32_t>(8 * i + bit + 1)] == (((last[i] >> bit) & 1U) != 0));
    }
  });
}

}  // namespace
}  // namespace cellmirror::footswitch
