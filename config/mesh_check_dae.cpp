// assimp 5.2.5 allocates what the counts of a DAE say, follows nodes that show themselves, and reads numbers from text
// that holds none, for ever.
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
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

Result<void> check_element(const XMLElement& element, std::size_t bytes) {
  static constexpr std::array<std::string_view, 4> kWhole{"p", "v", "vcount", "h"};
  static constexpr std::array<std::string_view, 8> kNumbers{"float_array", "int_array", "matrix", "translate",
                                                            "rotate",      "scale",     "lookat", "skew"};
  const std::string_view name = element.Name();
  const bool whole = std::ranges::find(kWhole, name) != kWhole.end();
  const auto fault = [&](const char* what) {
    return fail(fmt::format("<{}> in line {} {}", printable(name), element.GetLineNum(), what), "export it anew");
  };
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
    if (!value || *value < 0 || static_cast<std::size_t>(*value) > bytes) return fault("counts more than there is");
  }
  return {};
}

// How many nodes there are when each <instance_node> is replaced by what it shows.
class NodeCount {
 public:
  explicit NodeCount(const XMLElement& root) {
    for (const XMLElement* at = &root; at != nullptr; at = next(*at)) {
      if (std::string_view(at->Name()) != "node") continue;
      for (const char* attribute : {"id", "name", "sid"}) {
        if (const char* name = at->Attribute(attribute)) nodes_.emplace(name, at);
      }
    }
  }

  // Nothing good: more than there is room for, or a circle.
  [[nodiscard]] bool is_bounded(const XMLElement& root) { return count(root, 0) <= kMost; }

  // Depth first.
  static const XMLElement* next(const XMLElement& element) {
    if (const XMLElement* child = element.FirstChildElement()) return child;
    for (const XMLElement* at = &element; at != nullptr;) {
      if (const XMLElement* sibling = at->NextSiblingElement()) return sibling;
      const tinyxml2::XMLNode* parent = at->Parent();
      at = parent == nullptr ? nullptr : parent->ToElement();
    }
    return nullptr;
  }

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

}  // namespace

Result<void> check_dae(std::string_view bytes) {
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
    return fail(fmt::format("it is no XML: {}", printable(document.ErrorName())), "export it anew");
  const XMLElement& root = *document.RootElement();
  for (const XMLElement* at = &root; at != nullptr; at = NodeCount::next(*at)) {
    if (auto checked = check_element(*at, bytes.size()); !checked) return checked;
  }
  if (!NodeCount(root).is_bounded(root)) return fail("its nodes show themselves, or are too many", "export it anew");
  return {};
}

}  // namespace cellmirror
