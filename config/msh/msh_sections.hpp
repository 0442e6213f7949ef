// What a .msh file says of nodes and elements before ids are resolved, and the readers of its sections by format.
// Private to this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "config/msh/msh_input.hpp"

namespace cellmirror::msh {

struct RawNode {
  std::int64_t id = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  std::size_t at = 0;  // byte
};

struct RawTetra {
  std::array<std::int64_t, 4> nodes{};  // ids
  std::int64_t id = 0;
  std::size_t at = 0;  // byte
};

struct RawMesh {
  std::vector<RawNode> nodes;
  std::vector<RawTetra> tetrahedra;
  std::vector<std::int64_t> other_ids;  // of elements of other kinds
  std::size_t solids_left_out = 0;      // hexahedra, prisms and pyramids
  bool has_nodes = false;
  bool has_elements = false;
};

// Numbers of elements' kinds, the same in all formats.
inline constexpr std::int64_t kTetrahedron = 4;
struct ElementKind {
  std::size_t nodes = 0;
  bool solid = false;  // has a volume
};
// Nothing for kinds that Gmsh's description does not name.
[[nodiscard]] std::optional<ElementKind> element_kind(std::int64_t number);

// Of a kind that fits, or nothing and an error at byte `at`: unknown kinds, and tetrahedra of a higher order.
[[nodiscard]] std::optional<ElementKind> accepted_kind(Input& input, std::int64_t number, std::size_t at);

// Each reads from behind the section's first line to its last one. In case of an error `input` has failed.
void read_nodes_1(Input& input, RawMesh& mesh);
void read_elements_1(Input& input, RawMesh& mesh);
void read_nodes_2(Input& input, RawMesh& mesh);
void read_elements_2(Input& input, RawMesh& mesh);
// `size_bytes`: of the file's unsigned sizes, 4 or 8.
void read_nodes_4(Input& input, RawMesh& mesh, std::size_t size_bytes);
void read_elements_4(Input& input, RawMesh& mesh, std::size_t size_bytes);

// Shared by the formats: `nodes` are the ids of the element's nodes.
void add_element(RawMesh& mesh, std::int64_t kind_number, const ElementKind& kind, std::int64_t id, std::size_t at,
                 const std::array<std::int64_t, 4>& first_nodes);

}  // namespace cellmirror::msh
