#include "config/msh/msh_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <utility>

#include "config/msh/msh_input.hpp"
#include "config/msh/msh_sections.hpp"
#include "config/msh/tetra_check.hpp"
#include "config/msh/tetra_surface.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::msh {

namespace {

enum class Format { unknown, one, two, four };

struct Header {
  Format format = Format::unknown;
  std::size_t size_bytes = 8;
};

constexpr const char* kFormats = "save it as format 4.1, 2.2 or 1: gmsh -format msh41 or msh22";

Format format_of(std::string_view version) {
  if (version == "4.1") return Format::four;
  static constexpr std::array<std::string_view, 4> kTwo{"2", "2.0", "2.1", "2.2"};
  for (const std::string_view known : kTwo) {
    if (version == known) return Format::two;
  }
  return Format::unknown;
}

// Behind the line of $MeshFormat in binary files: the integer 1 shows the byte order.
void read_byte_order(Input& input) {
  input.line();
  const std::size_t at = input.offset();
  const auto one = input.value<std::int32_t>("the integer 1 that shows the byte order");
  constexpr std::int32_t kSwapped = 0x01000000;
  if (input.failed() || one == 1) return;
  if (one != kSwapped) return input.refuse(at, "the integer 1 that shows the byte order is missing", kFormats);
  input.set_swapped(true);
}

Header read_header(Input& input) {
  Header header;
  const std::size_t at = input.next();
  const std::string_view version = input.word();
  header.format = format_of(version);
  if (header.format == Format::unknown && !input.failed())
    input.refuse(at, fmt::format("format {} is not read", printable(version, 20)), kFormats);
  const std::int64_t kind = input.integer("the kind of file, 0 or 1");
  const std::int64_t size = input.integer("the size of a number");
  if (!input.failed() && (kind < 0 || kind > 1 || (size != 8 && (size != 4 || header.format != Format::four)))) {
    input.refuse(at, fmt::format("the kind of file is {} and the size of a number {}, which is not read", kind, size),
                 kFormats);
  }
  header.size_bytes = static_cast<std::size_t>(size);
  if (!input.failed() && kind == 1) {
    input.set_binary(true);
    read_byte_order(input);
  }
  input.expect("$EndMeshFormat");
  return header;
}

// A section appears once, and with nodes and elements the format is known.
bool begin(Input& input, std::size_t at, bool& seen, const Header& header, Format first, Format second) {
  if (seen) input.refuse(at, "the section appears twice", "export the mesh again");
  if (header.format != first && header.format != second)
    input.refuse(at, "the section does not belong to the format of the file, or stands before $MeshFormat", kFormats);
  seen = true;
  return !input.failed();
}

void skip_section(Input& input, std::size_t at, std::string_view name) {
  const std::string rest(name.substr(1));
  if (input.skip_behind("$End" + rest) || input.skip_behind("$END" + rest)) return;
  input.refuse(at, fmt::format("the section {} has no end", printable(name, 40)), "the file is cut off or damaged");
}

void read_section(Input& input, std::size_t at, std::string_view name, Header& header, RawMesh& mesh) {
  if (name == "$MeshFormat") {
    if (header.format != Format::unknown) return input.refuse(at, "the section appears twice", "export the mesh again");
    header = read_header(input);
  } else if (name == "$NOD" || name == "$ELM") {
    if (header.format == Format::unknown) header.format = Format::one;
    bool& seen = name == "$NOD" ? mesh.has_nodes : mesh.has_elements;
    if (!begin(input, at, seen, header, Format::one, Format::one)) return;
    name == "$NOD" ? read_nodes_1(input, mesh) : read_elements_1(input, mesh);
  } else if (name == "$Nodes") {
    if (!begin(input, at, mesh.has_nodes, header, Format::two, Format::four)) return;
    header.format == Format::two ? read_nodes_2(input, mesh) : read_nodes_4(input, mesh, header.size_bytes);
  } else if (name == "$Elements") {
    if (!begin(input, at, mesh.has_elements, header, Format::two, Format::four)) return;
    header.format == Format::two ? read_elements_2(input, mesh) : read_elements_4(input, mesh, header.size_bytes);
  } else {
    skip_section(input, at, name);
  }
}

void read_sections(Input& input, RawMesh& mesh) {
  Header header;
  while (!input.failed()) {
    const std::size_t at = input.next();
    const std::string_view name = input.word();
    if (name.empty()) break;
    if (name.size() < 2 || name.front() != '$') {
      input.refuse(at, fmt::format("a section is expected, but \"{}\" is found", printable(name, 40)),
                   "the file is no .msh file of Gmsh, or damaged");
      return;
    }
    read_section(input, at, name, header, mesh);
  }
  if (input.failed()) return;
  if (!mesh.has_nodes || !mesh.has_elements)
    return input.refuse(0, mesh.has_nodes ? "the file has no elements" : "the file has no nodes",
                        "save the mesh of the volume: gmsh -3");
  if (mesh.tetrahedra.empty())
    input.refuse(0, "the file has no tetrahedra", "mesh the volume with tetrahedra: gmsh -3, without recombination");
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::optional<tissue::TetraMesh> parse_msh(std::string_view bytes, const std::string& file, double scale,
                                           Diagnostics& diagnostics) {
  Input input(bytes, file, diagnostics);
  RawMesh raw;
  read_sections(input, raw);
  if (input.failed()) return std::nullopt;
  std::size_t turned = 0;
  auto mesh = check_tetrahedra(input, raw, scale, turned);
  if (!mesh) return std::nullopt;
  const Place whole{file, 0, 0};
  if (const auto surface = surface_of(*mesh); !surface) {
    diagnostics.error(whole, surface.error().what, surface.error().remedy);
    return std::nullopt;
  }
  if (raw.solids_left_out > 0) {
    diagnostics.warning(whole,
                        counted(raw.solids_left_out, "hexahedron, prism or pyramid is left out",
                                "hexahedra, prisms and pyramids are left out"),
                        "mesh the volume with tetrahedra alone");
  }
  if (turned > 0) {
    diagnostics.add({Severity::note, whole, counted(turned, "tetrahedron was inverted", "tetrahedra were inverted"),
                     "this was corrected while reading"});
  }
  return mesh;
}

std::optional<tissue::TetraMesh> read_msh(const std::filesystem::path& path, double scale, Diagnostics& diagnostics) {
  const auto bytes = read_text_file(path, kLargestFile);
  if (!bytes) {
    diagnostics.error({path.string(), 0, 0}, bytes.error().what, bytes.error().remedy);
    return std::nullopt;
  }
  return parse_msh(*bytes, path.string(), scale, diagnostics);
}

}  // namespace cellmirror::msh
