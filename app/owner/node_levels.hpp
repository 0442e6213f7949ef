// At which level of detail each node of the cell is shown. Belongs to the thread that owns the cell.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/snapshot/node_level.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

class NodeLevels {
 public:
  // Created again only where the tree or what is visible of it has changed.
  [[nodiscard]] std::shared_ptr<const LevelList> of(const Cell& cell,
                                                    const std::shared_ptr<const CompiledCell>& compiled) {
    const bool same = compiled_ && (compiled_ == compiled ||
                                    (compiled_->paths == compiled->paths && compiled_->visible == compiled->visible));
    compiled_ = compiled;
    if (same) return levels_;
    auto levels = std::make_shared<LevelList>(compiled->size());
    for (std::size_t i = 1; i < compiled->size(); ++i) {
      const auto found = cell.find((*compiled->paths)[i]);
      if (!found) continue;
      const Node& node = cell.node(*found);
      (*levels)[i] = {node.has_abstract(), node.shown};
    }
    levels_ = std::move(levels);
    return levels_;
  }

 private:
  std::shared_ptr<const CompiledCell> compiled_;
  std::shared_ptr<const LevelList> levels_;
};

}  // namespace cellmirror::app
