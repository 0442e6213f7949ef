// Ligaments and adhesions: springs between surface points of two objects, or of one and the world. They pull where they
// are longer than at rest, never push, and tear.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/tissue/contact/constraint_system.hpp"
#include "rt_core/tissue/contact/surface_point.hpp"
#include "rt_core/tissue/description/description.hpp"
#include "rt_core/tissue/description/event_log.hpp"

namespace cellmirror::tissue {

class Connections {
 public:
  static constexpr std::size_t kMostConnections = 256;
  static constexpr std::size_t kMostPairs = 64;  // of a connection

  // Names that are not among the objects: the connection is left out; World::make() refuses them before.
  void set(std::vector<Connection> connections, std::span<const DeformableObject> objects);
  void reset();  // none is torn
  void forget_impulses();
  // After a cut or a reset of an object: points stay with their material.
  void follow_cuts(std::span<const DeformableObject> objects);
  void add(ConstraintSystem& system, std::span<DeformableObject> objects, double dt);
  // After solve(): tears what was pulled too hard.
  void take(const ConstraintSystem& system, std::span<DeformableObject> objects, double dt, EventLog& log);

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(connections_.size()); }
  [[nodiscard]] std::uint32_t torn() const;
  // Force of all springs, N: sizes added up.
  [[nodiscard]] double pull() const { return pull_; }

 private:
  static constexpr std::uint32_t kWorld = ~0U;
  struct End {
    std::uint32_t object = kWorld;
    EmbeddedPoint point;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();  // m, of the world; of an object: at rest
  };
  struct Spring {
    std::uint32_t connection = 0;
    End a;
    End b;
    double rest_length = 0;  // m
    double stiffness = 0;    // N/m
    double tear_force = 0;   // N; 0: never
    double impulse = 0;      // N s
    bool torn = false;
    bool has_row = false;
    std::size_t row = 0;
  };

  void make_springs(std::uint32_t number, std::span<const DeformableObject> objects);
  [[nodiscard]] static Eigen::Vector3d position(const End& end, std::span<const DeformableObject> objects);

  std::vector<Connection> connections_;
  std::vector<Spring> springs_;
  double pull_ = 0;
};

// The object's place in the list; the list's size: none has the name.
[[nodiscard]] std::uint32_t object_named(std::span<const DeformableObject> objects, const std::string& name);

}  // namespace cellmirror::tissue
