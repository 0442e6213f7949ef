// Finds nodes by dotted path. A path may skip levels of the tree as long as exactly one node matches; a full path takes
// precedence over shortened ones. Found paths are cached, so a repeated query costs one hash look-up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/cell/robot_model.hpp"

namespace cellmirror {

struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
};
template <class Value>
using TextMap = std::unordered_map<std::string, Value, TextHash, std::equal_to<>>;

// What a path is to name. Any kind of node is a frame_node of SCRIPT.
enum class PathKind : std::uint8_t { any, workframe, camera, sensor };
inline constexpr std::size_t kPathKinds = 4;

class NameIndex {
 public:
  void add(NodeId node, NodeId parent, std::string_view name, NodeKind kind);
  void remove(NodeId node);

  // kNoNode: unknown or ambiguous.
  [[nodiscard]] NodeId find(std::string_view path, PathKind kind) const;
  // Why find() gave nothing: the candidates of an ambiguous path, or the nearest names. Not fast.
  [[nodiscard]] Error explain(std::string_view path, PathKind kind) const;
  [[nodiscard]] std::string path(NodeId node) const;
  [[nodiscard]] std::vector<std::string> paths(PathKind kind) const;
  // The child of `parent` with that name, or kNoNode.
  [[nodiscard]] NodeId child(NodeId parent, std::string_view name) const;

 private:
  struct Entry {
    NodeId parent = kNoNode;
    std::string name;
    NodeKind kind = NodeKind::frame;
    bool used = false;
  };
  [[nodiscard]] bool matches(NodeId node, PathKind kind) const;
  [[nodiscard]] std::vector<NodeId> candidates(std::string_view path, PathKind kind) const;
  [[nodiscard]] NodeId search(std::string_view path, PathKind kind) const;
  [[nodiscard]] const Entry& entry(NodeId node) const { return entries_[static_cast<std::size_t>(node)]; }
  void forget();

  std::vector<Entry> entries_;
  TextMap<std::vector<NodeId>> by_name_;
  mutable std::array<TextMap<NodeId>, kPathKinds> found_;
};

}  // namespace cellmirror
