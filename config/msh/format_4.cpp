// Format 4.1: nodes and elements in blocks, one an entity of the geometry.
#include <algorithm>
#include <string>

#include "config/msh/msh_file.hpp"
#include "config/msh/msh_sections.hpp"

namespace cellmirror::msh {

namespace {

constexpr std::size_t kMostBlocks = 1'000'000;

// Numbers that the format calls size_t.
std::int64_t size_value(Input& input, std::size_t size_bytes, const char* what) {
  if (!input.binary()) return input.integer(what);
  const std::size_t at = input.offset();
  const std::uint64_t value =
      size_bytes == sizeof(std::uint32_t) ? input.value<std::uint32_t>(what) : input.value<std::uint64_t>(what);
  if (value > static_cast<std::uint64_t>(INT64_MAX)) {
    input.refuse(at, std::string("the value of ") + what + " is too large", "the file is damaged: export it again");
    return 0;
  }
  return static_cast<std::int64_t>(value);
}

struct BlockHeader {
  std::size_t blocks = 0;
  std::size_t items = 0;
};

// `least_bytes`: of an item.
BlockHeader read_block_header(Input& input, std::size_t size_bytes, std::size_t least_bytes, std::size_t most,
                              const char* what) {
  if (input.binary()) input.line();
  const std::size_t at = input.binary() ? input.offset() : input.next();
  const std::int64_t blocks = size_value(input, size_bytes, "the number of blocks");
  const std::int64_t items = size_value(input, size_bytes, "the number of items");
  size_value(input, size_bytes, "the least id");
  size_value(input, size_bytes, "the greatest id");
  BlockHeader header;
  header.blocks = input.checked_count(blocks, at, 8, kMostBlocks, "blocks");
  header.items = input.checked_count(items, at, least_bytes, most, what);
  return header;
}

std::size_t here(Input& input) { return input.binary() ? input.offset() : input.next(); }

// How many items a block has; at most `rest`, those that no block before had.
std::size_t block_count(Input& input, std::int64_t announced, std::size_t rest, std::size_t at, std::size_t least_bytes,
                        const char* what) {
  if (!input.failed() && announced > static_cast<std::int64_t>(rest))
    input.refuse(at, std::string("the blocks have more ") + what + " than are announced", "export the mesh again");
  return input.checked_count(announced, at, least_bytes, rest, what);
}

void expect_all(Input& input, std::size_t done, std::size_t announced, const char* what) {
  if (!input.failed() && done != announced) {
    input.refuse(here(input),
                 "the blocks have " + std::to_string(done) + " " + what + ", but " + std::to_string(announced) +
                     " are announced",
                 "export the mesh again");
  }
}

// Ids first, then coordinates in the same order.
void read_node_block(Input& input, RawMesh& mesh, std::size_t size_bytes, std::size_t count, std::size_t parameters) {
  const std::size_t first = mesh.nodes.size();
  for (std::size_t i = 0; i < count && !input.failed(); ++i) {
    RawNode node;
    node.at = here(input);
    node.id = size_value(input, size_bytes, "the id of a node");
    mesh.nodes.push_back(node);
  }
  for (std::size_t i = first; i < mesh.nodes.size() && !input.failed(); ++i) {
    mesh.nodes[i].at = here(input);
    for (int k = 0; k < 3; ++k) mesh.nodes[i].p[k] = input.number_as("a coordinate");
    for (std::size_t k = 0; k < parameters; ++k) input.number_as("a parameter of a node");
  }
}

}  // namespace

void read_nodes_4(Input& input, RawMesh& mesh, std::size_t size_bytes) {
  const std::size_t least = input.binary() ? size_bytes + 3 * sizeof(double) : 8;
  const BlockHeader header = read_block_header(input, size_bytes, least, kMostNodes, "nodes");
  mesh.nodes.reserve(header.items);
  for (std::size_t block = 0; block < header.blocks && !input.failed(); ++block) {
    const std::size_t at = here(input);
    const std::int64_t dimension = input.integer_as<std::int32_t>("the dimension of an entity");
    input.integer_as<std::int32_t>("the number of an entity");
    const std::int64_t parametric = input.integer_as<std::int32_t>("0 or 1");
    const std::int64_t announced = size_value(input, size_bytes, "the number of nodes in a block");
    if (!input.failed() && (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1))
      input.refuse(at, "a block of nodes is neither of dimension 0 to 3 nor parametric 0 or 1",
                   "export the mesh again");
    const std::size_t count = block_count(input, announced, header.items - mesh.nodes.size(), at, least, "nodes");
    const std::size_t parameters = parametric == 1 ? static_cast<std::size_t>(std::max<std::int64_t>(dimension, 0)) : 0;
    if (!input.failed()) read_node_block(input, mesh, size_bytes, count, parameters);
  }
  expect_all(input, mesh.nodes.size(), header.items, "nodes");
  input.expect("$EndNodes");
}

void read_elements_4(Input& input, RawMesh& mesh, std::size_t size_bytes) {
  const std::size_t least = input.binary() ? 2 * size_bytes : 4;
  const BlockHeader header = read_block_header(input, size_bytes, least, kMostElements, "elements");
  std::size_t done = 0;
  for (std::size_t block = 0; block < header.blocks && !input.failed(); ++block) {
    const std::size_t at = here(input);
    input.integer_as<std::int32_t>("the dimension of an entity");
    input.integer_as<std::int32_t>("the number of an entity");
    const std::int64_t number = input.integer_as<std::int32_t>("the kind of elements");
    const std::int64_t announced = size_value(input, size_bytes, "the number of elements in a block");
    const auto kind = accepted_kind(input, number, at);
    if (!kind) return;
    const std::size_t bytes = (1 + kind->nodes) * (input.binary() ? size_bytes : 2);
    const std::size_t count = block_count(input, announced, header.items - done, at, bytes, "elements");
    for (std::size_t i = 0; i < count && !input.failed(); ++i) {
      const std::size_t begin = here(input);
      const std::int64_t id = size_value(input, size_bytes, "the id of an element");
      std::array<std::int64_t, 4> first{};
      for (std::size_t k = 0; k < kind->nodes; ++k) {
        const std::int64_t node = size_value(input, size_bytes, "a node of an element");
        if (k < first.size()) first[k] = node;
      }
      if (!input.failed()) add_element(mesh, number, *kind, id, begin, first);
    }
    done += count;
  }
  expect_all(input, done, header.items, "elements");
  input.expect("$EndElements");
}

}  // namespace cellmirror::msh
