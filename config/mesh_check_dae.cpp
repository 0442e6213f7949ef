// assimp 5.2.5 allocates what the counts of a DAE say, follows nodes that show themselves, reads numbers from text that
// holds none, for ever, and vertices and weights from behind the end of arrays.
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "config/mesh_check.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

using tinyxml2::XMLElement;

constexpr std::string_view kBlanks = " \t\r\n";

// Numbers, separated by blanks.
bool holds_numbers(std::string_view text, bool whole) {
  for (std::size_t at = text.find_first_not_of(kBlanks); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    constexpr std::size_t kLongest = 64;
    if (word.size() > kLongest) return false;
    if (whole && word.find_first_not_of("0123456789") != std::string_view::npos) return false;
    if (!parse_number(word)) return false;
    at = text.find_first_not_of(kBlanks, end);
  }
  return true;
}

Error fault_at(const XMLElement& element, const char* what) {
  return {fmt::format("<{}> in line {} {}", printable(element.Name()), element.GetLineNum(), what), "export it again"};
}

// Depth first.
const XMLElement* next_element(const XMLElement& element) {
  if (const XMLElement* child = element.FirstChildElement()) return child;
  for (const XMLElement* at = &element; at != nullptr;) {
    if (const XMLElement* sibling = at->NextSiblingElement()) return sibling;
    const tinyxml2::XMLNode* parent = at->Parent();
    at = parent == nullptr ? nullptr : parent->ToElement();
  }
  return nullptr;
}

Result<void> check_element(const XMLElement& element, std::size_t bytes) {
  static constexpr std::array<std::string_view, 4> kWhole{"p", "v", "vcount", "h"};
  static constexpr std::array<std::string_view, 8> kNumbers{"float_array", "int_array", "matrix", "translate",
                                                            "rotate",      "scale",     "lookat", "skew"};
  const std::string_view name = element.Name();
  const bool whole = std::ranges::find(kWhole, name) != kWhole.end();
  const auto fault = [&](const char* what) { return std::unexpected(fault_at(element, what)); };
  // Its indices of joints and weights are used unseen, and what is rigid needs none.
  if (name == "skin") return fault("skins a mesh to a skeleton, but meshes of a cell are rigid");
  if (whole || std::ranges::find(kNumbers, name) != kNumbers.end()) {
    for (const tinyxml2::XMLNode* child = element.FirstChild(); child != nullptr; child = child->NextSibling()) {
      if (child->ToComment() != nullptr) continue;
      if (child->ToText() == nullptr) return fault("holds more than numbers");
      if (!holds_numbers(child->Value(), whole)) return fault("does not hold numbers");
    }
  }
  for (const char* attribute : {"count", "stride", "offset"}) {
    const char* text = element.Attribute(attribute);
    if (text == nullptr) continue;
    const auto value = parse_integer(text);
    if (!value || *value < 0 || static_cast<std::size_t>(*value) > bytes)
      return fault("declares more elements than it has");
  }
  return {};
}

// How many nodes there are when each <instance_node> is replaced by what it shows.
class NodeCount {
 public:
  explicit NodeCount(const XMLElement& root) {
    for (const XMLElement* at = &root; at != nullptr; at = next_element(*at)) {
      if (std::string_view(at->Name()) != "node") continue;
      for (const char* attribute : {"id", "name", "sid"}) {
        if (const char* name = at->Attribute(attribute)) nodes_.emplace(name, at);
      }
    }
  }

  // Nothing good: more than there is room for, or a circle.
  [[nodiscard]] bool is_bounded(const XMLElement& root) { return count(root, 0) <= kMost; }

 private:
  static constexpr std::uint64_t kMost = 100'000;
  static constexpr int kDeepest = 1000;

  std::uint64_t count(const XMLElement& element, int depth) {
    if (depth > kDeepest) return kMost + 1;
    const auto [known, is_new] = counts_.emplace(&element, kMost + 1);  // where it is met again below itself: a circle
    if (!is_new) return known->second;
    std::uint64_t total = std::string_view(element.Name()) == "node" ? 1 : 0;
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr && total <= kMost;
         child = child->NextSiblingElement()) {
      total += count(*child, depth + 1);
      if (std::string_view(child->Name()) != "instance_node") continue;
      const char* url = child->Attribute("url");
      if (url == nullptr) continue;
      const auto [from, to] = nodes_.equal_range(std::string(*url == '#' ? url + 1 : url));
      for (auto at = from; at != to && total <= kMost; ++at) total += count(*at->second, depth + 1);
    }
    known->second = std::min(total, kMost + 1);
    return known->second;
  }

  std::multimap<std::string, const XMLElement*> nodes_;  // by each of their names
  std::map<const XMLElement*, std::uint64_t> counts_;
};

// Arrays, the accessors that say how they are read, and the meshes that name these by the <source> around them.
class Arrays {
 public:
  // Of those with one name the smallest: assimp takes the last.
  explicit Arrays(const XMLElement& root) {
    static constexpr std::array<std::string_view, 6> kArrays{"float_array", "int_array",   "bool_array",
                                                             "Name_array",  "IDREF_array", "SIDREF_array"};
    for (const XMLElement* at = &root; at != nullptr; at = next_element(*at)) {
      if (std::ranges::find(kArrays, at->Name()) == kArrays.end()) continue;
      const Array array{number_of(*at, "count", 0), std::string_view(at->Name()) == "float_array"};
      const auto [known, is_new] = arrays_.emplace("#" + text_of(*at, "id"), array);
      if (is_new) continue;
      known->second.count = std::min(known->second.count, array.count);
      known->second.has_numbers = known->second.has_numbers && array.has_numbers;
    }
  }

  [[nodiscard]] Result<void> check(const XMLElement& root) {
    for (const XMLElement* at = &root; at != nullptr; at = next_element(*at)) {
      if (std::string_view(at->Name()) != "accessor") continue;
      const auto array = arrays_.find(text_of(*at, "source"));
      if (array == arrays_.end() || reach_of(*at) > array->second.count)
        return std::unexpected(fault_at(*at, "reaches beyond its array"));
      for_each_around(*at, "source", [&](const XMLElement& source) {
        (array->second.has_numbers ? with_numbers_ : without_).insert("#" + text_of(source, "id"));
      });
    }
    for (const XMLElement* at = &root; at != nullptr; at = next_element(*at)) {
      if (std::string_view(at->Name()) != "input" || text_of(*at, "semantic") == "VERTEX") continue;
      bool in_mesh = false;
      for_each_around(*at, "mesh", [&](const XMLElement&) { in_mesh = true; });
      const std::string source = text_of(*at, "source");
      if (in_mesh && (!with_numbers_.contains(source) || without_.contains(source)))
        return std::unexpected(fault_at(*at, "refers to no numbers"));
    }
    return {};
  }

 private:
  struct Array {
    std::uint64_t count = 0;
    bool has_numbers = false;
  };

  static std::string text_of(const XMLElement& element, const char* attribute) {
    const char* text = element.Attribute(attribute);
    return text == nullptr ? "" : text;
  }

  // check_element() has refused what is no such number.
  static std::uint64_t number_of(const XMLElement& element, const char* attribute, std::uint64_t otherwise) {
    const char* text = element.Attribute(attribute);
    return text == nullptr ? otherwise : static_cast<std::uint64_t>(parse_integer(text).value_or(0));
  }

  template <class Use>
  static void for_each_around(const XMLElement& element, std::string_view name, Use use) {
    for (const tinyxml2::XMLNode* at = element.Parent(); at != nullptr; at = at->Parent()) {
      if (at->ToElement() != nullptr && name == at->Value()) use(*at->ToElement());
    }
  }

  static bool is_in(const XMLElement& element, const XMLElement& around) {
    for (const tinyxml2::XMLNode* at = element.Parent(); at != nullptr; at = at->Parent()) {
      if (at == &around) return true;
    }
    return false;
  }

  // How many values of its array an accessor needs.
  static std::uint64_t reach_of(const XMLElement& accessor) {
    const std::uint64_t count = number_of(accessor, "count", 0);
    if (count == 0) return 0;
    std::uint64_t size = 0;
    for (const XMLElement* at = next_element(accessor); at != nullptr && is_in(*at, accessor); at = next_element(*at)) {
      constexpr std::uint64_t kMatrix = 16;
      size += text_of(*at, "type") == "float4x4" ? kMatrix : 1;
    }
    return number_of(accessor, "offset", 0) + (count - 1) * number_of(accessor, "stride", 1) +
           std::max<std::uint64_t>(size, 1);
  }

  std::map<std::string, Array> arrays_;  // by "#ID"
  // What names such arrays, as "#ID".
  std::set<std::string> with_numbers_;
  std::set<std::string> without_;
};

}  // namespace

Result<void> check_dae(std::string_view bytes) {
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
    return fail(fmt::format("it is not XML: {}", printable(document.ErrorName())), "export it again");
  const XMLElement& root = *document.RootElement();
  for (const XMLElement* at = &root; at != nullptr; at = next_element(*at)) {
    if (auto checked = check_element(*at, bytes.size()); !checked) return checked;
  }
  if (!NodeCount(root).is_bounded(root))
    return fail("its nodes instantiate themselves, or are too many", "export it again");
  return Arrays(root).check(root);
}

}  // namespace cellmirror
