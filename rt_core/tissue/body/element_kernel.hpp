// Internal forces of linear tetrahedra, total Lagrangian, several elements at a time with the widest vectors that the
// processor has (Highway, chosen at run time). Neo-Hookean energy as CalculiX has it (CalculiX 2.20 manual,
// *HYPERELASTIC): W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2; below J = 0.1 the first term keeps J at 0.1, so that an
// inverted element finds back. Viscous stress: damping times the elastic moduli times the rate of Green's strain.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

inline constexpr float kSqueezedAreas = 1e3F;

struct ElementBlocks {
  static constexpr std::size_t kMaterialValues =
      13;  // B (9, by rows), mu V, K V, viscous mu V / dt, viscous lambda V / dt
  std::vector<LaneRow> material;
  std::vector<LaneRow> last_strain;  // 6: xx, yy, zz, xy, xz, yz
  // Per step.
  std::vector<LaneRow> edges;   // 9: x of nodes 1, 2, 3 less x of node 0, by component and then node
  std::vector<LaneRow> forces;  // 9: on nodes 1, 2, 3, by component and then node
  std::vector<LaneRow> strain;  // 1: J^(-2/3) I1 - 3, from which the equivalent strain follows
  // 1: sum of the squares of cof(F)^T cof(F), 3 at rest: its root bounds the square of the largest stretch of an area,
  // by which the stiffness against compression grows. At least kSqueezedAreas where the volume is less than 3/4.
  std::vector<LaneRow> areas;
  std::size_t count = 0;  // of elements

  void resize(std::size_t elements);
  [[nodiscard]] std::size_t blocks() const { return (count + kLanes - 1) / kLanes; }
};

struct KernelSums {
  float largest_strain = 0;  // of `strain`
  float largest_areas = 0;   // of `areas`
  std::uint32_t inverted = 0;
  double energy = 0;  // J, elastic; of small strains only as good as floats are
};

// Fills forces, strain and last_strain from edges and material. No heap memory; any thread, one a set of blocks.
KernelSums compute_element_forces(ElementBlocks& blocks);

// The instruction set in use, as Highway names it: "AVX2", "SSE4", ...
[[nodiscard]] std::string_view simd_target();
// Uses this instruction set from now on, so that results repeat on another machine to the bit; empty: the best one.
// False: the processor does not have it. Not while another thread computes.
bool force_simd_target(std::string_view name);

}  // namespace cellmirror::tissue
