// The finite elements of one body: what each is made of, how heavy its corners are, how long a stable step may be, and
// the forces of a step. The kernel works on floats; differences of positions are taken in doubles before.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/tissue/body/element_kernel.hpp"
#include "rt_core/tissue/body/rest_mesh.hpp"
#include "rt_core/tissue/body/topology.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

// Share of the stable step of the linear problem that is used: large strains stiffen an element.
inline constexpr double kStepSafety = 0.8;
inline constexpr int kMostSubsteps = 4;
inline constexpr double kBurntStiffening = 4.0;  // times stiffer at a burn of 1, less 1
inline constexpr double kBurntShrinking = 0.15;

// Of one element beside what the kernel has.
struct ElementState {
  Material material;                                            // of its region
  Eigen::Matrix3d inverse_shape = Eigen::Matrix3d::Identity();  // of the edges at rest, plastic strain included, 1/m
  double volume = 0;                                            // m3 of its material
  double carried = 0;      // m3 that its stiffness and mass are for: not less than a small share of the tetrahedron
  double mass_factor = 1;  // for a stable step
  double burn = 0;         // mean of its nodes
  bool loose = false;
};

// Speed of sound of the material, m/s.
[[nodiscard]] double wave_speed(const Material& material);

class Elements {
 public:
  Elements() = default;
  // For steps of `step` seconds; `substeps` says in how many parts one of them has to be made, `most_substeps` (at most
  // kMostSubsteps) at most.
  Elements(const RestMesh& mesh, const Topology& topology, std::vector<Material> materials, double step,
           int most_substeps = kMostSubsteps);

  [[nodiscard]] int substeps() const { return substeps_; }
  // Before mass is added, s: 2 / omega of the fastest mode, shortened for the damping.
  [[nodiscard]] double stable_step() const { return stable_step_; }
  [[nodiscard]] std::span<const ElementState> states() const { return states_; }
  // m, mean edge of a cube of which a tetrahedron is the sixth part.
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double volume() const;
  [[nodiscard]] double mass() const;        // kg, without what was added
  [[nodiscard]] double added_mass() const;  // kg

  // After a cut: elements with less material, and new ones, which begin as copies of their origins.
  void follow(const RestMesh& mesh, const Topology& topology, std::span<const std::uint32_t> elements,
              std::span<const std::uint32_t> origins);
  // Adds mass to an element that hardly anything else is joined to (`loose`), since alone it swings faster than within
  // the body; takes it away again otherwise.
  void set_loose(std::uint32_t element, bool loose);
  // kg on each of the element's corners.
  [[nodiscard]] double corner_mass(std::uint32_t element) const;
  // Heat: the element becomes stiffer and shrinks.
  void set_burn(std::uint32_t element, double burn);
  // Makes stretches beyond the yield strain lasting; returns how many elements yielded. `x` as in add_forces.
  std::uint32_t yield(const Topology& topology, std::span<const Eigen::Vector3d> x);

  // Adds the forces at positions x (m, by node of the simulation) to f (N). `step`: seconds since the last call.
  KernelSums add_forces(std::span<const Eigen::Vector3d> x, double step, std::span<Eigen::Vector3d> f);
  // An element that is deformed much is stiffer than at rest, so its stable step is shorter: the mass that each of its
  // corners needs in this step beside its own. After add_forces(), whose sums they are; hardly any work where nothing
  // is deformed much.
  struct Extra {
    std::array<std::uint32_t, 4> nodes{};
    double corner_mass = 0;  // kg
  };
  void extra_masses(const KernelSums& sums, std::vector<Extra>& extras) const;
  // J, by the formula of the kernel, in doubles.
  [[nodiscard]] double elastic_energy(const Topology& topology, std::span<const Eigen::Vector3d> x) const;

 private:
  void store(std::uint32_t element);
  // The strain of the last step as it would have been with the shape at rest that there is now, which is the one before
  // times `change`: a new shape is no rate of strain.
  void rebase_strain(std::uint32_t element, const Eigen::Matrix3d& change);
  void add_mass(const RestMesh& mesh, const Topology& topology);
  void set_mass_factor(ElementState& state) const;
  // By which the stable step of an element within the body is longer than that of the same element alone.
  [[nodiscard]] double share_of(const ElementState& state) const { return state.loose ? 1.0 : element_share_; }
  // Where the blocks have an element, and the other way. The elements of one block come from all over the body, so that
  // they have hardly a node in common, and forces on a node need not wait for each other; those of cuts come last.
  [[nodiscard]] std::size_t place(std::uint32_t element) const;
  [[nodiscard]] std::uint32_t element_at(std::size_t place) const;
  [[nodiscard]] double fastest_mode(const RestMesh& mesh, const Topology& topology);

  std::vector<ElementState> states_;
  ElementBlocks blocks_;
  std::uint32_t spread_ = 1;          // blocks of the elements that there were at first
  std::vector<NodeVector> kernel_x_;  // as the kernel takes them
  std::vector<NodeVector> kernel_f_;
  double step_ = 0.001;     // s, of a substep
  double stable_step_ = 0;  // s
  double size_ = 0;         // m
  double stored_step_ = 0;  // s, that the viscous values in the blocks are for
  int substeps_ = 1;
  double element_share_ =
      1;  // stable step of an element within the body over that of the same element alone, at least 1
  double largest_yield_ = 0;  // of all materials; 0: none yields
};

}  // namespace cellmirror::tissue
