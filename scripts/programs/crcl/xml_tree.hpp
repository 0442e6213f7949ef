// One element of an XML document with everything in it. A program of 100,000 commands is read command by command into
// the same tree, so that its nodes are allocated once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror::crcl {

inline constexpr std::uint32_t kNoNode = 0xFFFFFFFFU;

// Names are short and mostly differ at once: faster than the library's comparison.
[[nodiscard]] inline bool same_name(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) return false;
  }
  return true;
}

// Views of the document, or of what the tree has kept: valid until the tree is cleared.
struct XmlNode {
  std::string_view name;  // without a prefix
  std::string_view type;  // xsi:type without a prefix; empty if there is none
  std::string_view text;  // its direct text, trimmed
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t parent = kNoNode;
  std::uint32_t first_child = kNoNode;
  std::uint32_t last_child = kNoNode;
  std::uint32_t next = kNoNode;  // of the same parent
};

class XmlTree {
 public:
  // Building. What open() and close() are given is not copied: it has to live as long as the tree is read, as what
  // keep() returns does. The first element that is opened after clear() is the root.
  void clear();
  [[nodiscard]] std::string_view keep(std::string_view text) { return kept_.emplace_back(text); }
  void open(std::string_view name, std::string_view type, std::uint32_t line, std::uint32_t column);
  void close(std::string_view text);  // without the space around

  [[nodiscard]] std::size_t size() const { return used_; }
  [[nodiscard]] const XmlNode& root() const { return nodes_[0]; }
  [[nodiscard]] const XmlNode* first(const XmlNode& node) const { return at(node.first_child); }
  [[nodiscard]] const XmlNode* next(const XmlNode& node) const { return at(node.next); }
  // The first child of that name; null if there is none.
  [[nodiscard]] const XmlNode* child(const XmlNode& node, std::string_view name) const {
    for (const XmlNode* one = first(node); one != nullptr; one = next(*one)) {
      if (same_name(one->name, name)) return one;
    }
    return nullptr;
  }

 private:
  [[nodiscard]] const XmlNode* at(std::uint32_t index) const { return index == kNoNode ? nullptr : &nodes_[index]; }

  std::vector<XmlNode> nodes_;  // only grows; the first used_ count
  std::size_t used_ = 0;
  std::uint32_t open_ = kNoNode;
  std::deque<std::string> kept_;
};

// "xsi:type" is "type".
[[nodiscard]] inline std::string_view without_prefix(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

}  // namespace cellmirror::crcl
