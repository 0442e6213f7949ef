#include "rt_core/cell/short_names.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <unordered_map>

namespace cellmirror {

namespace {

constexpr std::size_t kLongest = 127;  // bytes: what a record has room for

using Names = std::vector<std::string_view>;

std::string_view last_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

// The names above the last one, in order.
Names above_last(std::string_view path) {
  Names names;
  for (std::size_t dot = path.find('.'); dot != std::string_view::npos; dot = path.find('.')) {
    names.push_back(path.substr(0, dot));
    path.remove_prefix(dot + 1);
  }
  return names;
}

// As NameIndex finds paths that skip levels: `wanted` stand in `names` in this order, with others between them.
bool has_in_order(const Names& names, const Names& wanted) {
  auto at = names.begin();
  return std::ranges::all_of(wanted, [&](std::string_view name) {
    at = std::find(at, names.end(), name);
    return at != names.end() && at++ != names.end();
  });
}

class Shortener {
 public:
  Shortener(std::span<const std::string> paths, std::span<const std::string> all) {
    for (const std::string& path : paths) alike_.try_emplace(last_of(path));
    for (const std::string& path : all) {
      const auto group = alike_.find(last_of(path));
      if (group != alike_.end()) add(group->second, above_last(path));
    }
  }

  [[nodiscard]] std::string shortened(const std::string& path) const {
    const Alike& alike = alike_.find(last_of(path))->second;
    const Names above = above_last(path);
    if (above.size() < 2) return path;
    if (alike.uses.at(above.front()) == 1) return joined({above.front()}, path);
    for (std::size_t i = 1; i < above.size(); ++i) {
      const Names two{above.front(), above[i]};
      if (alike.uses.at(above[i]) == 1) {
        std::string name = joined(two, path);
        return name.size() <= kLongest ? name : joined({above[i]}, path);
      }
    }
    for (std::size_t i = 1; i < above.size(); ++i) {
      const Names two{above.front(), above[i]};
      const auto fits = [&](const Names& names) { return has_in_order(names, two); };
      if (std::ranges::count_if(alike.above, fits) == 1) return joined(two, path);
    }
    return path;
  }

 private:
  // Paths that end in the same name.
  struct Alike {
    std::vector<Names> above;
    std::unordered_map<std::string_view, std::size_t> uses;  // how many of them have a name above the last
  };

  static void add(Alike& alike, Names above) {
    for (auto name = above.begin(); name != above.end(); ++name) {
      if (std::find(above.begin(), name, *name) == name) ++alike.uses[*name];
    }
    alike.above.push_back(std::move(above));
  }

  static std::string joined(const Names& above, const std::string& path) {
    std::string name;
    for (const std::string_view part : above) name.append(part).append(".");
    return name.append(last_of(path));
  }

  std::unordered_map<std::string_view, Alike> alike_;  // by the last name
};

}  // namespace

std::vector<std::string> short_names(std::span<const std::string> paths, std::span<const std::string> all) {
  const Shortener shortener(paths, all);
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const std::string& path : paths) names.push_back(shortener.shortened(path));
  return names;
}

const std::string& body_name(const CompiledCell& cell, std::int32_t node) {
  return node == 0 ? cell.name : (*cell.paths)[static_cast<std::size_t>(node)];
}

std::vector<std::string> short_body_names(const CompiledCell& cell, std::span<const std::int32_t> nodes) {
  std::vector<std::string> paths;
  paths.reserve(nodes.size());
  for (const std::int32_t node : nodes) paths.push_back((*cell.paths)[static_cast<std::size_t>(node)]);
  std::vector<std::string> names = short_names(paths, *cell.paths);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] == 0) names[i] = cell.name;
  }
  return names;
}

}  // namespace cellmirror
