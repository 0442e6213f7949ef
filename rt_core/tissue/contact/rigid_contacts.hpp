// Contacts of surface points of deformable objects with rigid bodies of the cell. For every surface point near a body a
// plane is kept in the body's frame; a bounded number of planes is computed in a step, in rotation, and all are used.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "rt_core/geometry/proximity.hpp"
#include "rt_core/tissue/contact/contact.hpp"
#include "rt_core/tissue/description/rigid_body.hpp"

namespace cellmirror::tissue {

class RigidContacts {
 public:
  static constexpr std::size_t kMostBodies = 256;    // of a step; more are ignored
  static constexpr std::size_t kMostPlanes = 2048;   // of all pairs
  static constexpr std::size_t kMostContacts = 512;  // appended in a step

  void reset();
  void search(std::span<const RigidBodyPose> bodies, std::span<DeformableObject> objects, const ContactMemory& memory,
              std::vector<Contact>& contacts);

 private:
  struct Plane {
    std::uint32_t point = 0;  // surface point
    Eigen::Vector3d origin_B = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_B = Eigen::Vector3d::UnitZ();
    geometry::ProximityHint hint;
    bool known = false;
    bool seen_outside = false;  // what starts within a body is not pushed out of it
  };
  struct Pair {
    std::uint64_t revision = 0;  // of the surface
    std::uint64_t last_used = 0;
    std::vector<Plane> planes;  // by point
    std::size_t next_plane = 0;
    std::uint32_t steps_to_renewal = 0;
  };
  struct Body {
    Pose X_WB = Pose::Identity();
    std::uint64_t last_used = 0;
  };

  void renew_points(const RigidBodyPose& body, DeformableObject& object, Pair& pair);
  void renew_planes(const RigidBodyPose& body, DeformableObject& object, Pair& pair);
  void use_planes(const RigidBodyPose& body, const Body& last, DeformableObject& object, std::uint32_t number,
                  const Pair& pair, const ContactMemory& memory, std::vector<Contact>& contacts);

  std::map<std::uint32_t, Body> bodies_;                           // by id
  std::map<std::pair<std::uint32_t, std::uint32_t>, Pair> pairs_;  // by id and object
  std::uint64_t round_ = 0;
  std::size_t planes_ = 0;  // of all pairs
  std::size_t appended_ = 0;
  std::vector<std::uint32_t> clusters_;
  std::vector<std::uint32_t> near_;
  std::vector<Plane> old_;
};

}  // namespace cellmirror::tissue
