// A proxy that obeys old contact models does not enter the phantom: hands up to 0.5 m/s, models 1 to 5 ms old.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <random>

#include "rt_core/haptics/proxy.hpp"
#include "tests/unit/contact_model/trainer.hpp"

namespace cellmirror::contact_model {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;  // s

struct Sweep {
  std::string where;
  double deepest = -1.0;  // m
  int touching_ticks = 0;
  int short_models = 0;
  int uncertain = 0;
  int models = 0;
  double least_reach = 1.0;
  double largest_turn = 0;  // rad, of the force's direction from tick to tick, while pressed
};

struct TrainerSweep : testing::Test {
  TrainerSweep() { sut.adopt(trainer.compiled, trainer.pairs); }

  // Follows the hand through `way` at `speed`; a model is taken from the posture at every `age`-th tick and used from
  // the next tick on until the next one.
  Sweep run(const std::vector<Vector3d>& way, double speed, int age) {
    Sweep out;
    haptics::Proxy proxy;
    haptics::ContactModel model;
    Vector3d hand = way.front();
    trainer.pose();
    trainer.move_tip(trainer.left, hand);
    trainer.pose();
    proxy.start(hand);
    sut.find(trainer.poses, Timestamp{}, model);
    std::size_t goal = 1;
    Vector3d last_direction = Vector3d::Zero();
    for (int tick = 0; goal < way.size(); ++tick) {
      Vector3d step = way[goal] - hand;
      if (step.norm() <= speed * kTick)
        ++goal;
      else
        step *= speed * kTick / step.norm();
      hand += step;
      if (tick % age == 0) {
        sut.find(trainer.poses, Timestamp{tick}, model);  // of the posture at the end of the last tick
        ++out.models;
        out.short_models += model.reach < 0.005 ? 1 : 0;
        out.uncertain += model.certain ? 0 : 1;
        out.least_reach = std::min(out.least_reach, model.reach);
      }
      const haptics::ProxyContact contact = proxy.follow(&model, hand, {}, 0.003);
      trainer.move_tip(trainer.left, proxy.x());
      trainer.pose();
      if (const double depth = trainer.depth(trainer.left); depth > out.deepest) {
        out.deepest = depth;
        out.where = trainer.where;
        if (depth > 1e-4) std::printf("tick %d age %d depth %.1f um %s moved from x_ref %.3f mm reach %.3f count %d dhand %.2f mm\n", tick, tick % age, 1e6 * depth, trainer.where.c_str(), 1e3 * (proxy.x() - model.x_ref).norm(), 1e3 * model.reach, model.count, 1e3 * (proxy.x() - hand).norm());
      }
      if (contact.contacts == 0) {
        last_direction.setZero();
        continue;
      }
      ++out.touching_ticks;
      const Vector3d direction = contact.elongation.normalized();
      if (!last_direction.isZero() && contact.elongation.norm() > 1e-3) {
        out.largest_turn = std::max(out.largest_turn, std::acos(std::min(1.0, direction.dot(last_direction))));
      }
      last_direction = direction;
    }
    return out;
  }

  // Points on and below the surface of the organ, each reached from the last in a straight line.
  std::vector<Vector3d> over_the_organ(unsigned seed, std::size_t points) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(-0.05, 0.05);
    std::uniform_real_distribution<double> y(-0.03, 0.05);
    std::uniform_real_distribution<double> z(0.025, 0.075);
    std::vector<Vector3d> way{{0.0, 0.0, 0.10}};
    while (way.size() < points) way.push_back({x(random), y(random), z(random)});
    return way;
  }

  Trainer trainer;
  ContactFinder sut{trainer.left, {}};
};

TEST_F(TrainerSweep, StaysOutOfTheOrgan) {
  for (const double speed : {0.2, 0.5}) {
    for (const int age : {2, 5}) {
      const Sweep sweep = run(over_the_organ(7, 30), speed, age);
      std::printf(
          "speed %.2f age %d: deepest %.1f um, touching %d, models %d, short %d, least reach %.2f mm, uncertain %d, "
          "turn %.3f\n",
          speed, age, 1e6 * sweep.deepest, sweep.touching_ticks, sweep.models, sweep.short_models,
          1e3 * sweep.least_reach, sweep.uncertain, sweep.largest_turn);
    }
  }
}

TEST_F(TrainerSweep, Timing) {
  haptics::ContactModel model;
  std::vector<double> times;
  trainer.pose();
  for (const Vector3d& x : over_the_organ(3, 2000)) {
    trainer.move_tip(trainer.left, x);
    trainer.pose();
    const auto start = std::chrono::steady_clock::now();
    sut.find(trainer.poses, Timestamp{}, model);
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::ranges::sort(times);
  std::printf("median %.0f us, p99 %.0f us, max %.0f us, overlaps %lu\n", 1e6 * times[times.size() / 2],
              1e6 * times[times.size() * 99 / 100], 1e6 * times.back(),
              static_cast<unsigned long>(sut.counters().overlaps));
}

}  // namespace
}  // namespace cellmirror::contact_model
