#include "config/mesh_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "config/mesh_message/stl_text.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

namespace {

Result<void> check_stl(std::string_view bytes) {
  const auto count = stl_triangles(bytes);
  if (stl_has_size_of_binary(bytes)) {
    if (*count <= geometry::kMostTriangles) return {};
    return fail(fmt::format("it has {} triangles, more than {}", *count, geometry::kMostTriangles), "reduce the mesh");
  }
  if (stl_text_begin(bytes) == std::string_view::npos) {
    if (!count) return fail("it is not an STL file");
    return fail(fmt::format("it is not an STL file: {} triangles need {} bytes, but it has {}", *count,
                            kStlHeader + kStlTriangle * std::size_t{*count}, bytes.size()),
                "export it again");
  }
  const auto plain = plain_stl_text(bytes);
  if ((plain ? std::string_view(*plain) : bytes).find("facet") == std::string_view::npos)
    return fail("it has no facets");
  return {};
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t";
  constexpr std::size_t kMostWords = 8;
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at < line.size() && words.size() < kMostWords;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

bool is_ply_type(std::string_view word) {
  static constexpr std::array<std::string_view, 16> kTypes{"char",  "uchar",  "short",   "ushort", "int",   "uint",
                                                           "float", "double", "int8",    "uint8",  "int16", "uint16",
                                                           "int32", "uint32", "float32", "float64"};
  return std::ranges::find(kTypes, word) != kTypes.end();
}

bool is_ply_line(const std::vector<std::string_view>& words) {
  if (words.empty()) return false;
  if (words[0] == "comment" || words[0] == "obj_info") return true;
  if (words[0] == "format") return words.size() == 3;
  if (words[0] == "element") return words.size() == 3;
  if (words[0] != "property") return false;
  if (words.size() == 3) return is_ply_type(words[1]);
  return words.size() == 5 && words[1] == "list" && is_ply_type(words[2]) && is_ply_type(words[3]);
}

// The header line by line: assimp trusts its counts, and searches its end forever if it is damaged.
Result<void> check_ply(std::string_view bytes) {
  constexpr int kMostLines = 1000;
  std::size_t at = 0;
  for (int number = 1; number <= kMostLines; ++number) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) break;
    std::string_view line = bytes.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at = end + 1;
    if (number == 1 && line != "ply") return fail("it is not a PLY file");
    if (number == 1) continue;
    if (line == "end_header") return {};
    const auto words = words_of(line);
    if (!is_ply_line(words)) return fail(fmt::format("line {} of its header is faulty", number), "export it again");
    if (words[0] != "element") continue;
    // Every element takes at least a byte, so their number is bounded by the bytes.
    const auto count = parse_integer(words[2]);
    if (!count || *count < 0 || static_cast<std::size_t>(*count) > bytes.size())
      return fail(fmt::format("it has fewer elements {} than declared in its header", printable(words[1])),
                  "export it again");
  }
  return fail("its header does not end", "export it again");
}

}  // namespace

Result<void> check_mesh_bytes(std::string_view bytes, std::string_view extension) {
  if (bytes.empty()) return fail("it is empty");
  if (extension == ".stl") return check_stl(bytes);
  if (extension == ".ply") return check_ply(bytes);
  if (extension == ".dae") return check_dae(bytes);
  if (extension == ".gltf") return check_gltf(bytes);
  if (extension == ".glb") return check_glb(bytes);
  return {};
}

}  // namespace cellmirror
