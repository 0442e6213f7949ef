#include "rt_core/tissue/effects/pool.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kWaveSpeed = 0.25;    // m/s, of ripples of some centimetres in shallow water
constexpr double kWaveDamping = 1.2;   // 1/s
constexpr double kStillBelow = 1e-6;   // m and m/s
constexpr double kHighestWave = 0.01;  // m
constexpr std::array<float, 4> kBlood{0.45F, 0.02F, 0.02F, 0.92F};

}  // namespace

Pool::Pool(const PoolDescription& description, const Pose& X_WP)
    : present_(true),
      description_(description),
      X_WP_(X_WP),
      heights_(static_cast<std::size_t>(kColumns) * kColumns, 0.0),
      speeds_(heights_.size(), 0.0) {
  reset();
}

void Pool::reset() {
  level_ = description_.level_m;
  blood_ = 0;
  flatten();
}

void Pool::flatten() {
  moving_ = false;
  std::ranges::fill(heights_, 0.0);
  std::ranges::fill(speeds_, 0.0);
}

bool Pool::over(const Vector3d& p_W, double& depth) const {
  if (!present_) return false;
  const Vector3d p = X_WP_.inverse() * p_W;
  depth = level_ - p.z();
  return 2 * std::abs(p.x()) <= description_.size_m.x() && 2 * std::abs(p.y()) <= description_.size_m.y();
}

void Pool::add(double volume_m3, double blood) {
  if (!present_ || !(volume_m3 > 0)) return;
  const double before = level_ * area();
  blood_ = (blood_ * before + blood * volume_m3) / (before + volume_m3);
  level_ = std::min(level_ + volume_m3 / area(), description_.max_level_m);
}

void Pool::remove(double volume_m3) {
  if (present_) level_ = std::max(0.0, level_ - volume_m3 / area());
}

void Pool::disturb(const Vector3d& p_W, double speed_m_s, double radius_m) {
  if (!present_) return;
  const Vector3d p = X_WP_.inverse() * p_W;
  const double dx = description_.size_m.x() / (kColumns - 1);
  const double dy = description_.size_m.y() / (kColumns - 1);
  const double radius = std::max({radius_m, dx, dy});
  const double x = p.x() + 0.5 * description_.size_m.x();
  const double y = p.y() + 0.5 * description_.size_m.y();
  const auto first = [&](double at, double step) {
    return std::clamp(static_cast<int>((at - radius) / step), 0, kColumns - 1);
  };
  const auto last = [&](double at, double step) {
    return std::clamp(static_cast<int>((at + radius) / step) + 1, 0, kColumns - 1);
  };
  for (int row = first(y, dy); row <= last(y, dy); ++row) {
    for (int column = first(x, dx); column <= last(x, dx); ++column) {
      const double r = std::hypot(column * dx - x, row * dy - y) / radius;
      if (r >= 1) continue;
      // Zero mean over its disc: fluid is moved aside, not made.
      speeds_[cell(column, row)] += speed_m_s * (1 - r) * (1 - 2 * r);
      moving_ = true;
    }
  }
}

void Pool::step(double dt) {
  if (!moving_) return;
  const double dx = description_.size_m.x() / (kColumns - 1);
  const double dy = description_.size_m.y() / (kColumns - 1);
  // Courant's limit in two dimensions bounds the speed for small pools.
  const double c = std::min(kWaveSpeed, 0.5 * std::min(dx, dy) / dt);
  const double cx = c * c / (dx * dx);
  const double cy = c * c / (dy * dy);
  const double damping = 1.0 / (1.0 + kWaveDamping * dt);
  const auto height = [&](int column, int row) {
    return heights_[cell(std::clamp(column, 0, kColumns - 1), std::clamp(row, 0, kColumns - 1))];  // walls reflect
  };
  for (int row = 0; row < kColumns; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double h = heights_[cell(column, row)];
      const double curvature = cx * (height(column - 1, row) + height(column + 1, row) - 2 * h) +
                               cy * (height(column, row - 1) + height(column, row + 1) - 2 * h);
      double& speed = speeds_[cell(column, row)];
      speed = damping * (speed + dt * curvature);
    }
  }
  double largest = 0;
  double mean = 0;
  for (std::size_t i = 0; i < heights_.size(); ++i) {
    heights_[i] = std::clamp(heights_[i] + dt * speeds_[i], -kHighestWave, kHighestWave);
    largest = std::max({largest, std::abs(heights_[i]), std::abs(speeds_[i])});
    mean += heights_[i];
  }
  mean /= static_cast<double>(heights_.size());
  for (double& h : heights_) h -= mean;
  if (largest < kStillBelow) flatten();
}

void Pool::view(TissuePool& pool) const {
  pool.present = present_;
  if (!present_) return;
  pool.X_WP = X_WP_;
  pool.size_m = description_.size_m.cast<float>();
  pool.level_m = level_;
  pool.blood = blood_;
  // Blood hides what is below long before it is all of the fluid.
  const auto share = static_cast<float>(std::sqrt(std::clamp(blood_, 0.0, 1.0)));
  for (std::size_t i = 0; i < 4; ++i)
    pool.rgba.at(i) = description_.rgba.at(i) + share * (kBlood.at(i) - description_.rgba.at(i));
  pool.columns = kColumns;
  pool.heights_m.resize(heights_.size());
  for (std::size_t i = 0; i < heights_.size(); ++i) pool.heights_m[i] = static_cast<float>(heights_[i]);
}

}  // namespace cellmirror::tissue
