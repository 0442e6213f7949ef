#include "rt_core/tissue/instruments/instrument_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "rt_core/geometry/triangle.hpp"

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kLookAhead = 0.0005;       // m beyond what may close in a step
constexpr double kEffectorSpacing = 0.001;  // m between contacts
constexpr double kShaftSpacing = 0.004;
constexpr double kKeepBonus = 0.0003;      // m: what was touched stays a contact rather than its neighbour
constexpr double kSmallestNormal = 1e-10;  // m2, twice the area: smaller triangles have no side
constexpr double kDeepest = 0.005;         // m beyond the axis; deeper is not undone
constexpr double kShaftFriction = 0.1;     // steel on wet tissue
constexpr double kEffectorFriction = 0.2;
constexpr std::size_t kMostHits = 1024;

}  // namespace

void InstrumentContacts::collect(const Capsule& capsule, const ContactKey& kind, std::span<DeformableObject> objects,
                                 double reach, const ContactMemory* memory, TissueAttribute needed) {
  hits_.clear();
  const double within = capsule.radius + reach;
  const geometry::Segment axis{capsule.a, capsule.b};
  for (std::uint32_t number = 0; number < objects.size(); ++number) {
    DeformableObject& object = objects[number];
    if (!object.has(needed)) continue;
    clusters_.clear();
    object.surface.near_segment(capsule.a, capsule.b, within, clusters_);
    for (const std::uint32_t cluster : clusters_) {
      for (const std::uint32_t triangle : object.surface.triangles(object.surface.clusters()[cluster])) {
        if (hits_.size() >= kMostHits) return;
        const geometry::Triangle corners = object.surface.corners(*object.body, triangle);
        const Vector3d centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        const double far =
            within + std::sqrt(std::max({(corners[0] - centre).squaredNorm(), (corners[1] - centre).squaredNorm(),
                                         (corners[2] - centre).squaredNorm()}));
        if ((geometry::closest_on_segment(centre, axis) - centre).squaredNorm() > far * far) continue;
        const geometry::ClosestPoints nearest = geometry::segment_triangle(axis, corners);
        if (!(nearest.distance < within)) continue;
        const Vector3d facing = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if (facing.norm() < kSmallestNormal) continue;
        ContactKey key = kind;
        key.object = number;
        key.feature = triangle;
        const Contact* before = memory != nullptr ? memory->find(key) : nullptr;
        Hit hit{.distance = nearest.distance - (before != nullptr ? kKeepBonus : 0.0),
                .object = number,
                .triangle = triangle,
                .on_surface = nearest.p_b};
        const Vector3d away = nearest.p_b - nearest.p_a;
        if (nearest.distance > 1e-7 && away.dot(facing) < -1e-3 * nearest.distance * facing.norm()) {
          hit.normal = away / nearest.distance;
          hit.gap = nearest.distance - capsule.radius;
        } else if (before != nullptr && nearest.distance < kDeepest) {
          hit.normal = before->normal;
          hit.gap = before->normal.dot(away) - capsule.radius;
        } else {
          continue;
        }
        hits_.push_back(hit);
      }
    }
  }
}

void InstrumentContacts::thin_out(double spacing, std::size_t most) {
  std::ranges::sort(hits_, [](const Hit& a, const Hit& b) {
    return std::tie(a.distance, a.object, a.triangle) < std::tie(b.distance, b.object, b.triangle);
  });
  kept_.clear();
  for (const Hit& hit : hits_) {
    if (kept_.size() >= most) return;
    const bool crowded = std::ranges::any_of(kept_, [&](const Hit& one) {
      return one.object == hit.object && (one.on_surface - hit.on_surface).squaredNorm() < spacing * spacing;
    });
    if (!crowded) kept_.push_back(hit);
  }
}

void InstrumentContacts::search(const Instrument& instrument, int place, std::span<DeformableObject> objects,
                                const ContactMemory& memory, std::vector<Contact>& contacts) {
  double fastest = 0;
  for (const DeformableObject& object : objects) fastest = std::max(fastest, object.speed);
  for (std::size_t which = 0; which < instrument.capsules(); ++which) {
    const bool burns = which > 0 && instrument.action.kind == InstrumentKind::hook && instrument.acting;
    const Capsule capsule = instrument.capsule(which);
    const ContactKey kind{ContactKey::Other::instrument,
                          static_cast<std::uint32_t>(4 * place) + static_cast<std::uint32_t>(which), 0, 0};
    const double closing = std::min(kFastestPush, instrument.speed.norm() + 0.3 * instrument.turning.norm()) +
                           std::min(kFastestPush, fastest);
    collect(capsule, kind, objects, kLookAhead + closing * kStep_s, &memory, TissueAttribute::contact);
    thin_out(which == 0 ? kShaftSpacing : kEffectorSpacing, kMostContactsOfCapsule);
    for (const Hit& hit : kept_) {
      DeformableObject& object = objects[hit.object];
      Contact contact;
      contact.key = kind;
      contact.key.object = hit.object;
      contact.key.feature = hit.triangle;
      contact.point = surface_point(object, hit.object, hit.triangle,
                                    barycentric(hit.on_surface, object.surface.corners(*object.body, hit.triangle)));
      // A hot hook goes through what it has burnt enough.
      if (burns && burn(object, contact.point) >= kCutBurn) continue;
      contact.instrument = place;
      contact.normal = hit.normal;
      contact.anchor = hit.on_surface - hit.gap * hit.normal;
      contact.velocity = instrument.velocity_at(contact.anchor);
      if (contact.velocity.norm() > kFastestPush) contact.velocity *= kFastestPush / contact.velocity.norm();
      contact.gap = hit.gap;
      contact.friction = which == 0 ? kShaftFriction : kEffectorFriction;
      if (const Contact* before = memory.find(contact.key)) {
        contact.impulse = before->impulse;
        contact.tangential = before->tangential;
      }
      contacts.push_back(contact);
    }
  }
}

void InstrumentContacts::near_effector(const Instrument& instrument, std::span<DeformableObject> objects,
                                       TissueAttribute needed, double reach, double spacing, std::size_t most,
                                       std::vector<SurfacePoint>& points) {
  points.clear();
  const Capsule capsule = instrument.effector();
  collect(capsule, {}, objects, reach - capsule.radius, nullptr, needed);
  thin_out(spacing, most);
  for (const Hit& hit : kept_) {
    DeformableObject& object = objects[hit.object];
    points.push_back(surface_point(object, hit.object, hit.triangle,
                                   barycentric(hit.on_surface, object.surface.corners(*object.body, hit.triangle))));
  }
}

}  // namespace cellmirror::tissue
