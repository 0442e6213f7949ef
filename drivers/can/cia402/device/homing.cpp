#include "drivers/can/cia402/device/homing.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::can {
namespace {

constexpr int kWithoutIndex = 16;  // methods 17 to 30 are methods 1 to 14 without the index pulse
constexpr int kMostTurns = 2;      // at limit switches, before the search is given up

// Methods 1 to 14 (CiA 402-2, figures of the homing methods).
constexpr HomingMethod kWithIndex[] = {
    {HomingSwitch::negative_limit, -1, 1, 1, true},  // 1
    {HomingSwitch::positive_limit, 1, -1, -1, true},
    {HomingSwitch::home, 1, -1, -1, true},  // 3
    {HomingSwitch::home, 1, -1, 1, true},
    {HomingSwitch::home, -1, 1, 1, true},
    {HomingSwitch::home, -1, 1, -1, true},
    {HomingSwitch::home, 1, -1, -1, true},  // 7
    {HomingSwitch::home, 1, -1, 1, true},
    {HomingSwitch::home, 1, 1, -1, true},
    {HomingSwitch::home, 1, 1, 1, true},
    {HomingSwitch::home, -1, 1, 1, true},  // 11
    {HomingSwitch::home, -1, 1, -1, true},
    {HomingSwitch::home, -1, -1, 1, true},
    {HomingSwitch::home, -1, -1, -1, true},
};

}  // namespace

std::optional<HomingMethod> homing_method(int number) {
  if (number >= 1 && number <= 14) return kWithIndex[number - 1];
  if (number >= 1 + kWithoutIndex && number <= 14 + kWithoutIndex) {
    HomingMethod method = kWithIndex[number - 1 - kWithoutIndex];
    method.index = false;
    return method;
  }
  if (number == 33) return HomingMethod{.through = -1, .index = true};
  if (number == 34) return HomingMethod{.through = 1, .index = true};
  if (number == 35 || number == 37) return HomingMethod{};
  return {};
}

bool is_active(HomingSwitch which, const HomingInputs& inputs) {
  switch (which) {
    case HomingSwitch::none:
      return false;
    case HomingSwitch::negative_limit:
      return inputs.limit_switches && inputs.position <= inputs.limit_switches->lower;
    case HomingSwitch::positive_limit:
      return inputs.limit_switches && inputs.position >= inputs.limit_switches->upper;
    case HomingSwitch::home:
      return inputs.home_switch && inputs.position >= inputs.home_switch->lower &&
             inputs.position <= inputs.home_switch->upper;
  }
  return false;
}

void Homing::start(const HomingMethod& method, const MotionPoint& at, const HomingInputs& inputs, double fast,
                   double slow, double acceleration) {
  method_ = method;
  fast_ = fast;
  slow_ = slow;
  acceleration_ = acceleration;
  state_ = State::searching;
  at_ = at;
  turns_ = 0;
  const bool has_switch =
      method.search == HomingSwitch::home ? inputs.home_switch.has_value() : inputs.limit_switches.has_value();
  if (method.search != HomingSwitch::none && !has_switch) return finish(State::failed);
  if (method.search == HomingSwitch::none) {
    if (method.index) return at_edge(inputs);
    home_ = inputs.position;
    return finish(State::attained);
  }
  if (is_active(method.search, inputs)) {
    phase_ = Phase::leave_switch;
    return run(method.edge, method.edge == method.through ? slow : fast);
  }
  phase_ = Phase::find_switch;
  run(method.first, fast);
}

void Homing::enter(const MotionPoint& at, double acceleration) {
  at_ = at;
  acceleration_ = acceleration;
  finish(State::idle);
}

void Homing::shift(double position) {
  at_ = plan_.at(time_);
  at_.position = position;
  finish(state_);
}

void Homing::run(int direction, double speed) {
  direction_ = direction;
  plan_ = MotionPlan::to_velocity(at_, direction * speed, {speed, acceleration_, acceleration_});
  time_ = 0;
}

void Homing::finish(State state) {
  state_ = state;
  plan_ = MotionPlan::to_velocity(at_, 0, {1, acceleration_, acceleration_});
  time_ = 0;
}

MotionPoint Homing::step(double dt, const HomingInputs& inputs) {
  if (state_ == State::searching) look(inputs);
  time_ += dt;
  at_ = plan_.at(time_);
  return at_;
}

void Homing::look(const HomingInputs& inputs) {
  const bool active = is_active(method_.search, inputs);
  switch (phase_) {
    case Phase::find_switch:
      if (!active) return look_for_switch(inputs);
      phase_ = Phase::leave_switch;
      return run(method_.edge, method_.edge == method_.through ? slow_ : fast_);
    case Phase::leave_switch:
      if (active) return look_for_switch(inputs);
      if (method_.edge == method_.through) return at_edge(inputs);
      phase_ = Phase::cross_edge;
      return run(method_.through, slow_);
    case Phase::cross_edge:
      if (active) return at_edge(inputs);
      return;
    case Phase::find_index:
      if (direction_ * (inputs.position - next_index_) >= 0) {
        home_ = next_index_;
        return finish(State::attained);
      }
      return look_for_switch(inputs);
  }
}

// At a limit switch a search for a home switch turns round. A search for the limit switch itself, or for an index
// pulse, has nothing to find there.
void Homing::look_for_switch(const HomingInputs& inputs) {
  const auto limit = direction_ > 0 ? HomingSwitch::positive_limit : HomingSwitch::negative_limit;
  if (!is_active(limit, inputs) || method_.search == limit) return;
  const bool turns = phase_ == Phase::find_switch && method_.search == HomingSwitch::home;
  if (!turns || ++turns_ > kMostTurns) return finish(State::failed);
  run(-direction_, fast_);
}

double Homing::edge_position(const HomingInputs& inputs) const {
  switch (method_.search) {
    case HomingSwitch::negative_limit:
      return inputs.limit_switches->lower;
    case HomingSwitch::positive_limit:
      return inputs.limit_switches->upper;
    case HomingSwitch::home:
      return method_.edge < 0 ? inputs.home_switch->lower : inputs.home_switch->upper;
    case HomingSwitch::none:
      break;
  }
  return inputs.position;
}

void Homing::at_edge(const HomingInputs& inputs) {
  const double edge = edge_position(inputs);
  if (!method_.index) {
    home_ = edge;
    return finish(State::attained);
  }
  // The first pulse beyond the edge.
  const double count = edge / inputs.index_distance;
  next_index_ = inputs.index_distance * (method_.through > 0 ? std::floor(count) + 1 : std::ceil(count) - 1);
  phase_ = Phase::find_index;
  run(method_.through, slow_);
}

}  // namespace cellmirror::can
