// Constraints on the velocities of nodes: contacts that only push, with friction; springs that only pull; points that
// are held. Projected Gauss-Seidel with a fixed number of sweeps, so that its time is bounded. Knows no bodies: the
// caller adds nodes with velocity and inverse mass and takes the new velocities. SI. Source: Catto 2005, Iterative
// Dynamics with Temporal Coherence (accumulated impulses, warm start, softness).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace cellmirror::tissue {

class ConstraintSystem {
 public:
  struct Node {
    std::uint32_t object = 0;
    std::uint32_t index = 0;                           // in the object
    Eigen::Vector3d before = Eigen::Vector3d::Zero();  // m/s, as it was added
    // N s, of all constraints; also where the inverse mass is 0. After solve().
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  };

  // n . v + softness * impulse >= bias, with v the weighted sum of velocities less `velocity`. 0 <= impulse <= most.
  struct Push {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     // m/s, of the other side where that is no node
    double bias = 0;                                        // m/s
    double softness = 0;                                    // 1/kg
    double friction = 0;                                    // Coulomb's coefficient
    double most = std::numeric_limits<double>::infinity();  // N s
    double impulse = 0;                                     // N s; before solve(): where to start
    Eigen::Vector3d tangential = Eigen::Vector3d::Zero();   // N s, of friction; likewise
  };

  // v + softness * impulse / m = velocity, as far as an impulse of at most `most` does it; m: the mass seen at the
  // point. Several holds within one element ask for more than its nodes can follow: without softness they pull against
  // each other with any force.
  struct Hold {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s
    double softness = 0;
    double most = std::numeric_limits<double>::infinity();  // N s
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero();      // N s; before solve(): where to start
    bool limited = false;                                   // after solve(): `most` was not enough
  };

  void clear();
  // The node's place in this system; added where it is not in it yet.
  std::uint32_t node(std::uint32_t object, std::uint32_t index, const Eigen::Vector3d& velocity, double inverse_mass);

  // Terms of the next constraint: terms of the same node are added up.
  void add_term(std::uint32_t node, double weight);
  // Both take the terms since the last one and return the constraint's number among its kind.
  std::size_t add(const Push& push);
  std::size_t add(const Hold& hold);

  // Ends early where a sweep changes no velocity by more than 1e-6 m/s.
  void solve(std::uint32_t sweeps);

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] Eigen::Vector3d velocity(std::size_t node) const { return states_[node].head<3>(); }  // m/s
  [[nodiscard]] const Push& push(std::size_t number) const { return pushes_[number].row; }
  [[nodiscard]] const Hold& hold(std::size_t number) const { return holds_[number].row; }
  // False where no node of the constraint can move: it has no effect.
  [[nodiscard]] bool movable(std::size_t push) const { return pushes_[push].movable; }
  [[nodiscard]] bool empty() const { return pushes_.empty() && holds_.empty(); }

 private:
  struct Term {
    std::uint32_t node = 0;
    double weight = 0;
    double yielding = 0;  // 1/kg: weight times the node's inverse mass
  };
  // What the sweeps need of a node, in two registers: its velocity, m/s, and its inverse mass, 1/kg; 0: constraints do
  // not move it.
  using State = Eigen::Vector4d;
  template <class Row>
  struct Entry {
    Row row;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    double inverse_mass = 0;  // 1/kg, seen at the point
    bool movable = false;
  };
  struct Place {
    std::uint32_t round = 0;
    std::uint32_t at = 0;
  };

  template <class Row>
  Entry<Row> take_terms(const Row& row);
  template <class Row>
  [[nodiscard]] Eigen::Vector3d relative_velocity(const Entry<Row>& entry) const;
  template <class Row>
  void apply(const Entry<Row>& entry, const Eigen::Vector3d& impulse);
  template <class Row>
  void add_impulse(const Entry<Row>& entry, const Eigen::Vector3d& impulse);
  // Both return the change of the point's velocity, m/s.
  double sweep(Entry<Push>& entry);
  double sweep(Entry<Hold>& entry);

  std::vector<Node> nodes_;
  std::vector<State> states_;
  std::vector<std::vector<Place>> places_;  // by object and index
  std::uint32_t round_ = 1;
  std::vector<Term> terms_;
  std::uint32_t open_ = 0;  // first term of the next constraint
  std::vector<Entry<Push>> pushes_;
  std::vector<Entry<Hold>> holds_;
};

}  // namespace cellmirror::tissue
