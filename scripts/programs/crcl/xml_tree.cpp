#include "scripts/programs/crcl/xml_tree.hpp"

#include "rt_core/base/text.hpp"

namespace cellmirror::crcl {

void XmlTree::open(std::string_view name, std::string_view type, std::uint32_t line, std::uint32_t column) {
  if (used_ == nodes_.size()) nodes_.emplace_back();
  const auto index = static_cast<std::uint32_t>(used_++);
  const std::uint32_t parent = index == 0 ? kNoNode : open_;
  XmlNode& node = nodes_[index];
  node.name = name;
  node.type = type;
  node.text.clear();
  node.line = line;
  node.column = column;
  node.parent = parent;
  node.first_child = kNoNode;
  node.last_child = kNoNode;
  node.next = kNoNode;
  if (parent != kNoNode) {
    XmlNode& above = nodes_[parent];
    (above.first_child == kNoNode ? above.first_child : nodes_[above.last_child].next) = index;
    above.last_child = index;
  }
  open_ = index;
}

void XmlTree::add_text(std::string_view text) {
  if (open_ != kNoNode) nodes_[open_].text += text;
}

void XmlTree::close() {
  if (open_ == kNoNode) return;
  XmlNode& node = nodes_[open_];
  const std::string_view text = trimmed(node.text);
  if (text.size() != node.text.size()) node.text = std::string(text);
  open_ = node.parent;
}

const XmlNode* XmlTree::child(const XmlNode& node, std::string_view name) const {
  for (const XmlNode* one = first(node); one != nullptr; one = next(*one)) {
    if (one->name == name) return one;
  }
  return nullptr;
}

}  // namespace cellmirror::crcl
