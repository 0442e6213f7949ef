// Formats 2.0 to 2.2: $Nodes and $Elements, ASCII or binary with 4-byte ids.
#include <string>

#include "config/msh/msh_file.hpp"
#include "config/msh/msh_sections.hpp"

namespace cellmirror::msh {

namespace {

constexpr std::int64_t kMostTags = 1000;

// Ids, tags and nodes behind the header of a binary block; in ASCII each element has a header of its own.
void read_element_2(Input& input, RawMesh& mesh, std::int64_t number, const ElementKind& kind, std::int64_t id,
                    std::int64_t tags, std::size_t at) {
  for (std::int64_t k = 0; k < tags && !input.failed(); ++k) input.integer_as<std::int32_t>("a tag of an element");
  std::array<std::int64_t, 4> first{};
  for (std::size_t k = 0; k < kind.nodes; ++k) {
    const std::int64_t node = input.integer_as<std::int32_t>("a node of an element");
    if (k < first.size()) first[k] = node;
  }
  if (!input.failed()) add_element(mesh, number, kind, id, at, first);
}

bool check_tags(Input& input, std::int64_t tags, std::size_t at) {
  if (!input.failed() && (tags < 0 || tags > kMostTags))
    input.refuse(at, "the number of tags of an element is " + std::to_string(tags), "export the mesh again");
  return !input.failed();
}

void read_ascii_elements(Input& input, RawMesh& mesh, std::size_t count) {
  for (std::size_t i = 0; i < count && !input.failed(); ++i) {
    const std::size_t at = input.next();
    const std::int64_t id = input.integer("the id of an element");
    const std::int64_t number = input.integer("the kind of an element");
    const auto kind = accepted_kind(input, number, at);
    const std::int64_t tags = input.integer("the number of tags");
    if (!kind || !check_tags(input, tags, at)) return;
    read_element_2(input, mesh, number, *kind, id, tags, at);
  }
}

void read_binary_elements(Input& input, RawMesh& mesh, std::size_t count) {
  std::size_t done = 0;
  while (done < count && !input.failed()) {
    const std::size_t at = input.offset();
    const std::int64_t number = input.value<std::int32_t>("the kind of elements");
    const std::int64_t block = input.value<std::int32_t>("the number of elements that follow");
    const std::int64_t tags = input.value<std::int32_t>("the number of tags");
    const auto kind = accepted_kind(input, number, at);
    if (!kind || !check_tags(input, tags, at)) return;
    const std::size_t bytes = sizeof(std::int32_t) * (1 + static_cast<std::size_t>(tags) + kind->nodes);
    if (!input.failed() && (block < 1 || block > static_cast<std::int64_t>(count - done)))
      input.refuse(at, "a block has no elements, or more than are announced", "export the mesh again");
    const std::size_t here = input.checked_count(block, at, bytes, count - done, "elements");
    for (std::size_t i = 0; i < here && !input.failed(); ++i) {
      const std::size_t begin = input.offset();
      const std::int64_t id = input.value<std::int32_t>("the id of an element");
      read_element_2(input, mesh, number, *kind, id, tags, begin);
    }
    done += here;
  }
}

}  // namespace

void read_nodes_2(Input& input, RawMesh& mesh) {
  const std::size_t start = input.next();
  constexpr std::size_t kLeastText = 8;  // "1 0 0 0\n"
  constexpr std::size_t kLeastBinary = 28;
  const std::int64_t announced = input.integer("the number of nodes");
  if (input.binary()) input.line();
  const std::size_t count =
      input.checked_count(announced, start, input.binary() ? kLeastBinary : kLeastText, kMostNodes, "nodes");
  mesh.nodes.reserve(count);
  for (std::size_t i = 0; i < count && !input.failed(); ++i) {
    RawNode node;
    node.at = input.binary() ? input.offset() : input.next();
    node.id = input.integer_as<std::int32_t>("the id of a node");
    for (int k = 0; k < 3; ++k) node.p[k] = input.number_as("a coordinate");
    mesh.nodes.push_back(node);
  }
  input.expect("$EndNodes");
}

void read_elements_2(Input& input, RawMesh& mesh) {
  const std::size_t start = input.next();
  constexpr std::size_t kLeast = 8;  // "1 15 0 1", and as a binary point
  const std::int64_t announced = input.integer("the number of elements");
  if (input.binary()) input.line();
  const std::size_t count = input.checked_count(announced, start, kLeast, kMostElements, "elements");
  if (input.binary()) {
    read_binary_elements(input, mesh, count);
  } else {
    read_ascii_elements(input, mesh, count);
  }
  input.expect("$EndElements");
}

}  // namespace cellmirror::msh
