// Workers take their findings away when there is nothing to find any more, and find anew what has changed: nothing that
// is old stays for good.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "app/owner/haptics/haptic_instrument.hpp"
#include "app/workers/collision_worker.hpp"
#include "app/workers/contact_worker.hpp"
#include "app/workers/force_worker.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

// A heavy ball on a linear axis.
constexpr const char* kHeavySledge = R"(
[[node]]
name = "X"
geometry = [{ name = "ball", sphere_m = 0.1 }]
body = { mass_kg = 10.0 }
[node.joint]
type = "prismatic"
axis = [0, 0, 1]
range_m = [-1.0, 1.0]
velocity_m_s = 1.5
acceleration_m_s2 = 3.0
[[node]]
name = "TOP"
parent = "X"
[robot]
id = "SLEDGE"
flange = "TOP"
)";

constexpr Nanoseconds kTick{1'000'000};

// The ball sits in a post. Ticks by hand.
struct FindingsWorkersTest : testing::Test {
  FindingsWorkersTest() {
    auto files = std::make_shared<TextFiles>();
    files->add("sledge.mpc", kHeavySledge);
    Diagnostics diagnostics;
    cell = build_cell(
        "[[node]]\nname = \"Sledge\"\nabstract = \"sledge.mpc\"\n"
        "[[node]]\nname = \"Post\"\ngeometry = [{ name = \"post\", box_m = [0.1, 0.1, 0.1] }]\n",
        files, diagnostics);
    EXPECT_TRUE(cell) << diagnostics.text();
    engine::RobotSetup setup;
    setup.joint_count = 1;
    setup.limits.lower.fill(-1.0);
    setup.limits.upper.fill(1.0);
    engine.send(engine::AddRobot{.slot = static_cast<std::uint8_t>(cell->robot("SLEDGE")->slot()),
                                 .robot = engine.lend(std::make_shared<const engine::RobotSetup>(setup))});
    publish(settings);
  }

  void publish(const collision::Settings& with) {
    auto cell_state = std::make_shared<CellState>();
    cell_state->cell = cell->compile();
    cell_state->collision = std::make_shared<const collision::Settings>(with);
    cell_state->haptics = devices;
    if (contacts) {
      RobotSnapshot robot;
      robot.id = "SLEDGE";
      robot.slot = cell->robot("SLEDGE")->slot();
      robot.contacts = contacts;
      cell_state->robots.push_back(robot);
    }
    cell_states.publish(cell_state);
  }

  // Lets ticks pass until the condition holds; false: it never does.
  bool comes(const std::function<bool()>& condition) {
    const Timestamp end = clock.now() + std::chrono::seconds(30);
    while (!condition()) {
      if (clock.now() > end) return false;
      CycleContext context;
      context.now = context.scheduled = clock.now();
      context.cycle = cycle++;
      context.period = kTick;
      engine.run(context);
      std::this_thread::sleep_for(kTick);
    }
    return true;
  }

  SystemClock clock;
  Watchdog watchdog{std::chrono::seconds(100), {}};
  engine::Engine engine{watchdog};
  engine::TickReader& ticks = engine.subscribe("test");
  std::uint64_t cycle = 0;
  std::optional<Cell> cell;
  collision::Settings settings;
  std::vector<HapticSnapshot> devices;
  std::shared_ptr<ContactInlet> contacts;  // of the sledge; null: it feels nothing
  Board<CellState> cell_states;
};

struct CollisionWorkerTest : FindingsWorkersTest {
  bool touches() {
    const auto found = sut.board().latest();
    return found && found->pairs == 1 && found->touching.size() == 1;
  }
  bool shows_nothing() {
    const auto found = sut.board().latest();
    return found && found->pairs == 0 && found->touching.empty() && found->near.empty();
  }
  CollisionWorker sut{ticks, cell_states, clock, kTick, std::make_shared<geometry::SolidLibrary>()};
};

TEST_F(CollisionWorkerTest, TellsTheDrivesOfARobotWhatItTouches) {
  contacts = std::make_shared<ContactInlet>();
  // On the post, so that the shortest way out is along the axis.
  engine::SetPositions above{.slot = static_cast<std::uint8_t>(cell->robot("SLEDGE")->slot()), .positions = {0.12}};
  ASSERT_NE(engine.send(engine::Command(above)), 0U);
  publish(settings);
  ASSERT_TRUE(comes([this] { return contacts->read().value.count == 1; }));
  const RobotContacts& told = contacts->read().value;
  EXPECT_NEAR(told.rates[0][0], -1, 1e-9) << "it leaves the post upwards";
  EXPECT_GT(told.posture_time, Timestamp{});
  settings.active = false;
  publish(settings);
  EXPECT_TRUE(comes([this] { return contacts->read().value.count == 0; })) << "nothing is tested any more";
}

TEST_F(CollisionWorkerTest, ShowsNothingWhileTestsAreSwitchedOff) {
  ASSERT_TRUE(comes([this] { return touches(); }));
  const auto last = sut.board().latest();
  settings.active = false;
  publish(settings);
  ASSERT_TRUE(comes([this] { return shows_nothing(); }));
  EXPECT_GT(sut.board().latest()->sequence, last->sequence) << "whoever follows the numbers hears of it";
  EXPECT_GE(sut.board().latest()->posture_time, last->posture_time);
  settings.active = true;
  publish(settings);
  EXPECT_TRUE(comes([this] { return touches(); }));
}

TEST_F(CollisionWorkerTest, ShowsNothingWhenTheLastPairIsTestedNoMore) {
  ASSERT_TRUE(comes([this] { return touches(); }));
  settings.rules = {{"Post", "Sledge", collision::PairRule::Kind::ignore, ""}};
  publish(settings);
  EXPECT_TRUE(comes([this] { return shows_nothing(); }));
  settings.rules.clear();
  publish(settings);
  ASSERT_TRUE(comes([this] { return touches(); }));
  ASSERT_TRUE(cell->delete_node("Sledge"));
  publish(settings);
  EXPECT_TRUE(comes([this] { return shows_nothing(); }));
}

struct SilentDevice final : HapticDevicePort {
  HapticRead read(HapticSample& /*sample*/) CELL_RT override { return HapticRead::none; }
  void write(const HapticOutput& /*output*/) CELL_RT override {}
};

struct ContactWorkerTest : FindingsWorkersTest {
  ContactWorkerTest() {
    auto made = make_instrument(*cell, *cell->robot("SLEDGE"), {}, cell->start_positions());
    EXPECT_TRUE(made) << made.error().text();
    instrument = *made;
    engine.send(engine::OpenHaptic{.channel = 0,
                                   .instrument = engine.lend(instrument),
                                   .device = engine.lend<HapticDevicePort>(std::make_shared<SilentDevice>())});
    HapticSnapshot haptic;
    haptic.slot = instrument->slot;
    haptic.online = true;
    haptic.reach_m = 0.01;
    devices.push_back(haptic);
    publish(settings);
  }
  haptics::ContactModel newest() { return sut.report().newest[0]; }

  std::shared_ptr<const haptics::Instrument> instrument;
  ContactWorker sut{engine, ticks, cell_states, clock, kTick, std::make_shared<geometry::SolidLibrary>()};
};

TEST_F(ContactWorkerTest, FindsThePlanesForTheNewToolCentrePoint) {
  ASSERT_TRUE(comes([this] { return newest().sequence > 0; }));
  const Eigen::Vector3d expected = newest().x_ref + Eigen::Vector3d(0, 0, 0.02);
  ASSERT_TRUE(cell->edit_robot("SLEDGE")->set_tool_center_point(pose_from_xyz_rpy({0, 0, 0.02}, {0, 0, 0})));
  publish(settings);
  EXPECT_TRUE(comes([&] { return (newest().x_ref - expected).norm() < 1e-9; })) << newest().x_ref.transpose();
}

TEST_F(FindingsWorkersTest, ForcesOfTheLastRobotGoWithIt) {
  ForceWorker sut(ticks, cell_states, clock, kTick, Eigen::Vector3d(0, 0, -9.80665));
  ASSERT_TRUE(comes([&] {
    const auto found = sut.board().latest();
    return found && found->robots.size() == 1;
  }));
  const auto last = sut.board().latest();
  ASSERT_TRUE(cell->delete_node("Sledge"));
  publish(settings);
  ASSERT_TRUE(comes([&] { return sut.board().latest()->robots.empty(); }));
  EXPECT_GT(sut.board().latest()->sequence, last->sequence);
}

}  // namespace
}  // namespace cellmirror::app
