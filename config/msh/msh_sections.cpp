#include "config/msh/msh_sections.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror::msh {

namespace {

struct Row {
  std::int64_t number;
  ElementKind kind;
};

// Gmsh's reference manual, "Node ordering" and the list of elm-type.
constexpr std::array<Row, 32> kKinds{
    {{1, {2, false}},   {2, {3, false}},  {3, {4, false}},   {4, {4, true}},    {5, {8, true}},    {6, {6, true}},
     {7, {5, true}},    {8, {3, false}},  {9, {6, false}},   {10, {9, false}},  {11, {10, true}},  {12, {27, true}},
     {13, {18, true}},  {14, {14, true}}, {15, {1, false}},  {16, {8, false}},  {17, {20, true}},  {18, {15, true}},
     {19, {13, true}},  {20, {9, false}}, {21, {10, false}}, {22, {12, false}}, {23, {15, false}}, {24, {15, false}},
     {25, {21, false}}, {26, {4, false}}, {27, {5, false}},  {28, {6, false}},  {29, {20, true}},  {30, {35, true}},
     {31, {56, true}},  {92, {64, true}}}};

// Their order, 2 to 5; 1 for everything else.
int order_of_tetrahedron(std::int64_t number) {
  switch (number) {
    case 11:
      return 2;
    case 29:
      return 3;
    case 30:
      return 4;
    case 31:
      return 5;
    default:
      return 1;
  }
}

}  // namespace

std::optional<ElementKind> element_kind(std::int64_t number) {
  const auto* const row = std::ranges::find(kKinds, number, &Row::number);
  return row == kKinds.end() ? std::nullopt : std::optional(row->kind);
}

std::optional<ElementKind> accepted_kind(Input& input, std::int64_t number, std::size_t at) {
  if (input.failed()) return std::nullopt;
  if (const int order = order_of_tetrahedron(number); order > 1) {
    input.refuse(at, fmt::format("the tetrahedra are of order {} (elements of kind {})", order, number),
                 "only linear ones are read: gmsh -3 -order 1");
    return std::nullopt;
  }
  const auto kind = element_kind(number);
  if (!kind) input.refuse(at, fmt::format("elements of kind {} are unknown", number), "leave them out of the mesh");
  return kind;
}

void add_element(RawMesh& mesh, std::int64_t kind_number, const ElementKind& kind, std::int64_t id, std::size_t at,
                 const std::array<std::int64_t, 4>& first_nodes) {
  if (kind_number == kTetrahedron) {
    mesh.tetrahedra.push_back({first_nodes, id, at});
    return;
  }
  mesh.other_ids.push_back(id);
  mesh.solids_left_out += kind.solid ? 1 : 0;
}

}  // namespace cellmirror::msh
