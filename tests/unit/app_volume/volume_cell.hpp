// A cell with voxel volumes, made in memory: a head on a table that a robot moves, a part, and a part that is loaded
// later from the same file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rt_core/cell/cell.hpp"

namespace cellmirror::app::test {

inline std::shared_ptr<VoxelGrid> small_grid() {
  auto grid = std::make_shared<VoxelGrid>();
  grid->size = {4, 3, 2};
  grid->spacing_m = {0.001, 0.002, 0.003};
  std::vector<std::int16_t> values(grid->count(), 24);
  values.front() = 0;
  values.back() = 128;
  grid->values = std::move(values);
  grid->intercept = -1024;
  grid->hounsfield = true;
  return grid;
}

class VolumeFiles final : public ComponentSource {
 public:
  VolumeFiles() {
    Component head;
    head.file = "head.mpc";
    head.volume.emplace();
    head.volume->grid = small_grid();
    head.volume->X_CV.translation() << 0, 0, 0.1;
    head.volume->settings.table = VolumeTable::exponential;
    head_ = std::make_shared<const Component>(std::move(head));
    Component part;
    part.file = "part.mpc";
    part.volume.emplace();
    part.volume->grid = small_grid();
    part_ = std::make_shared<const Component>(std::move(part));
    Component empty;
    empty.file = "empty.mpc";
    empty_ = std::make_shared<const Component>(std::move(empty));
  }
  Result<std::shared_ptr<const Component>> component(std::string_view file) override {
    return file == "head.mpc" ? head_ : file == "part.mpc" ? part_ : empty_;
  }

 private:
  std::shared_ptr<const Component> head_;
  std::shared_ptr<const Component> part_;
  std::shared_ptr<const Component> empty_;
};

inline ComponentNode node_named(std::string name, int parent, std::string abstract = {}, bool loaded = true) {
  ComponentNode node;
  node.name = std::move(name);
  node.parent = parent;
  if (!abstract.empty()) {
    node.abstract.emplace();
    node.abstract->file = std::move(abstract);
    node.abstract->loaded = loaded;
    if (!loaded) node.shown = Shown::hidden;
  }
  return node;
}

// Table, Table.Head (a volume), Part (a volume), Later (the volume of Part, not loaded yet), Box.
inline std::optional<Cell> volume_cell(bool with_volumes = true) {
  Component root;
  root.file = "cell.toml";
  root.nodes.push_back(node_named("Table", -1));
  root.nodes.push_back(node_named("Head", 0, with_volumes ? "head.mpc" : "empty.mpc"));
  root.nodes.push_back(node_named("Part", -1, with_volumes ? "part.mpc" : "empty.mpc"));
  root.nodes.push_back(node_named("Later", -1, with_volumes ? "part.mpc" : "empty.mpc", false));
  root.nodes.push_back(node_named("Box", -1));
  Diagnostics diagnostics;
  return Cell::build(std::make_shared<const Component>(std::move(root)), std::make_shared<VolumeFiles>(), diagnostics);
}

}  // namespace cellmirror::app::test
