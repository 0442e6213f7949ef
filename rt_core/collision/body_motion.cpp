#include "rt_core/collision/body_motion.hpp"

#include <limits>
#include <utility>

namespace cellmirror::collision {

namespace {

// Beyond this distance from the origin double numbers resolve contacts too coarsely.
constexpr double kFarthest = 1e6;  // m

constexpr double kLongestWay = 1e4;  // m: sums stay exact to 1e-12 m

bool can_be_computed_with(const Pose& X) {
  // False for NaN as well.
  return X.translation().cwiseAbs().maxCoeff() < kFarthest && X.matrix().allFinite() &&
         (X.linear().transpose() * X.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-6;
}

}  // namespace

void BodyMotion::adopt(std::shared_ptr<const PairTable> table) {
  table_ = std::move(table);
  bodies_.clear();
  parts_.clear();
  for (const Body& body : table_->bodies) {
    MovingBody& moving = bodies_.emplace_back();
    moving.node = body.node;
    moving.first_part = static_cast<std::uint32_t>(parts_.size());
    moving.part_count = static_cast<std::uint32_t>(body.parts.size());
    moving.box = box_around(body);
    moving.placed.half = moving.box.half;
    moving.placed.radius = ball_around(body).radius;
    for (const BodyPart& part : body.parts) {
      MovingPart& moving_part = parts_.emplace_back();
      moving_part.solid = part.solid.get();
      moving_part.X_NG = part.X_NG;
      moving_part.box = box_around(part);
      moving_part.placed.half = moving_part.box.half;
      moving_part.placed.radius = part.solid->radius;
    }
  }
  restart();
}

void BodyMotion::restart() {
  way_.assign(bodies_.size(), 0.0);
  travelled_.assign(bodies_.size(), 0.0);
  worn_ = false;
}

void BodyMotion::place(std::size_t index, const Pose& X_WN) {
  MovingBody& body = bodies_[index];
  body.X_WN = X_WN;
  body.placed.place(X_WN, body.box);
  for (std::uint32_t i = 0; i < body.part_count; ++i) {
    MovingPart& part = parts_[body.first_part + i];
    part.X_WG = X_WN * part.X_NG;
    part.placed.place(X_WN, part.box);
  }
}

void BodyMotion::move(const CellPoses& poses) {
  ++frame_;
  unusable_ = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    MovingBody& body = bodies_[i];
    const Pose& X_WN = poses.X_WN[static_cast<std::size_t>(body.node)];
    body.step = 0;
    if (!body.usable || X_WN.matrix() != body.X_WN.matrix()) {
      body.moved_frame = frame_;
      body.usable = can_be_computed_with(X_WN);
      if (body.usable) {
        const Pose before = body.X_WN;
        const Eigen::Vector3d centre_before = body.placed.centre;
        place(i, X_WN);
        body.step =
            travel(before.linear(), X_WN.linear(), (body.placed.centre - centre_before).norm(), body.placed.radius);
        way_[i] += body.step;
        worn_ = worn_ || way_[i] > kLongestWay;
      }
    }
    travelled_[i] = body.usable ? way_[i] : std::numeric_limits<double>::infinity();
    if (!body.usable) ++unusable_;
  }
}

}  // namespace cellmirror::collision
