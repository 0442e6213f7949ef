// Who takes which frame of a channel.
#include "drivers/can/stream/identifier_routes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using Listeners = std::vector<CanListener>;

Listeners takers(const IdentifierRoutes& routes, const CanFrame& frame) {
  const auto found = routes.of(frame);
  return {found.begin(), found.end()};
}

TEST(IdentifierRoutes, NobodyTakesAnythingAtFirst) {
  IdentifierRoutes sut;
  EXPECT_TRUE(sut.of(frame(0x080, {})).empty());
  sut.build();
  EXPECT_TRUE(sut.of(frame(0x7FF, {})).empty());
  EXPECT_TRUE(sut.of(extended_frame(0x1FFFFFFF, {})).empty());
}

TEST(IdentifierRoutes, GivesAFrameToThoseOfItsIdentifierInTheirOrder) {
  IdentifierRoutes sut;
  sut.add({0, 0}, std::array<std::uint32_t, 3>{0x000, 0x601, 0x7FF});
  sut.add({0, 1}, std::array<std::uint32_t, 2>{0x000, 0x602});
  sut.add({1, 0}, std::array<std::uint32_t, 4>{0x000, 0x603, 0x000, 0x800});
  sut.build();
  EXPECT_EQ(takers(sut, frame(0x000, {})), (Listeners{{0, 0}, {0, 1}, {1, 0}})) << "once each";
  EXPECT_EQ(takers(sut, frame(0x602, {})), (Listeners{{0, 1}}));
  EXPECT_EQ(takers(sut, frame(0x7FF, {})), (Listeners{{0, 0}}));
  EXPECT_TRUE(takers(sut, frame(0x604, {})).empty());
  EXPECT_TRUE(takers(sut, extended_frame(0x602, {})).empty()) << "29 bits";
}

TEST(IdentifierRoutes, WhoTakesAllGetsEveryFrameLast) {
  IdentifierRoutes sut;
  sut.add_all({2, 0});
  sut.add({1, 0}, std::array<std::uint32_t, 1>{0x080});
  sut.build();
  EXPECT_EQ(takers(sut, frame(0x080, {})), (Listeners{{1, 0}, {2, 0}}));
  EXPECT_EQ(takers(sut, frame(0x123, {})), (Listeners{{2, 0}}));
  EXPECT_EQ(takers(sut, extended_frame(0x12345678, {})), (Listeners{{2, 0}}));
}

TEST(IdentifierRoutes, ForgetsWhatItWasTold) {
  IdentifierRoutes sut;
  sut.add_all({0, 0});
  sut.build();
  sut.clear();
  sut.add({1, 0}, std::array<std::uint32_t, 1>{0x080});
  EXPECT_EQ(takers(sut, frame(0x123, {})), (Listeners{{0, 0}})) << "until build()";
  sut.build();
  EXPECT_TRUE(takers(sut, frame(0x123, {})).empty());
  EXPECT_EQ(takers(sut, frame(0x080, {})), (Listeners{{1, 0}}));
}

}  // namespace
}  // namespace cellmirror::can
