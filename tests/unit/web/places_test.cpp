#include "ipc/web/places.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace cellmirror::web {
namespace {

TEST(Places, OfOneUserEndBeforeThoseOfTheServer) {
  Places sut;
  std::vector<std::shared_ptr<void>> taken;
  for (std::size_t i = 0; i < kMaxWebSocketsPerUser; ++i) {
    taken.push_back(sut.take("uid 1000", false));
    ASSERT_TRUE(taken.back()) << i;
  }
  EXPECT_FALSE(sut.take("uid 1000", false));
  EXPECT_TRUE(sut.take("uid 1001", false)) << "another user still gets one";
  EXPECT_TRUE(sut.take("uid 1000", true)) << "a client with the token is not counted by user";
  taken.pop_back();
  EXPECT_TRUE(sut.take("uid 1000", false)) << "there is room again";
}

TEST(Places, AreKeptForTheToken) {
  Places sut;
  std::vector<std::shared_ptr<void>> taken;
  for (std::size_t i = 0; i + 1 < kMaxWebSockets; ++i) {
    taken.push_back(sut.take("10.0.0." + std::to_string(i), false));
    ASSERT_TRUE(taken.back()) << i;
  }
  EXPECT_FALSE(sut.take("10.0.0.100", false)) << "the last one is kept";
  taken.push_back(sut.take("10.0.0.0", true));
  EXPECT_TRUE(taken.back());
  EXPECT_FALSE(sut.take("10.0.0.100", true)) << "all are taken";
  taken.erase(taken.begin());
  EXPECT_TRUE(sut.take("10.0.0.100", false));
}

}  // namespace
}  // namespace cellmirror::web
