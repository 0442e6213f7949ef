// Contacts between deformable objects: surface points of the one with the finer surface against triangles of the other.
// For every point near the other object its nearest triangle is kept; those of one cluster are searched in a step, in
// rotation, and all are used.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "rt_core/geometry/triangle.hpp"
#include "rt_core/tissue/contact/contact.hpp"

namespace cellmirror::tissue {

class TissueContacts {
 public:
  static constexpr std::size_t kMostContacts = 256;  // appended in a step

  void reset();
  void search(std::span<DeformableObject> objects, const ContactMemory& memory, std::vector<Contact>& contacts);

 private:
  struct Near {
    std::uint32_t point = 0;     // of the object with points
    std::uint32_t triangle = 0;  // of the other
    bool seen_outside = false;   // what overlaps from the start, or deeply, is left so
    // m, that both objects together have to go first, counted as SurfaceIndex::way(), before the two can touch.
    double apart_until = 0;
  };
  struct Pair {
    std::uint64_t revision_of_points = 0;
    std::uint64_t revision_of_triangles = 0;
    std::vector<std::vector<Near>> near;  // by cluster of the object with points
    std::vector<std::uint8_t> chosen;     // by surface point of the object with points: 1: it is looked at
    std::uint32_t next_cluster = 0;
  };

  struct Candidate {
    geometry::Triangle corners;                        // m
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of a sphere about them
    double radius = 0;
    std::uint32_t triangle = 0;
  };

  void renew(Pair& pair, DeformableObject& with_points, DeformableObject& with_triangles);
  static void choose_points(const Body& body, std::vector<std::uint8_t>& chosen);
  void collect_candidates(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double reach,
                          DeformableObject& with_triangles);
  [[nodiscard]] bool find_nearest(const Eigen::Vector3d& p, std::uint32_t& triangle, double& gap) const;
  void use(Pair& pair, DeformableObject& with_points, std::uint32_t number, DeformableObject& with_triangles,
           std::uint32_t other, const ContactMemory& memory, std::vector<Contact>& contacts);

  std::map<std::pair<std::uint32_t, std::uint32_t>, Pair> pairs_;  // by number of the object with points and the other
  std::size_t appended_ = 0;
  std::vector<std::uint32_t> clusters_;
  std::vector<std::uint32_t> of_points_;
  std::vector<Candidate> candidates_;
  std::vector<Near> fresh_;
  std::vector<std::uint32_t> used_;  // by point: round in which it was used; points are in several clusters
  std::uint32_t round_ = 0;
};

}  // namespace cellmirror::tissue
