// Reads the nodes and geometry that cell files and component files have in common. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/file_finder.hpp"
#include "config/table_reader.hpp"
#include "rt_core/cell/component.hpp"

namespace cellmirror {

inline constexpr std::size_t kMostGeometry = 1000;  // of one node

// collide_as = "exact", "hull" or "parts"
[[nodiscard]] std::optional<CollideAs> read_collide_as(TableReader& reader);
[[nodiscard]] std::vector<Geometry> read_geometry(TableReader& reader, const FileFinder& files);
// body = { mass_kg, center_m, inertia_kg_m2 = [xx, yy, zz, xy, xz, yz] }
[[nodiscard]] BodyInertia read_body(TableReader& reader);
// joint = { type, axis, range_rad | range_m, ... }
[[nodiscard]] JointDefinition read_joint(TableReader& reader);

// Reads [[node]] tables into a component.
class NodeReader {
 public:
  // `is_cell`: nodes may have the key predecessor.
  NodeReader(Component& component, const FileFinder& files, bool is_cell)
      : component_(component), files_(files), is_cell_(is_cell) {}

  void read(TableReader& reader);
  // What can be said only when all nodes are known.
  void finish(Diagnostics& diagnostics) const;

  // The node with that name, or dotted end of its path; -1: none or several, with an error at `key`.
  [[nodiscard]] int find(const TableReader& reader, std::string_view key, std::string_view path) const;
  [[nodiscard]] std::string path(int node) const;

 private:
  void read_kind(TableReader& reader, ComponentNode& node) const;
  void read_abstract(TableReader& reader, ComponentNode& node) const;
  void check_coarse(const ComponentNode& node, const Place& place, Diagnostics& diagnostics) const;

  Component& component_;
  const FileFinder& files_;
  bool is_cell_;
  std::unordered_map<std::string, std::vector<int>> by_name_;
};

}  // namespace cellmirror
