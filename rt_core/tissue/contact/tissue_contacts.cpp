#include "rt_core/tissue/contact/tissue_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rt_core/geometry/triangle.hpp"
#include "rt_core/tissue/description/step.hpp"

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kNearReach = 0.004;        // m: nearest triangles are kept within
constexpr double kTouchReach = 0.0005;      // m
constexpr double kDeepestInTissue = 0.003;  // m; deeper is left as it is
constexpr double kOutside = -0.0002;        // m: what is less deep counts as outside
constexpr double kTissueFriction = 0.05;    // wet on wet
constexpr double kNoSide = 1e-10;           // m2, twice the area

// Above the triangle's plane where the nearest point is within it; else by the distance.
double signed_gap(const Vector3d& p, const Vector3d& nearest, const geometry::Triangle& corners, Vector3d& normal) {
  normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double size = normal.norm();
  if (size < kNoSide) return std::numeric_limits<double>::infinity();
  normal /= size;
  const Vector3d away = p - nearest;
  const double height = normal.dot(away);
  const double distance = away.norm();
  if (height > 0 && distance > 1e-6) normal = away / distance;
  return height > 0 ? distance : -distance;
}

}  // namespace

void TissueContacts::reset() { pairs_.clear(); }

void TissueContacts::search(std::span<DeformableObject> objects, const ContactMemory& memory,
                            std::vector<Contact>& contacts) {
  appended_ = 0;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    for (std::uint32_t j = i + 1; j < objects.size(); ++j) {
      if (!objects[i].has(TissueAttribute::bodies) || !objects[j].has(TissueAttribute::bodies)) continue;
      const SurfaceIndex& a = objects[i].surface;
      const SurfaceIndex& b = objects[j].surface;
      const Vector3d reach = Vector3d::Constant(kNearReach);
      if (((a.low() - reach).array() > b.high().array()).any() ||
          ((a.high() + reach).array() < b.low().array()).any()) {
        pairs_.erase({i, j});
        pairs_.erase({j, i});
        continue;
      }
      // Points of both: a corner of one could lie between the points of the other.
      for (const auto& [p, t] : {std::pair{i, j}, std::pair{j, i}}) {
        Pair& pair = pairs_[{p, t}];
        renew(pair, objects[p], objects[t]);
        use(pair, objects[p], p, objects[t], t, memory, contacts);
      }
    }
  }
}

void TissueContacts::renew(Pair& pair, DeformableObject& with_points, DeformableObject& with_triangles) {
  SurfaceIndex& points = with_points.surface;
  SurfaceIndex& triangles = with_triangles.surface;
  if (pair.revision_of_points != points.revision() || pair.revision_of_triangles != triangles.revision()) {
    pair = Pair();
    pair.revision_of_points = points.revision();
    pair.revision_of_triangles = triangles.revision();
    pair.near.resize(points.clusters().size());
    choose_points(*with_points.body, pair.chosen);
  }
  of_points_.clear();
  points.near_box(triangles.low(), triangles.high(), kNearReach, of_points_);
  if (of_points_.empty()) return;
  const auto next = std::ranges::lower_bound(of_points_, pair.next_cluster);
  const std::uint32_t cluster = next != of_points_.end() ? *next : of_points_.front();
  pair.next_cluster = cluster + 1;

  const SurfaceIndex::Cluster& box = points.clusters()[cluster];
  collect_candidates(box.low, box.high, points.margin(box) + kNearReach, with_triangles);
  std::vector<Near>& old = pair.near[cluster];
  fresh_.clear();
  for (const std::uint32_t point : points.points(box)) {
    if (pair.chosen[point] == 0) continue;
    Near found{.point = point};
    double gap = 0;
    if (!find_nearest(points.position(*with_points.body, point), found.triangle, gap)) continue;
    const auto same = std::ranges::lower_bound(old, point, {}, &Near::point);
    found.seen_outside = gap > kOutside || (same != old.end() && same->point == point && same->seen_outside);
    fresh_.push_back(found);
  }
  old.swap(fresh_);
}

// Of each node the surface point that depends on it most: what lies between follows the same nodes, and more contacts
// than nodes only ask these several times.
void TissueContacts::choose_points(const Body& body, std::vector<std::uint8_t>& chosen) {
  const auto points = body.surface_points();
  struct Best {
    float weight = 0;
    std::uint32_t point = 0;
  };
  std::vector<Best> best(body.positions().size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto most = std::ranges::max_element(points[i].weight);
    Best& of_node = best[points[i].node[static_cast<std::size_t>(most - points[i].weight.begin())]];
    if (*most > of_node.weight) of_node = {*most, i};
  }
  chosen.assign(points.size(), 0);
  for (const Best& one : best) {
    if (one.weight > 0) chosen[one.point] = 1;
  }
}

// Triangles that may be near a point within the box, grown by `reach`: computed once for all points of a cluster.
void TissueContacts::collect_candidates(const Vector3d& low, const Vector3d& high, double reach,
                                        DeformableObject& with_triangles) {
  SurfaceIndex& triangles = with_triangles.surface;
  clusters_.clear();
  candidates_.clear();
  triangles.near_box(low, high, reach, clusters_);
  for (const std::uint32_t cluster : clusters_) {
    for (const std::uint32_t triangle : triangles.triangles(triangles.clusters()[cluster])) {
      Candidate one{.corners = triangles.corners(*with_triangles.body, triangle), .triangle = triangle};
      const Vector3d least = one.corners[0].cwiseMin(one.corners[1]).cwiseMin(one.corners[2]);
      const Vector3d most = one.corners[0].cwiseMax(one.corners[1]).cwiseMax(one.corners[2]);
      if ((least.array() > high.array() + reach).any() || (most.array() < low.array() - reach).any()) continue;
      one.centre = 0.5 * (least + most);
      for (const Vector3d& corner : one.corners) one.radius = std::max(one.radius, (corner - one.centre).norm());
      candidates_.push_back(one);
    }
  }
}

// The candidate nearest to p within kNearReach; false where there is none.
bool TissueContacts::find_nearest(const Vector3d& p, std::uint32_t& triangle, double& gap) const {
  double best = kNearReach;
  bool any = false;
  for (const Candidate& one : candidates_) {
    const double within = one.radius + best;
    if ((p - one.centre).squaredNorm() >= within * within) continue;
    const Vector3d nearest = geometry::closest_on_triangle(p, one.corners);
    const double squared = (p - nearest).squaredNorm();
    if (squared >= best * best) continue;
    Vector3d normal;
    const double signed_distance = signed_gap(p, nearest, one.corners, normal);
    if (!std::isfinite(signed_distance)) continue;
    best = std::sqrt(squared);
    gap = signed_distance;
    triangle = one.triangle;
    any = true;
  }
  return any;
}

void TissueContacts::use(Pair& pair, DeformableObject& with_points, std::uint32_t number,
                         DeformableObject& with_triangles, std::uint32_t other, const ContactMemory& memory,
                         std::vector<Contact>& contacts) {
  used_.resize(std::max(used_.size(), with_points.body->surface_points().size()), 0);
  if (++round_ == 0) {
    std::ranges::fill(used_, 0U);
    round_ = 1;
  }
  const double way = with_points.surface.way() + with_triangles.surface.way();
  for (std::vector<Near>& cluster : pair.near) {
    for (Near& near : cluster) {
      if (!near.seen_outside || used_[near.point] == round_ || appended_ >= kMostContacts) continue;
      used_[near.point] = round_;
      if (way < near.apart_until) continue;
      const Vector3d p = with_points.surface.position(*with_points.body, near.point);
      const geometry::Triangle corners = with_triangles.surface.corners(*with_triangles.body, near.triangle);
      const Vector3d facing = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      const double height = (p - corners[0]).dot(facing);
      // Farther from the plane than any contact: most points end here.
      const double size = facing.norm();
      if (std::abs(height) > kDeepestInTissue * size) {
        near.apart_until = way + std::abs(height) / size - kDeepestInTissue;
        continue;
      }
      const Vector3d nearest = geometry::closest_on_triangle(p, corners);
      Vector3d normal;
      const double gap = signed_gap(p, nearest, corners, normal);
      if (std::isfinite(gap) && gap > kTouchReach) near.apart_until = way + gap - kTouchReach;
      if (!(gap < kTouchReach) || gap < -kDeepestInTissue) continue;
      Contact contact;
      contact.key = {ContactKey::Other::tissue, other, number, near.point};
      contact.point.object = number;
      contact.point.corner.fill(near.point);
      contact.point.embedded.fill(with_points.body->surface_points()[near.point]);
      contact.point.share = Vector3d::UnitX();
      contact.other = surface_point(with_triangles, other, near.triangle, barycentric(nearest, corners));
      contact.normal = normal;
      contact.gap = gap;
      contact.friction = kTissueFriction;
      if (const Contact* before = memory.find(contact.key)) {
        contact.impulse = before->impulse;
        contact.tangential = before->tangential;
      }
      contacts.push_back(contact);
      ++appended_;
    }
  }
}

}  // namespace cellmirror::tissue
