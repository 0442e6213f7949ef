#include "app/owner/volume/volume_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kListedVolumes = 8;  // names in a message

// The last part of a path is often all that is written of it.
std::vector<std::string> with_bare_names(std::vector<std::string> names) {
  for (std::size_t i = 0, count = names.size(); i < count; ++i) {
    if (const std::size_t dot = names[i].rfind('.'); dot != std::string::npos)
      names.push_back(names[i].substr(dot + 1));
  }
  return names;
}

}  // namespace

std::vector<std::string> volume_names(const Cell& cell) {
  const auto compiled = cell.compile();
  std::vector<std::string> names;
  for (const CompiledVolume& volume : compiled->volumes)
    names.push_back(compiled->paths->at(static_cast<std::size_t>(volume.node)));
  return names;
}

Error no_volumes() {
  return {"the cell has no voxel volume", "a component file with [volume] brings one; docs/volumes.md shows how"};
}

Result<std::string> find_volume(const Cell& cell, std::string_view name) {
  std::vector<std::string> names = volume_names(cell);
  if (names.empty()) return std::unexpected(no_volumes());
  const Result<NodeId> node = cell.find(name);
  if (node) {
    std::string path = cell.path(*node);
    if (std::ranges::find(names, path) != names.end()) return path;
  }
  std::string remedy = did_you_mean(name, with_bare_names(names));
  if (remedy.empty()) {
    const std::size_t more = names.size() > kListedVolumes ? names.size() - kListedVolumes : 0;
    names.resize(names.size() - more);
    remedy =
        fmt::format("the cell has {}{}", fmt::join(names, ", "), more == 0 ? "" : fmt::format(" and {} more", more));
  }
  return fail(node ? fmt::format("{} has no voxel volume", printable(name))
                   : fmt::format("there is no voxel volume {}", printable(name)),
              std::move(remedy));
}

}  // namespace cellmirror::app
