#include "rt_core/scene/volumes.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace cellmirror::scene {

namespace {

// The states are nearly always in the order of the cell's volumes.
const VolumeState* state_of(const std::string& name, std::size_t expected, const VolumeStates& states) {
  if (expected < states.size() && states[expected].name == name) return &states[expected];
  const auto found = std::ranges::find(states, name, &VolumeState::name);
  return found == states.end() ? nullptr : &*found;
}

}  // namespace

void place_volumes(const SceneInput& input, Scene& scene) {
  scene.volumes.clear();
  const CompiledCell& cell = *input.cell;
  for (std::size_t i = 0; i < cell.volumes.size(); ++i) {
    const CompiledVolume& placed = cell.volumes[i];
    const auto node = static_cast<std::size_t>(placed.node);
    if (cell.visible[node] == 0) continue;
    SceneVolume volume;
    volume.object = static_cast<std::uint32_t>(node) + 1;
    volume.grid = placed.volume->grid;
    volume.X_WV = input.poses->X_WN[node] * placed.volume->X_CV;
    volume.settings = placed.volume->settings;
    const VolumeState* state = input.volumes == nullptr ? nullptr : state_of(cell.paths->at(node), i, *input.volumes);
    if (state != nullptr) {
      volume.settings = state->settings;
      volume.user_tables = state->user_tables;
      volume.tables_revision = state->tables_revision;
    }
    scene.volumes.push_back(std::move(volume));
  }
}

}  // namespace cellmirror::scene
