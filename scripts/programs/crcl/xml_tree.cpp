#include "scripts/programs/crcl/xml_tree.hpp"

#include "rt_core/base/contract.hpp"

namespace cellmirror::crcl {

void XmlTree::clear() {
  used_ = 0;
  open_ = kNoNode;
  if (!kept_.empty()) kept_.clear();
}

void XmlTree::open(std::string_view name, std::string_view type, std::uint32_t line, std::uint32_t column) {
  if (used_ == nodes_.size()) nodes_.emplace_back();
  const auto index = static_cast<std::uint32_t>(used_++);
  const std::uint32_t parent = open_;
  nodes_[index] = {.name = name, .type = type, .text = {}, .line = line, .column = column, .parent = parent};
  if (parent != kNoNode) {
    XmlNode& above = nodes_[parent];
    (above.first_child == kNoNode ? above.first_child : nodes_[above.last_child].next) = index;
    above.last_child = index;
  }
  open_ = index;
}

void XmlTree::close(std::string_view text) {
  CELLMIRROR_EXPECTS(open_ != kNoNode);
  XmlNode& node = nodes_[open_];
  node.text = text;
  open_ = node.parent;
}

}  // namespace cellmirror::crcl
