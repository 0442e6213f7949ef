// Format 1: ASCII, $NOD and $ELM.
#include "config/msh/msh_file.hpp"
#include "config/msh/msh_sections.hpp"

namespace cellmirror::msh {

void read_nodes_1(Input& input, RawMesh& mesh) {
  const std::size_t at = input.next();
  constexpr std::size_t kLeast = 8;  // "1 0 0 0\n"
  const std::size_t count = input.checked_count(input.integer("the number of nodes"), at, kLeast, kMostNodes, "nodes");
  mesh.nodes.reserve(count);
  for (std::size_t i = 0; i < count && !input.failed(); ++i) {
    RawNode node;
    node.at = input.next();
    node.id = input.integer("the id of a node");
    for (int k = 0; k < 3; ++k) node.p[k] = input.number("a coordinate");
    mesh.nodes.push_back(node);
  }
  input.expect("$ENDNOD");
}

void read_elements_1(Input& input, RawMesh& mesh) {
  const std::size_t start = input.next();
  constexpr std::size_t kLeast = 12;  // "1 15 0 0 1 1"
  const std::size_t count =
      input.checked_count(input.integer("the number of elements"), start, kLeast, kMostElements, "elements");
  for (std::size_t i = 0; i < count && !input.failed(); ++i) {
    const std::size_t at = input.next();
    const std::int64_t id = input.integer("the id of an element");
    const std::int64_t number = input.integer("the kind of an element");
    const auto kind = accepted_kind(input, number, at);
    input.integer("a region");
    input.integer("a region");
    const std::int64_t nodes = input.integer("the number of an element's nodes");
    if (!kind || input.failed()) return;
    if (nodes != static_cast<std::int64_t>(kind->nodes)) {
      input.refuse(at, "the element has another number of nodes than its kind", "export the mesh again");
      return;
    }
    std::array<std::int64_t, 4> first{};
    for (std::size_t k = 0; k < kind->nodes; ++k) {
      const std::int64_t node = input.integer("a node of an element");
      if (k < first.size()) first[k] = node;
    }
    add_element(mesh, number, *kind, id, at, first);
  }
  input.expect("$ENDELM");
}

}  // namespace cellmirror::msh
