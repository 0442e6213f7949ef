// Source: "MTL material format (Lightwave, OBJ)", Alias|Wavefront 1995: newmtl, Kd, map_Kd with its options.
#include "config/obj_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::string_view kSpaces = " \t\r";
constexpr std::size_t kMostFiles = 16;
constexpr std::size_t kMostObjMaterials = 10'000;
constexpr std::size_t kLongestName = 1024;

// Calls use(number, line) for each line, without blanks around it.
template <class Use>
void for_each_line(std::string_view text, Use use) {
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(kSpaces), line.size()));
    line = line.substr(0, line.find_last_not_of(kSpaces) + 1);
    use(number, line);
  }
}

std::string_view take_word(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of(kSpaces), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  rest.remove_prefix(std::min(rest.find_first_not_of(kSpaces), rest.size()));
  return word;
}

// What follows `keyword` in the line, where it begins with that.
std::optional<std::string_view> after(std::string_view line, std::string_view keyword) {
  std::string_view rest = line;
  if (!equal_ignoring_case(take_word(rest), keyword) || rest.empty() || rest.size() > kLongestName) return std::nullopt;
  return rest;
}

// -o, -s and -t have one to three numbers, -mm two, the others one word.
std::string_view without_options(std::string_view rest) {
  while (rest.starts_with('-')) {
    const std::string_view option = take_word(rest);
    if (option == "-o" || option == "-s" || option == "-t") {
      for (int i = 0; i < 3; ++i) {
        std::string_view tail = rest;
        if (!parse_number(take_word(tail))) break;
        rest = tail;
      }
      continue;
    }
    take_word(rest);
    if (option == "-mm") take_word(rest);
  }
  return rest;
}

void read_colour(std::string_view rest, std::array<float, 3>& rgb) {
  std::array<float, 3> read{};
  for (float& part : read) {
    const auto value = parse_number(take_word(rest));
    if (!value || !std::isfinite(*value)) return;
    part = static_cast<float>(std::clamp(*value, 0.0, 1.0));
  }
  rgb = read;
}

}  // namespace

std::vector<std::string> material_files(std::string_view obj) {
  std::vector<std::string> names;
  for_each_line(obj, [&](int, std::string_view line) {
    const auto name = after(line, "mtllib");
    if (!name || names.size() >= kMostFiles || std::ranges::find(names, *name) != names.end()) return;
    names.emplace_back(*name);
  });
  return names;
}

void read_obj_materials(std::string_view text, const std::string& file, ObjMaterials& materials) {
  ObjMaterial* current = nullptr;
  for_each_line(text, [&](int number, std::string_view line) {
    if (const auto name = after(line, "newmtl")) {
      const bool room = materials.size() < kMostObjMaterials;
      const auto [at, is_new] = room ? materials.try_emplace(std::string(*name)) : std::pair(materials.end(), false);
      current = is_new ? &at->second : nullptr;
    }
    if (current == nullptr) return;
    if (const auto rest = after(line, "Kd")) read_colour(*rest, current->rgb);
    if (const auto rest = after(line, "map_Kd")) {
      current->picture = without_options(*rest);
      current->place = fmt::format("{}:{}", file, number);
    }
  });
}

}  // namespace cellmirror
