#include "rt_core/tissue/contact/constraint_system.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// 1/kg: a point that seems heavier than this does not move.
constexpr double kImmovable = 1e-9;
constexpr double kSettled = 1e-6;  // m/s

}  // namespace

void ConstraintSystem::clear() {
  nodes_.clear();
  states_.clear();
  terms_.clear();
  pushes_.clear();
  holds_.clear();
  open_ = 0;
  if (++round_ == 0) {
    for (auto& object : places_) std::ranges::fill(object, Place{});
    round_ = 1;
  }
}

std::uint32_t ConstraintSystem::node(std::uint32_t object, std::uint32_t index, const Vector3d& velocity,
                                     double inverse_mass) {
  if (places_.size() <= object) places_.resize(object + 1U);
  auto& places = places_[object];
  if (places.size() <= index) places.resize(std::max<std::size_t>(index + 1U, 2 * places.size()));
  Place& place = places[index];
  if (place.round != round_) {
    place = {round_, static_cast<std::uint32_t>(nodes_.size())};
    nodes_.push_back({object, index, velocity, Vector3d::Zero()});
    states_.emplace_back(velocity.x(), velocity.y(), velocity.z(), inverse_mass);
  }
  return place.at;
}

void ConstraintSystem::add_term(std::uint32_t node, double weight) {
  for (std::size_t i = open_; i < terms_.size(); ++i) {
    if (terms_[i].node == node) {
      terms_[i].weight += weight;
      return;
    }
  }
  terms_.push_back({.node = node, .weight = weight});
}

template <class Row>
ConstraintSystem::Entry<Row> ConstraintSystem::take_terms(const Row& row) {
  Entry<Row> entry{.row = row, .first = open_, .count = static_cast<std::uint32_t>(terms_.size()) - open_};
  for (std::size_t i = open_; i < terms_.size(); ++i) {
    terms_[i].yielding = terms_[i].weight * states_[terms_[i].node][3];
    entry.inverse_mass += terms_[i].weight * terms_[i].yielding;
  }
  entry.movable = entry.inverse_mass > kImmovable;
  open_ = static_cast<std::uint32_t>(terms_.size());
  return entry;
}

std::size_t ConstraintSystem::add(const Push& push) {
  pushes_.push_back(take_terms(push));
  return pushes_.size() - 1;
}

std::size_t ConstraintSystem::add(const Hold& hold) {
  holds_.push_back(take_terms(hold));
  return holds_.size() - 1;
}

template <class Row>
Vector3d ConstraintSystem::relative_velocity(const Entry<Row>& entry) const {
  Vector4d v = Vector4d::Zero();  // and a sum of masses without meaning
  for (std::uint32_t i = entry.first; i < entry.first + entry.count; ++i) {
    v += terms_[i].weight * states_[terms_[i].node];
  }
  return v.head<3>() - entry.row.velocity;
}

template <class Row>
void ConstraintSystem::apply(const Entry<Row>& entry, const Vector3d& impulse) {
  const Vector4d change(impulse.x(), impulse.y(), impulse.z(), 0.0);
  for (std::uint32_t i = entry.first; i < entry.first + entry.count; ++i) {
    states_[terms_[i].node] += terms_[i].yielding * change;
  }
}

template <class Row>
void ConstraintSystem::add_impulse(const Entry<Row>& entry, const Vector3d& impulse) {
  for (std::uint32_t i = entry.first; i < entry.first + entry.count; ++i) {
    nodes_[terms_[i].node].impulse += terms_[i].weight * impulse;
  }
}

double ConstraintSystem::sweep(Entry<Push>& entry) {
  Push& row = entry.row;
  const Vector3d v = relative_velocity(entry);
  const double normal_speed = row.normal.dot(v);
  const double wanted =
      row.impulse - (normal_speed - row.bias + row.softness * row.impulse) / (entry.inverse_mass + row.softness);
  const double impulse = std::clamp(wanted, 0.0, row.most);
  Vector3d change = (impulse - row.impulse) * row.normal;
  row.impulse = impulse;
  if (row.friction > 0) {
    // The tangential velocity is not changed by the normal impulse: the mass seen at a point has no direction.
    Vector3d tangential = row.tangential - (v - normal_speed * row.normal) / entry.inverse_mass;
    const double most = row.friction * impulse;
    const double sliding = tangential.norm();
    if (sliding > most) tangential *= most / sliding;
    change += tangential - row.tangential;
    row.tangential = tangential;
  }
  const double size = change.norm();
  if (size > 0) apply(entry, change);
  return size * entry.inverse_mass;
}

double ConstraintSystem::sweep(Entry<Hold>& entry) {
  Hold& row = entry.row;
  const double softness = row.softness * entry.inverse_mass;
  Vector3d impulse =
      row.impulse - (relative_velocity(entry) + softness * row.impulse) / (entry.inverse_mass + softness);
  const double size = impulse.norm();
  row.limited = size > row.most;
  if (row.limited) impulse *= row.most / size;
  const Vector3d change = impulse - row.impulse;
  apply(entry, change);
  row.impulse = impulse;
  return change.norm() * entry.inverse_mass;
}

void ConstraintSystem::solve(std::uint32_t sweeps) {
  for (Entry<Push>& entry : pushes_) {
    Push& row = entry.row;
    row.impulse = entry.movable ? std::clamp(row.impulse, 0.0, row.most) : 0.0;
    row.tangential -= row.normal.dot(row.tangential) * row.normal;
    const double most = row.friction * row.impulse;
    const double size = row.tangential.norm();
    if (size > most) row.tangential *= most / size;
    apply(entry, row.impulse * row.normal + row.tangential);
  }
  for (Entry<Hold>& entry : holds_) {
    if (!entry.movable || entry.row.impulse.norm() > entry.row.most) entry.row.impulse.setZero();
    apply(entry, entry.row.impulse);
  }
  double largest = kSettled * 2;
  for (std::uint32_t i = 0; i < sweeps && largest > kSettled; ++i) {
    largest = 0;
    for (Entry<Hold>& entry : holds_) {
      if (entry.movable) largest = std::max(largest, sweep(entry));
    }
    for (Entry<Push>& entry : pushes_) {
      if (entry.movable) largest = std::max(largest, sweep(entry));
    }
  }
  for (const Entry<Push>& entry : pushes_)
    add_impulse(entry, entry.row.impulse * entry.row.normal + entry.row.tangential);
  for (const Entry<Hold>& entry : holds_) add_impulse(entry, entry.row.impulse);
}

}  // namespace cellmirror::tissue
