#include "scripts/programs/crcl/crcl.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"
#include "scripts/programs/crcl/command_reader.hpp"
#include "scripts/programs/crcl/xml_reader.hpp"
#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program {
namespace {

std::shared_ptr<const Program> parse(std::string_view text, const ParseContext& context, Diagnostics& diagnostics) {
  if (text.size() > kLargestProgramText) {
    diagnostics.error({.file = context.file}, fmt::format("the program has {} bytes", text.size()),
                      fmt::format("the limit is {}: split it", kLargestProgramText));
    return nullptr;
  }
  Diagnostics found;
  ProgramBuilder builder(name_of_file(context.file), "crcl", context.file);
  constexpr std::size_t kShortMove = 250;  // bytes
  builder.reserve(text.size() / kShortMove);
  crcl::CommandReader reader(builder, context.file, found);
  int root_line = 0;
  int root_column = 0;
  const crcl::XmlVisitor visitor = {
      .root =
          [&](const crcl::XmlNode& root) {
            root_line = static_cast<int>(root.line);
            root_column = static_cast<int>(root.column);
            if (root.name == "CRCLProgram") return true;
            found.error({.file = context.file, .line = root_line},
                        fmt::format("<{}> is not a CRCL program", printable(root.name)),
                        "it must begin with <CRCLProgram>");
            return false;
          },
      .element = [&](const crcl::XmlTree& element) { reader.read(element); },
  };
  crcl::read_xml(text, context.file, visitor, found);
  reader.finish({.file = context.file, .line = root_line, .column = root_column});
  auto made = builder.build(found, context.read_part);
  diagnostics.take(found);
  return made;
}

}  // namespace

const Language& crcl_language() {
  static const Language crcl_entry = {.name = "crcl",
                                      .summary = "CRCL, the canonical robot command language of NIST (XML)",
                                      .extensions = {".crcl", ".xml"},
                                      .codes_file = {},
                                      .parse = &parse};
  return crcl_entry;
}

}  // namespace cellmirror::program
