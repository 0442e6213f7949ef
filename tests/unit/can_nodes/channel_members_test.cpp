// Protocols that share a channel: what each gets, what goes out together, and what bounds them.
#include "drivers/can/stream/channel_members.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kSyncId = 0x080;

struct HandClock final : Clock {
  [[nodiscard]] Timestamp now() const CELL_RT override { return time; }
  Timestamp time{1'000'000'000};
};

// Keeps what is sent, by call; refuses identifiers that it is told.
struct KeepingChannel final : CanChannel {
  CanReceive receive(ReceivedCanFrame& /*frame*/, Nanoseconds /*timeout*/) override { return CanReceive::timeout; }
  bool send(const CanFrame& frame) override {
    calls.push_back({frame});
    return frame.id != refused;
  }
  void send_all(std::span<const CanFrame> frames, std::span<bool> sent) override {
    calls.emplace_back(frames.begin(), frames.end());
    for (std::size_t i = 0; i < frames.size(); ++i) sent[i] = frames[i].id != refused;
  }
  [[nodiscard]] const CanChannelStatus& status() const override { return status_; }

  std::vector<Frames> calls;
  std::uint32_t refused = 0xFFFF;

 private:
  CanChannelStatus status_;
};

// One node that takes some identifiers and does on each frame what it is told.
struct Node final : ChannelMember, CanProtocol {
  Node(ChannelMembers& members, std::vector<std::uint32_t> takes) : identifiers(std::move(takes)), members_(&members) {}

  void send(const CanFrame& frame) { members_->send_from(*this, 0, frame); }

  // ChannelMember
  void start(Timestamp /*now*/) override {}
  CanProtocol& protocol() override { return *this; }
  void count_refused() override { ++refused; }
  void keep_error(const std::string& text) override { errors.push_back(text); }
  // Both
  void publish() override { ++published; }
  // CanProtocol
  void receive(const CanFrame& frame, Timestamp /*now*/, std::size_t /*node*/) override {
    got.push_back(frame.id);
    if (on_frame) on_frame(frame);
  }
  void advance(Timestamp now) override {
    advanced.push_back(now);
    due = {};
  }
  [[nodiscard]] Timestamp next_due() const override { return due; }
  void describe(JointStreamStatus& /*status*/, Timestamp /*now*/) override {}
  void add_routes(std::uint16_t member, IdentifierRoutes& routes) const override {
    routes.add({member, 0}, identifiers);
  }
  [[nodiscard]] std::uint64_t routes_revision() const override { return revision; }

  std::vector<std::uint32_t> identifiers;
  std::uint64_t revision = 1;
  Timestamp due;
  std::function<void(const CanFrame&)> on_frame;
  std::vector<std::uint32_t> got;
  std::vector<Timestamp> advanced;
  std::vector<std::string> errors;
  int refused = 0;
  int published = 0;

 private:
  ChannelMembers* members_;
};

struct Members : testing::Test {
  Members() { sut.set_channel(channel); }
  void add(Node& node) { sut.add(node, clock.time); }

  HandClock clock;
  KeepingChannel channel;
  ChannelMembers sut{clock};
};

TEST_F(Members, WhatOneFrameMakesThemAnswerGoesOutTogetherInTheirOrder) {
  Node a(sut, {kSyncId});
  Node b(sut, {kSyncId});
  add(a);
  add(b);
  a.on_frame = [&](const CanFrame&) { a.send(frame(0x181, {1})); };
  b.on_frame = [&](const CanFrame&) { b.send(frame(0x182, {2})); };
  sut.receive(frame(kSyncId, {}), clock.time);
  ASSERT_EQ(channel.calls.size(), 1U);
  EXPECT_EQ(channel.calls[0], (Frames{frame(0x181, {1}), frame(0x182, {2})}));
}

TEST_F(Members, MoreAnswersThanOneCallTakesAllGoOut) {
  Node a(sut, {kSyncId});
  Node b(sut, {kSyncId});
  add(a);
  add(b);
  a.on_frame = [&](const CanFrame&) {
    for (int i = 0; i < 100; ++i) a.send(frame(0x181, {i}));
  };
  sut.receive(frame(kSyncId, {}), clock.time);
  std::size_t sent = 0;
  for (const Frames& call : channel.calls) sent += call.size();
  EXPECT_EQ(sent, 100U);
  EXPECT_LE(channel.calls.size(), 2U);
}

TEST_F(Members, AFrameGoesOnlyToThoseThatTakeItsIdentifier) {
  Node a(sut, {kSyncId, 0x601});
  Node b(sut, {kSyncId, 0x602});
  add(a);
  add(b);
  sut.receive(frame(0x601, {}), clock.time);
  sut.receive(frame(0x603, {}), clock.time);
  sut.receive(frame(kSyncId, {}), clock.time);
  EXPECT_EQ(a.got, (std::vector<std::uint32_t>{0x601, kSyncId}));
  EXPECT_EQ(b.got, (std::vector<std::uint32_t>{kSyncId}));
}

TEST_F(Members, WhatOneSendsTheOthersHearAfterTheFrameThatItAnswers) {
  Node a(sut, {kSyncId, 0x181});
  Node b(sut, {kSyncId, 0x181});
  add(a);
  add(b);
  a.on_frame = [&](const CanFrame& got) {
    if (got.id == kSyncId) a.send(frame(0x181, {1}));
  };
  sut.receive(frame(kSyncId, {}), clock.time);
  EXPECT_EQ(b.got, (std::vector<std::uint32_t>{kSyncId}));
  ASSERT_TRUE(sut.has_waiting());
  sut.deliver_waiting();
  EXPECT_EQ(b.got, (std::vector<std::uint32_t>{kSyncId, 0x181}));
  EXPECT_EQ(a.got, (std::vector<std::uint32_t>{kSyncId})) << "nobody hears itself";
  EXPECT_FALSE(sut.has_waiting());
}

TEST_F(Members, WhatTheChannelRefusedNobodyHearsAndItsSenderCounts) {
  Node a(sut, {kSyncId});
  Node b(sut, {kSyncId, 0x181});
  add(a);
  add(b);
  channel.refused = 0x181;
  a.on_frame = [&](const CanFrame&) { a.send(frame(0x181, {1})); };
  sut.receive(frame(kSyncId, {}), clock.time);
  a.send(frame(0x181, {1}));
  EXPECT_EQ(a.refused, 2);
  EXPECT_EQ(b.refused, 0);
  EXPECT_FALSE(sut.has_waiting());
}

TEST_F(Members, TwoThatAnswerEachOtherForEverDoSoOnceACall) {
  Node a(sut, {0x182});
  Node b(sut, {0x181});
  add(a);
  add(b);
  a.on_frame = [&](const CanFrame&) { a.send(frame(0x181, {})); };
  b.on_frame = [&](const CanFrame&) { b.send(frame(0x182, {})); };
  sut.receive(frame(0x181, {}), clock.time);
  for (int i = 0; i < 10; ++i) sut.deliver_waiting();
  EXPECT_EQ(a.got.size() + b.got.size(), 11U);
}

TEST_F(Members, FramesThatWaitAreBoundedAndCounted) {
  Node a(sut, {});
  Node b(sut, {0x181});
  add(a);
  add(b);
  for (int i = 0; i < 5'000; ++i) a.send(frame(0x181, {}));
  EXPECT_EQ(channel.calls.size(), 5'000U) << "the bus has all of them";
  sut.deliver_waiting();
  EXPECT_EQ(b.got.size() + sut.dropped(), 5'000U);
  EXPECT_GT(b.got.size(), 100U);
}

TEST_F(Members, OtherIdentifiersAreInForceWithTheNextFrame) {
  Node a(sut, {0x201});
  add(a);
  a.on_frame = [&](const CanFrame&) {
    a.identifiers = {0x301};
    ++a.revision;
  };
  sut.receive(frame(0x201, {}), clock.time);
  sut.receive(frame(0x201, {}), clock.time);
  sut.receive(frame(0x301, {}), clock.time);
  EXPECT_EQ(a.got, (std::vector<std::uint32_t>{0x201, 0x301}));
}

TEST_F(Members, TheOneThatHasBeenDueLongestIsAdvancedFirst) {
  Node a(sut, {});
  Node b(sut, {});
  a.due = clock.time + 2ms;
  b.due = clock.time + 1ms;
  add(a);
  add(b);
  EXPECT_EQ(sut.next_due(), clock.time + 1ms);
  sut.advance_next(clock.time);
  EXPECT_TRUE(a.advanced.empty() && b.advanced.empty()) << "none is due";
  const Timestamp later = clock.time + 5ms;
  sut.advance_next(later);
  EXPECT_EQ(b.advanced.size(), 1U);
  EXPECT_TRUE(a.advanced.empty());
  sut.advance_next(later);
  EXPECT_EQ(a.advanced.size(), 1U);
  EXPECT_FALSE(sut.next_due().known());
}

TEST_F(Members, OneThatLeavesIsNotCalledAndItsPlaceIsUsedAgain) {
  Node a(sut, {kSyncId});
  Node b(sut, {kSyncId});
  Node c(sut, {kSyncId});
  add(a);
  add(b);
  sut.remove(a);
  sut.receive(frame(kSyncId, {}), clock.time);
  EXPECT_TRUE(a.got.empty());
  EXPECT_EQ(b.got.size(), 1U);
  add(c);
  sut.receive(frame(kSyncId, {}), clock.time);
  EXPECT_EQ(b.got.size(), 2U);
  EXPECT_EQ(c.got.size(), 1U);
}

TEST_F(Members, OnlyThoseThatWereCalledPublish) {
  Node a(sut, {0x601});
  Node b(sut, {0x602});
  add(a);
  add(b);
  sut.publish();
  sut.receive(frame(0x601, {}), clock.time);
  sut.publish();
  sut.publish();
  EXPECT_EQ(a.published, 2);
  EXPECT_EQ(b.published, 1);
}

}  // namespace
}  // namespace cellmirror::can
