#include "rt_core/cell/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kLongestPath = 1024;
// Messages request paths too; the cache stays bounded for any input.
constexpr std::size_t kRemembered = 65'536;

std::size_t index_of(NodeId node) { return static_cast<std::size_t>(node); }

// Takes the last name off a dotted path.
std::string_view take_last(std::string_view& path) {
  const std::size_t dot = path.rfind('.');
  const std::string_view last = dot == std::string_view::npos ? path : path.substr(dot + 1);
  path = dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
  return last;
}

const char* word(PathKind kind) {
  switch (kind) {
    case PathKind::any:
      return "frame, joint or workframe";
    case PathKind::workframe:
      return "workframe";
    case PathKind::camera:
      return "camera";
    case PathKind::sensor:
      return "sensor";
  }
  return "node";
}

const char* word(NodeKind kind) {
  switch (kind) {
    case NodeKind::frame:
      return "frame";
    case NodeKind::joint:
      return "joint";
    case NodeKind::workframe:
      return "workframe";
    case NodeKind::camera:
      return "camera";
    case NodeKind::sensor:
      return "sensor";
  }
  return "node";
}

}  // namespace

void NameIndex::add(NodeId node, NodeId parent, std::string_view name, NodeKind kind) {
  if (index_of(node) >= entries_.size()) entries_.resize(index_of(node) + 1);
  CELLMIRROR_EXPECTS(!entries_[index_of(node)].used);
  entries_[index_of(node)] = {parent, std::string(name), kind, true};
  const auto at = by_name_.find(name);
  if (at == by_name_.end()) {
    by_name_.emplace(std::string(name), std::vector<NodeId>{node});
  } else {
    at->second.push_back(node);
  }
  forget();
}

void NameIndex::remove(NodeId node) {
  CELLMIRROR_EXPECTS(index_of(node) < entries_.size() && entries_[index_of(node)].used);
  const auto at = by_name_.find(entries_[index_of(node)].name);
  std::erase(at->second, node);
  if (at->second.empty()) by_name_.erase(at);
  entries_[index_of(node)] = {};
  forget();
}

void NameIndex::forget() {
  for (auto& found : found_) found.clear();
}

bool NameIndex::matches(NodeId node, PathKind kind) const {
  const NodeKind is = entry(node).kind;
  switch (kind) {
    case PathKind::any:
      return true;
    case PathKind::workframe:
      return is == NodeKind::workframe;
    case PathKind::camera:
      return is == NodeKind::camera;
    case PathKind::sensor:
      return is == NodeKind::sensor;
  }
  return false;
}

std::vector<NodeId> NameIndex::candidates(std::string_view path, PathKind kind) const {
  std::vector<NodeId> found;
  if (path.empty() || path.front() == '.' || path.size() > kLongestPath) return found;
  std::string_view above = path;
  const auto at = by_name_.find(take_last(above));
  if (at == by_name_.end()) return found;
  for (const NodeId node : at->second) {
    if (!matches(node, kind)) continue;
    std::string_view rest = above;
    bool no_level_skipped = true;
    std::string_view wanted = rest.empty() ? std::string_view() : take_last(rest);
    NodeId ancestor = entry(node).parent;
    for (; ancestor != kNoNode && ancestor != kRootNode && !wanted.empty(); ancestor = entry(ancestor).parent) {
      if (entry(ancestor).name == wanted) {
        wanted = rest.empty() ? std::string_view() : take_last(rest);
      } else {
        no_level_skipped = false;
      }
    }
    if (!wanted.empty() || !rest.empty()) continue;
    if (no_level_skipped && ancestor == kRootNode) return {node};
    found.push_back(node);
  }
  return found;
}

NodeId NameIndex::search(std::string_view path, PathKind kind) const {
  const std::vector<NodeId> found = candidates(path, kind);
  return found.size() == 1 ? found.front() : kNoNode;
}

NodeId NameIndex::find(std::string_view path, PathKind kind) const {
  auto& remembered = found_[static_cast<std::size_t>(kind)];
  if (const auto at = remembered.find(path); at != remembered.end()) return at->second;
  const NodeId node = search(path, kind);
  if (node == kNoNode) return node;
  if (remembered.size() >= kRemembered) remembered.clear();
  remembered.emplace(std::string(path), node);
  return node;
}

Error NameIndex::explain(std::string_view path, PathKind kind) const {
  const std::string shown = printable(path);
  if (path.empty()) return {fmt::format("the name of a {} is empty", word(kind)), {}};
  const std::vector<NodeId> several = candidates(path, kind);
  if (several.size() > 1) {
    constexpr std::size_t kNamed = 5;
    std::string names;
    for (std::size_t i = 0; i < std::min(several.size(), kNamed); ++i) {
      names += (i == 0 ? "" : ", ") + this->path(several[i]);
    }
    if (several.size() > kNamed) names += fmt::format(" and {} more", several.size() - kNamed);
    return {fmt::format("{} is ambiguous: {} nodes match", shown, several.size()), "name one of " + names};
  }
  if (kind != PathKind::any) {
    const std::vector<NodeId> others = candidates(path, PathKind::any);
    if (others.size() == 1)
      return {fmt::format("{} is a {}, not a {}", shown, word(entry(others.front()).kind), word(kind)), {}};
  }
  // Nearest paths: the full paths of nodes whose own name is near the last name of the path.
  std::string_view above = path;
  const std::string_view last = take_last(above);
  std::vector<std::string> names;
  for (const auto& [name, nodes] : by_name_) {
    if (std::ranges::any_of(nodes, [&](NodeId node) { return matches(node, kind); })) names.push_back(name);
  }
  std::ranges::sort(names);
  std::vector<std::string> near;
  for (const std::string& name : nearest(last, names)) {
    for (const NodeId node : by_name_.find(name)->second) {
      if (matches(node, kind) && near.size() < 8) near.push_back(this->path(node));
    }
  }
  constexpr std::size_t kTold = 3;
  std::vector<std::string> best = nearest(path, near, kTold);
  for (const std::string& other : near) {
    if (best.size() < kTold && std::ranges::find(best, other) == best.end()) best.push_back(other);
  }
  std::string remedy;
  for (std::size_t i = 0; i < best.size(); ++i) {
    remedy += (i == 0 ? "did you mean " : (i + 1 == best.size() ? " or " : ", ")) + best[i];
  }
  if (!remedy.empty()) remedy += "?";
  return {fmt::format("there is no {} {}", word(kind), shown), remedy};
}

std::string NameIndex::path(NodeId node) const {
  std::vector<std::string_view> names;
  for (NodeId at = node; at != kNoNode && at != kRootNode; at = entry(at).parent) names.push_back(entry(at).name);
  std::string out;
  for (auto name = names.rbegin(); name != names.rend(); ++name) {
    if (!out.empty()) out += '.';
    out += *name;
  }
  return out;
}

std::vector<std::string> NameIndex::paths(PathKind kind) const {
  std::vector<std::string> all;
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    const auto node = static_cast<NodeId>(i);
    if (entries_[i].used && matches(node, kind)) all.push_back(path(node));
  }
  std::ranges::sort(all);
  return all;
}

NodeId NameIndex::child(NodeId parent, std::string_view name) const {
  const auto at = by_name_.find(name);
  if (at == by_name_.end()) return kNoNode;
  for (const NodeId node : at->second) {
    if (entry(node).parent == parent) return node;
  }
  return kNoNode;
}

}  // namespace cellmirror
