// Foot switches when their memory is exchanged for another one.
#include "app/owner/foot_switch_service.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>
#include <string>

#include "tests/golden/scripts/quiet_host.hpp"

namespace cellmirror::app {
namespace {

struct SwitchDeskTest : ::testing::Test {
  SwitchDeskTest() {
    settings.key = 0x46000000 + static_cast<std::int32_t>(::getpid() & 0xffffff);
    settings.debounce = Nanoseconds(0);
    settings.online = true;
    sut.emplace(FootSwitchService::Options{settings, "test" + std::to_string(::getpid()), 0, {}}, runner, home, clock);
  }

  FootSwitchSettings settings;
  KismetHome home = KismetHome::open(::testing::TempDir()).value();
  SystemClock clock;
  testing::QuietHost host;
  script::ScriptRunner runner{host.host(), home, clock};
  std::optional<FootSwitchService> sut;
};

TEST_F(SwitchDeskTest, RunsWhatChangedJustBeforeAnotherMemoryCame) {
  for (std::size_t bytes = 1; bytes <= 10; ++bytes) {
    const auto made = bytes == 1 ? sut->prepare() : sut->set_memory(*settings.key, bytes);
    ASSERT_TRUE(made) << made.error().text();
    auto attached = AttachedSegment::attach(*settings.key, 1, false);
    ASSERT_TRUE(attached) << attached.error().text();
    __atomic_store_n(reinterpret_cast<std::uint8_t*>(attached->memory().data()), 1, __ATOMIC_RELAXED);
    ASSERT_TRUE(sut->set_memory(*settings.key, bytes + 1));
    EXPECT_EQ(sut->snapshot().edges, bytes);
    EXPECT_EQ(sut->snapshot().waiting, bytes);
  }
}

TEST_F(SwitchDeskTest, ForgetsScriptsThatWaitWhereEverythingIsStopped) {
  ASSERT_TRUE(sut->prepare());
  auto attached = AttachedSegment::attach(*settings.key, 1, false);
  ASSERT_TRUE(attached) << attached.error().text();
  __atomic_store_n(reinterpret_cast<std::uint8_t*>(attached->memory().data()), 1, __ATOMIC_RELAXED);
  ASSERT_TRUE(sut->set_memory(*settings.key, 2));
  ASSERT_EQ(sut->snapshot().waiting, 1U);
  sut->forget_waiting();
  EXPECT_EQ(sut->snapshot().waiting, 0U);
  EXPECT_FALSE(sut->busy());
}

}  // namespace
}  // namespace cellmirror::app
