// Bodies that are near each other or touch: coloured, joined by their nearest points, with the distance. Of a node with
// several geometries only those are coloured that are there: a robot on the floor does not colour the wall.
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
  static constexpr double kSameDistance = 0.001;      // m: geometries as near to a point as this all count

  // After Bodies::update(), where that was true.
  void update(const CompiledCell& cell, const Bodies& bodies);
  // Touching wins over near, both over ghost. Near are the pairs within the warning distance.
  void draw(const ProximityState& proximity, Timestamp now, const Bodies& bodies, Scene& scene);

 private:
  // Of what is drawn: a run of the scene's bodies.
  struct Run {
    std::size_t first = 0;
    std::size_t count = 0;
  };

  void find_nodes(const BodyNames& names);
  // Marks the geometries of the body (of the results) that are nearest to the point, by their boxes.
  void mark(std::uint32_t body, const Eigen::Vector3d& point_m, Mark mark, const Bodies& bodies, Scene& scene) const;
  void mark_touching(const TouchingPair& pair, const Bodies& bodies, Scene& scene) const;
  void draw_near(const ProximityState& proximity, std::string_view age, const Bodies& bodies, Scene& scene) const;
  void draw_touching(const ProximityState& proximity, std::string_view age, const Bodies& bodies, Scene& scene) const;

  std::shared_ptr<const std::vector<std::string>> paths_;
  std::string cell_name_;                                            // name of the cell's own geometry in results
  std::unordered_map<std::string_view, std::int32_t> node_of_path_;  // into *paths_
  BodyNames names_;
  std::vector<std::int32_t> node_of_body_;
  std::vector<Run> drawn_of_node_;
};

}  // namespace cellmirror::scene
