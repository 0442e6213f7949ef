#include "rt_core/tissue/contact/rigid_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/tissue/contact/rigid_distance.hpp"
#include "rt_core/tissue/description/step.hpp"

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kPlaneReach = 0.006;       // m: planes are kept for points that are nearer
constexpr double kContactReach = 0.001;     // m
constexpr double kDeepestInBody = 0.01;     // m; deeper is not undone
constexpr std::uint32_t kStepsOfList = 16;  // after so many the list of near points is made again
constexpr int kBudget = 48;                 // of a step, for all pairs; a plane of a primitive costs 1
constexpr int kLeastBudget = 8;             // of a pair
constexpr int kMeshCost = 4;
constexpr double kRigidFriction = 0.3;

}  // namespace

void RigidContacts::reset() {
  bodies_.clear();
  pairs_.clear();
  round_ = 0;
  planes_ = 0;
}

void RigidContacts::search(std::span<const RigidBodyPose> bodies, std::span<DeformableObject> objects,
                           const ContactMemory& memory, std::vector<Contact>& contacts) {
  ++round_;
  appended_ = 0;
  if (bodies.size() > kMostBodies) bodies = bodies.first(kMostBodies);
  for (const RigidBodyPose& body : bodies) {
    if (body.solid == nullptr || !body.X_WB.matrix().allFinite()) continue;
    const auto [known, fresh] = bodies_.try_emplace(body.id);
    if (fresh || known->second.last_used + 1 != round_) known->second.X_WB = body.X_WB;
    const Vector3d centre = body.X_WB * body.solid->centre;
    const Vector3d wide = Vector3d::Constant(body.solid->radius + kPlaneReach);
    for (std::uint32_t number = 0; number < objects.size(); ++number) {
      DeformableObject& object = objects[number];
      if (!object.has(TissueAttribute::bodies)) continue;
      const bool apart = ((centre - wide).array() > object.surface.high().array()).any() ||
                         ((centre + wide).array() < object.surface.low().array()).any();
      if (apart) continue;
      Pair& pair = pairs_[{body.id, number}];
      pair.last_used = round_;
      renew_points(body, object, pair);
      renew_planes(body, object, pair);
      use_planes(body, known->second, object, number, pair, memory, contacts);
    }
    known->second.X_WB = body.X_WB;
    known->second.last_used = round_;
  }
  std::erase_if(bodies_, [&](const auto& one) { return one.second.last_used != round_; });
  std::erase_if(pairs_, [&](const auto& one) {
    if (one.second.last_used == round_) return false;
    planes_ -= one.second.planes.size();
    return true;
  });
}

void RigidContacts::renew_points(const RigidBodyPose& body, DeformableObject& object, Pair& pair) {
  if (pair.revision != object.surface.revision()) {
    planes_ -= pair.planes.size();
    const std::uint64_t used = pair.last_used;
    pair = Pair();
    pair.revision = object.surface.revision();
    pair.last_used = used;
  }
  if (pair.steps_to_renewal > 0) {
    --pair.steps_to_renewal;
    return;
  }
  pair.steps_to_renewal = kStepsOfList - 1;
  // The body's box in the world.
  const Vector3d centre = body.X_WB * body.solid->centre;
  const Vector3d half = body.X_WB.linear().cwiseAbs() * body.solid->half + Vector3d::Constant(kPlaneReach);
  clusters_.clear();
  object.surface.near_box(centre - half, centre + half, 0.0, clusters_);
  near_.clear();
  for (const std::uint32_t cluster : clusters_) {
    for (const std::uint32_t point : object.surface.points(object.surface.clusters()[cluster])) {
      const Vector3d& p = object.surface.position(*object.body, point);
      if (((p - centre).cwiseAbs().array() < half.array()).all()) near_.push_back(point);
    }
  }
  std::ranges::sort(near_);
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
  planes_ -= pair.planes.size();
  if (near_.size() > kMostPlanes - std::min(planes_, kMostPlanes))
    near_.resize(kMostPlanes - std::min(planes_, kMostPlanes));
  old_.swap(pair.planes);
  pair.planes.clear();
  for (const std::uint32_t point : near_) {
    const auto same = std::ranges::lower_bound(old_, point, {}, &Plane::point);
    Plane& plane = pair.planes.emplace_back();
    if (same != old_.end() && same->point == point) plane = *same;
    plane.point = point;
  }
  planes_ += pair.planes.size();
  if (pair.next_plane >= pair.planes.size()) pair.next_plane = 0;
}

void RigidContacts::renew_planes(const RigidBodyPose& body, DeformableObject& object, Pair& pair) {
  const int cost = body.solid->shape == Shape::mesh ? kMeshCost : 1;
  int budget = std::max(kLeastBudget, kBudget / static_cast<int>(std::max<std::size_t>(pairs_.size(), 1)));
  const Pose X_BW = body.X_WB.inverse();
  for (std::size_t i = 0; i < pair.planes.size() && budget >= cost; ++i) {
    budget -= cost;
    Plane& plane = pair.planes[pair.next_plane];
    pair.next_plane = pair.next_plane + 1 < pair.planes.size() ? pair.next_plane + 1 : 0;
    const Vector3d p_B = X_BW * object.surface.position(*object.body, plane.point);
    const RigidDistance found = rigid_distance(*body.solid, p_B, kPlaneReach + kDeepestInBody, plane.hint);
    plane.known = found.known;
    if (!found.known) continue;
    plane.origin_B = found.nearest;
    plane.normal_B = found.normal;
    if (found.distance > -0.0002) plane.seen_outside = true;
  }
}

void RigidContacts::use_planes(const RigidBodyPose& body, const Body& last, DeformableObject& object,
                               std::uint32_t number, const Pair& pair, const ContactMemory& memory,
                               std::vector<Contact>& contacts) {
  for (const Plane& plane : pair.planes) {
    if (!plane.known || !plane.seen_outside) continue;
    const Vector3d normal = last.X_WB.linear() * plane.normal_B;
    const Vector3d origin = last.X_WB * plane.origin_B;
    const Vector3d& p = object.surface.position(*object.body, plane.point);
    const double gap = normal.dot(p - origin);
    if (gap > kContactReach || gap < -kDeepestInBody || appended_ >= kMostContacts) continue;
    Contact contact;
    contact.key = {ContactKey::Other::rigid, body.id, number, plane.point};
    contact.point.object = number;
    contact.point.corner.fill(plane.point);
    contact.point.embedded.fill(object.body->surface_points()[plane.point]);
    contact.point.share = Vector3d::UnitX();
    contact.normal = normal;
    contact.anchor = p - gap * normal;
    // Of the body's point that is there at the step's start.
    contact.velocity = (body.X_WB * (last.X_WB.inverse() * contact.anchor) - contact.anchor) / kStep_s;
    if (contact.velocity.norm() > kFastestPush) contact.velocity *= kFastestPush / contact.velocity.norm();
    contact.gap = gap;
    contact.friction = kRigidFriction;
    if (const Contact* before = memory.find(contact.key)) {
      contact.impulse = before->impulse;
      contact.tangential = before->tangential;
    }
    contacts.push_back(contact);
    ++appended_;
  }
}

}  // namespace cellmirror::tissue
