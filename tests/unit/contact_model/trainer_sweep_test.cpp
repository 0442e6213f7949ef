// The phantom trainer cell: a proxy that obeys old contact models does not enter the phantom, shafts have levers, and
// what the other hand or a foot switch changes is followed.
#include <gtest/gtest.h>

#include <random>

#include "rt_core/haptics/proxy.hpp"
#include "tests/unit/contact_model/trainer.hpp"

namespace cellmirror::contact_model {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;     // s
constexpr double kBound = 2e-4;    // m, that the instrument may enter anything by
constexpr double kTypical = 1e-4;  // m, in 99 of 100 ticks

struct Sweep {
  std::vector<double> depths;  // m, by tick
  int touching = 0;            // ticks
  int uncertain = 0;           // models
  std::string where;           // of the deepest
};

struct TrainerContacts : testing::Test {
  TrainerContacts() { sut.adopt(trainer.compiled, trainer.pairs); }

  // Follows the hand along `way`; a model is found at every `age`-th tick, from the posture at the end of the tick
  // before, so that models are 1 to `age` ticks old.
  Sweep follow(const std::vector<Vector3d>& way, double speed, int age) {
    Sweep out;
    haptics::Proxy proxy;
    haptics::ContactModel model;
    Vector3d hand = way.front();
    double deepest = -1;
    trainer.pose();
    trainer.move_tip(trainer.left, hand);
    trainer.pose();
    proxy.start(hand);
    std::size_t goal = 1;
    for (int tick = 0; goal < way.size(); ++tick) {
      Vector3d step = way[goal] - hand;
      if (step.norm() <= speed * kTick) {
        ++goal;
      } else {
        step *= speed * kTick / step.norm();
      }
      hand += step;
      if (tick % age == 0) {
        sut.find(trainer.poses, Timestamp{tick}, model);
        out.uncertain += model.certain ? 0 : 1;
      }
      out.touching += proxy.follow(&model, hand, {}, 3.0 * kTick).contacts > 0 ? 1 : 0;
      trainer.move_tip(trainer.left, proxy.x());
      trainer.pose();
      out.depths.push_back(trainer.depth(trainer.left));
      if (out.depths.back() > deepest) out.where = trainer.where;
      deepest = std::max(deepest, out.depths.back());
    }
    return out;
  }

  // Points around a middle, each reached from the last in a straight line: through whatever is there.
  static std::vector<Vector3d> through(const Vector3d& middle, const Vector3d& half, unsigned seed, std::size_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    std::vector<Vector3d> way{{0.0, 0.0, 0.10}};
    while (way.size() < count) {
      way.push_back(middle + half.cwiseProduct(Vector3d(part(random), part(random), part(random))));
    }
    return way;
  }
  void expect_outside(Sweep sweep, double bound) {
    ASSERT_GT(sweep.touching, 200);
    EXPECT_EQ(sweep.uncertain, 0);
    std::ranges::sort(sweep.depths);
    EXPECT_LT(sweep.depths.back(), bound) << sweep.where;
    EXPECT_LT(sweep.depths[sweep.depths.size() * 99 / 100], kTypical);
    RecordProperty("deepest_um", static_cast<int>(1e6 * sweep.depths.back()));
  }

  Trainer trainer;
  ContactFinder sut{trainer.left, {}};
};

TEST_F(TrainerContacts, TheOrganIsNotEnteredAtAnySpeed) {
  const auto way = through({0.0, 0.01, 0.05}, {0.05, 0.04, 0.025}, 7, 16);
  for (const auto& [speed, age] : {std::pair(0.1, 1), {0.2, 5}, {0.5, 1}, {0.5, 2}, {0.5, 5}}) {
    SCOPED_TRACE(testing::Message() << speed << " m/s, models up to " << age << " ms old");
    expect_outside(follow(way, speed, age), kBound);
  }
}

TEST_F(TrainerContacts, NorAreTheTubeThePegsAndThePlate) {
  // The left instrument reaches the board with its pegs, and with its shaft the organ.
  const auto way = through({-0.08, 0.05, 0.012}, {0.03, 0.03, 0.018}, 11, 16);
  for (const auto& [speed, age] : {std::pair(0.2, 2), {0.5, 5}}) {
    SCOPED_TRACE(testing::Message() << speed << " m/s, models up to " << age << " ms old");
    expect_outside(follow(way, speed, age), kBound);
  }
  ContactFinder other{trainer.left, {}};
  const auto tube = through({0.095, 0.035, 0.028}, {0.02, 0.02, 0.02}, 13, 12);
  expect_outside(follow(tube, 0.2, 2), kBound);
}

TEST_F(TrainerContacts, AConstraintsLeverIsHowItsPointMoves) {
  haptics::ContactModel model;
  trainer.pose();
  const auto roll = static_cast<std::size_t>(trainer.compiled->robot(trainer.left)->joint_nodes[3]);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  int at_tip = 0;
  int at_shaft = 0;
  for (const Vector3d& x : through({0.0, 0.05, 0.02}, {0.05, 0.05, 0.03}, 5, 200)) {
    trainer.move_tip(trainer.left, x);
    trainer.pose();
    sut.find(trainer.poses, Timestamp{}, model);
    EXPECT_LT((model.x_ref - x).norm(), 1e-12);
    const Pose before = trainer.poses.X_WN[roll];
    const Vector3d step = 1e-5 * Vector3d(part(random), part(random), part(random));
    trainer.move_tip(trainer.left, x + step);
    trainer.pose();
    const Pose moved = trainer.poses.X_WN[roll] * before.inverse();
    for (std::size_t i = 0; i < model.count; ++i) {
      const haptics::ContactConstraint& c = model.constraints[i];
      const double real = c.normal.dot(moved * c.point - c.point);
      // To first order in the step.
      ASSERT_NEAR(c.a.dot(step), real, 2e-8) << (c.point - x).norm();
      const double away = (c.point - x).norm();
      at_tip += away < 0.003 ? 1 : 0;
      at_shaft += away > 0.05 ? 1 : 0;
      if (away < 0.003) {
        EXPECT_NEAR(c.a.norm(), 1.0, 0.05);
      }
    }
  }
  EXPECT_GT(at_tip, 20);
  EXPECT_GT(at_shaft, 20);
}

TEST_F(TrainerContacts, AFootSwitchTakesTheOrganAway) {
  haptics::ContactModel model;
  trainer.pose();
  for (double z = 0.09; z > 0.05 && model.count == 0; z -= 0.002) {
    trainer.move_tip(trainer.left, {-0.02, 0.01, z});
    trainer.pose();
    sut.find(trainer.poses, Timestamp{}, model);
  }
  ASSERT_GT(model.count, 0);
  ASSERT_TRUE(trainer.cell().deactivate("Phantom.Organ"));
  trainer.refresh();
  sut.adopt(trainer.compiled, trainer.pairs);
  trainer.pose();
  sut.find(trainer.poses, Timestamp{}, model);
  EXPECT_EQ(model.count, 0);
  EXPECT_GT(model.sequence, 0U);
  ASSERT_TRUE(trainer.cell().activate("Phantom.Organ"));
  trainer.refresh();
  sut.adopt(trainer.compiled, trainer.pairs);
  trainer.pose();
  sut.find(trainer.poses, Timestamp{}, model);
  EXPECT_GT(model.count, 0);
}

TEST_F(TrainerContacts, TheOtherHandsInstrumentIsFelt) {
  haptics::ContactModel model;
  trainer.pose();
  trainer.move_tip(trainer.left, {0.0, 0.0, 0.11});
  for (int i = 0; i < 10; ++i) {
    trainer.move_tip(trainer.right, {0.008 - 0.0005 * i, 0.0, 0.11});
    trainer.pose();
    sut.find(trainer.poses, Timestamp{}, model);
    ASSERT_GT(model.count, 0) << i;
    EXPECT_LT(model.constraints[0].normal.x(), -0.3) << i;
    EXPECT_LT(model.constraints[0].gap, 0.008 - 0.0005 * i);
  }
}

}  // namespace
}  // namespace cellmirror::contact_model
