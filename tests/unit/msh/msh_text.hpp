// .msh files as bytes, written by hand from the description of the formats: two tetrahedra that share a face, over the
// unit axes and up to (1, 1, 1), with a surface triangle and a point besides. Volumes 1/6 and 1/3.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror {

inline constexpr std::array<std::array<double, 3>, 5> kNodes{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}};

inline std::string msh1() {
  return "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$ENDNOD\n"
         "$ELM\n4\n1 15 0 1 1 1\n2 2 7 1 3 1 2 3\n3 4 9 1 4 1 2 3 4\n4 4 9 1 4 2 3 4 5\n$ENDELM\n";
}

inline const char* const kNodes2 = "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n";
inline const char* const kElements2 =
    "$Elements\n4\n1 15 2 0 1 1\n2 2 2 7 1 1 2 3\n3 4 2 9 1 1 2 3 4\n4 4 2 9 1 2 3 4 5\n$EndElements\n";

inline std::string msh2_of(const std::string& nodes, const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 9 \"liver\"\n$EndPhysicalNames\n" + nodes +
         elements;
}
inline std::string msh2() { return msh2_of(kNodes2, kElements2); }

inline std::string msh4() {
  return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n"
         "$Nodes\n2 5 1 5\n0 1 0 1\n1\n0 0 0\n3 1 1 4\n2\n3\n4\n5\n"
         "1 0 0 0.5 0.5 0.5\n0 1 0 0 0 0\n0 0 1 0 0 0\n1 1 1 0 0 0\n$EndNodes\n"
         "$Elements\n3 4 1 4\n0 1 15 1\n1 1\n2 1 2 1\n2 1 2 3\n3 1 4 2\n3 1 2 3 4\n4 2 3 4 5\n$EndElements\n";
}

// Values of a binary file in either byte order.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  Bytes& text(const std::string& text) {
    out += text;
    return *this;
  }
  Bytes& i32(std::int32_t value) { return put(static_cast<std::uint32_t>(value), 4); }
  Bytes& size(std::uint64_t value) { return put(value, 8); }
  Bytes& f64(double value) { return put(std::bit_cast<std::uint64_t>(value), 8); }

  std::string out;

 private:
  Bytes& put(std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) {
      const unsigned shift = 8 * (big_endian_ ? bytes - 1 - i : i);
      out.push_back(static_cast<char>((value >> shift) & 0xFFU));
    }
    return *this;
  }
  bool big_endian_;
};

inline std::string msh2_binary(bool big_endian = false) {
  Bytes file(big_endian);
  file.text("$MeshFormat\n2.2 1 8\n").i32(1).text("\n$EndMeshFormat\n$Nodes\n5\n");
  for (std::int32_t i = 0; i < 5; ++i) {
    file.i32(i + 1);
    for (const double x : kNodes.at(static_cast<std::size_t>(i))) file.f64(x);
  }
  file.text("\n$EndNodes\n$Elements\n4\n");
  file.i32(15).i32(1).i32(2).i32(1).i32(0).i32(1).i32(1);
  file.i32(2).i32(1).i32(2).i32(2).i32(7).i32(1).i32(1).i32(2).i32(3);
  file.i32(4).i32(2).i32(2);
  file.i32(3).i32(9).i32(1).i32(1).i32(2).i32(3).i32(4);
  file.i32(4).i32(9).i32(1).i32(2).i32(3).i32(4).i32(5);
  return file.text("\n$EndElements\n").out;
}

inline std::string msh4_binary(bool big_endian = false) {
  Bytes file(big_endian);
  file.text("$MeshFormat\n4.1 1 8\n").i32(1).text("\n$EndMeshFormat\n$Nodes\n");
  file.size(1).size(5).size(1).size(5);
  file.i32(3).i32(1).i32(0).size(5);
  for (std::uint64_t i = 1; i <= 5; ++i) file.size(i);
  for (const auto& node : kNodes) {
    for (const double x : node) file.f64(x);
  }
  file.text("\n$EndNodes\n$Elements\n");
  file.size(2).size(3).size(2).size(4);
  file.i32(2).i32(1).i32(2).size(1).size(2).size(1).size(2).size(3);
  file.i32(3).i32(1).i32(4).size(2);
  file.size(3).size(1).size(2).size(3).size(4);
  file.size(4).size(2).size(3).size(4).size(5);
  return file.text("\n$EndElements\n").out;
}

// The text with the first `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "there is no " + from : text.replace(at, from.size(), to);
}

}  // namespace cellmirror
