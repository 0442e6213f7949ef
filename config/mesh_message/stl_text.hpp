// Distinguishes ASCII STL from binary STL by the size of the file: files of both kinds may begin with "solid".
#pragma once

#include <cctype>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cellmirror {

inline constexpr std::size_t kStlHeader = 84;    // bytes; the last four are the number of triangles
inline constexpr std::size_t kStlTriangle = 50;  // bytes

// The number of triangles in the header of a binary file; nothing if the file is shorter than a header.
[[nodiscard]] inline std::optional<std::uint32_t> stl_triangles(std::string_view bytes) {
  if (bytes.size() < kStlHeader) return std::nullopt;
  std::uint32_t count = 0;
  for (std::size_t i = 4; i-- > 0;) count = (count << 8U) | static_cast<unsigned char>(bytes[kStlHeader - 4 + i]);
  return count;
}

[[nodiscard]] inline bool stl_has_size_of_binary(std::string_view bytes) {
  const auto count = stl_triangles(bytes);
  return count && bytes.size() == kStlHeader + kStlTriangle * std::size_t{*count};
}

// The position of "solid", in letters of any case, behind a byte order mark and blanks; npos if the file is not text.
[[nodiscard]] inline std::size_t stl_text_begin(std::string_view bytes) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  constexpr std::string_view kSolid = "solid";
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n", bytes.starts_with(kMark) ? kMark.size() : 0);
  if (begin == std::string_view::npos || bytes.size() - begin < kSolid.size()) return std::string_view::npos;
  for (std::size_t i = 0; i < kSolid.size(); ++i) {
    if (std::tolower(static_cast<unsigned char>(bytes[begin + i])) != kSolid[i]) return std::string_view::npos;
  }
  return begin;
}

// The text from "solid" on in small letters, which is all that assimp reads; nothing if assimp reads `bytes` as they
// are.
[[nodiscard]] inline std::optional<std::string> plain_stl_text(std::string_view bytes) {
  const std::size_t begin = stl_text_begin(bytes);
  if (begin == std::string_view::npos || stl_has_size_of_binary(bytes) ||
      (bytes.starts_with("solid") && bytes.find("facet") != std::string_view::npos))
    return std::nullopt;
  std::string text(bytes.substr(begin));
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace cellmirror
