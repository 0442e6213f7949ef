// Internal forces of linear tetrahedra, total Lagrangian, several elements at a time with the widest vectors that the
// processor has (Highway, chosen at run time). Neo-Hookean energy as CalculiX has it (CalculiX 2.20 manual,
// *HYPERELASTIC): W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2; below J = 0.1 the first term keeps J at 0.1, so that an
// inverted element finds back. Viscous stress: damping times the elastic moduli times the rate of Green's strain.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace cellmirror::tissue {

// Element values in blocks of kLanes elements, value by value. 16 floats are the widest vectors; narrower ones take a
// row in parts.
inline constexpr std::size_t kLanes = 16;
struct alignas(64) LaneRow {
  std::array<float, kLanes> lane{};
};
// Value `v` of element e, of `values` that each element has.
[[nodiscard]] inline float& lane_value(std::vector<LaneRow>& rows, std::size_t values, std::size_t e, std::size_t v) {
  return rows[e / kLanes * values + v].lane[e % kLanes];
}
[[nodiscard]] inline float lane_value(const std::vector<LaneRow>& rows, std::size_t values, std::size_t e,
                                      std::size_t v) {
  return rows[e / kLanes * values + v].lane[e % kLanes];
}

// Position (m) or force (N) of a node: x, y, z and a fourth value without meaning, so that a vector register takes it
// in one piece.
struct alignas(32) NodeVector {
  std::array<double, 4> xyz0{};
};

// (omega step / 2)^2 of a deformed element, above which it needs more mass; 1 is the limit of a stable step.
inline constexpr float kMostLoad = 0.9F;

struct ElementBlocks {
  // B (9, by rows), mu V, K V, viscous mu V / dt, viscous lambda V / dt, and the factors of load: of the elastic
  // stiffness (1 / (Pa m3)) and of the largest stretch squared.
  static constexpr std::size_t kMaterialValues = 15;
  std::vector<LaneRow> material;
  std::vector<LaneRow> last_strain;                 // 6: xx, yy, zz, xy, xz, yz
  std::vector<std::array<std::uint32_t, 4>> nodes;  // by place; of places without an element: 0, with a material of 0
  // Per step.
  std::vector<LaneRow> strain;  // 1: J^(-2/3) I1 - 3, from which the equivalent strain follows
  // 1: what (omega step / 2)^2 of the deformed element is at most; the closer to that the more it exceeds kMostLoad.
  std::vector<LaneRow> load;
  std::size_t count = 0;  // of places

  void resize(std::size_t places);
  [[nodiscard]] std::size_t blocks() const { return (count + kLanes - 1) / kLanes; }
};

struct KernelSums {
  float largest_strain = 0;  // of `strain`
  float largest_load = 0;    // of `load`
  std::uint32_t inverted = 0;
  double energy = 0;  // J, elastic; of small strains only as good as floats are
};

// Fills strain, last_strain and load of elements with nodes at x, and adds their forces to f. No heap memory; any
// thread, one a set of blocks.
KernelSums compute_element_forces(ElementBlocks& blocks, std::span<const NodeVector> x, std::span<NodeVector> f);

// The instruction set in use, as Highway names it: "AVX2", "SSE4", ...
[[nodiscard]] std::string_view simd_target();
// Uses this instruction set from now on, so that results repeat on another machine to the bit; empty: the best one.
// False: the processor does not have it. Not while another thread computes.
bool force_simd_target(std::string_view name);

}  // namespace cellmirror::tissue
