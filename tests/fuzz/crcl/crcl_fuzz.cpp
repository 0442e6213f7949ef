// Bytes as a CRCL document. What is read in place is compared with what expat alone reads: the same elements with the
// same texts and places, and the same findings.
#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "scripts/programs/crcl/crcl.hpp"
#include "scripts/programs/crcl/xml_reader.hpp"
#include "tests/support/program_fuzz.hpp"

namespace {

using namespace cellmirror;

void describe(const crcl::XmlTree& tree, const crcl::XmlNode& node, int depth, std::string& out) {
  out += fmt::format("{} {}:{} {} [{}] [{}]\n", depth, node.line, node.column, node.name, node.type, node.text);
  for (const crcl::XmlNode* one = tree.first(node); one != nullptr; one = tree.next(*one)) {
    describe(tree, *one, depth + 1, out);
  }
}

template <typename Read>
std::string visited(Read read) {
  std::string out;
  Diagnostics findings;
  const crcl::XmlVisitor visitor = {
      .root =
          [&](const crcl::XmlNode& root) {
            out += fmt::format("root {}:{} {}\n", root.line, root.column, root.name);
            return root.name != "unwanted";
          },
      .element = [&](const crcl::XmlTree& tree) { describe(tree, tree.root(), 0, out); },
  };
  read(visitor, findings);
  return out + findings.text();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string file = "fuzz";
  const std::string mostly_in_place = visited(
      [&](const crcl::XmlVisitor& visitor, Diagnostics& findings) { crcl::read_xml(text, file, visitor, findings); });
  const std::string by_expat = visited([&](const crcl::XmlVisitor& visitor, Diagnostics& findings) {
    crcl::read_xml_by_expat(text, file, visitor, findings);
  });
  program::require(mostly_in_place == by_expat);
  program::read_fuzzed(program::crcl_language(), text);
  return 0;
}
