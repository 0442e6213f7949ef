// Bodies that are near each other or touch: coloured, joined by their nearest points, with the distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/bodies.hpp"

namespace cellmirror::scene {

class PairMarks {
 public:
  static constexpr std::size_t kPairs = 200;          // that are drawn, of each kind
  static constexpr std::size_t kLabels = 12;          // of each kind; the nearest ones
  static constexpr double kOldAfter = 0.5;            // s: older results show their age
  static constexpr double kContactHalfLength = 0.02;  // m: a contact is drawn as long as this to both sides at least

  void update(const CompiledCell& cell);
  // Touching wins over near, both over ghost. Near are the pairs within the warning distance.
  void draw(const ProximityState& proximity, Timestamp now, const Bodies& bodies, Scene& scene);

 private:
  void find_nodes(const BodyNames& names);
  void mark(std::uint32_t body, Mark mark);
  void draw_near(const ProximityState& proximity, std::string_view age, Scene& scene);
  void draw_touching(const ProximityState& proximity, std::string_view age, Scene& scene);

  std::shared_ptr<const std::vector<std::string>> paths_;
  std::string cell_name_;  // name of the cell's own geometry in results
  std::size_t node_count_ = 0;
  std::unordered_map<std::string_view, std::int32_t> node_of_path_;  // into *paths_
  BodyNames names_;
  std::vector<std::int32_t> node_of_body_;
  std::vector<Mark> mark_of_node_;
};

}  // namespace cellmirror::scene
