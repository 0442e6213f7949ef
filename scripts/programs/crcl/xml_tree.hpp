// One element of an XML document with everything in it. A program of 100,000 commands is read command by command into
// the same tree, so that its nodes are allocated once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror::crcl {

inline constexpr std::uint32_t kNoNode = 0xFFFFFFFFU;

struct XmlNode {
  std::string name;  // without a prefix
  std::string type;  // xsi:type without a prefix; empty where there is none
  std::string text;  // what stands directly in it, without the space around
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t parent = kNoNode;
  std::uint32_t first_child = kNoNode;
  std::uint32_t last_child = kNoNode;
  std::uint32_t next = kNoNode;  // of the same parent
};

class XmlTree {
 public:
  // Building: begin() forgets everything and opens the root.
  void clear() { used_ = 0; }
  void open(std::string_view name, std::string_view type, std::uint32_t line, std::uint32_t column);
  void add_text(std::string_view text);
  void close();

  [[nodiscard]] bool complete() const { return used_ > 0 && open_ == kNoNode; }
  [[nodiscard]] std::size_t size() const { return used_; }
  [[nodiscard]] const XmlNode& root() const { return nodes_[0]; }
  [[nodiscard]] const XmlNode* first(const XmlNode& node) const { return at(node.first_child); }
  [[nodiscard]] const XmlNode* next(const XmlNode& node) const { return at(node.next); }
  // The first child of that name; null where there is none.
  [[nodiscard]] const XmlNode* child(const XmlNode& node, std::string_view name) const;
  [[nodiscard]] std::size_t text_of_open_node() const { return open_ == kNoNode ? 0 : nodes_[open_].text.size(); }

 private:
  [[nodiscard]] const XmlNode* at(std::uint32_t index) const { return index == kNoNode ? nullptr : &nodes_[index]; }

  std::vector<XmlNode> nodes_;  // only grows; the first used_ count
  std::size_t used_ = 0;
  std::uint32_t open_ = kNoNode;
};

}  // namespace cellmirror::crcl
