// The component files of a cell: finds, reads and shares them. Private to this folder but for its type.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/file_finder.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

struct RobotFacts {
  std::vector<std::string> joint_names;
  std::vector<JointKind> joint_kinds;
  std::vector<KnownLimits> joint_limits;
  std::vector<double> joint_starts;  // rad or m
};
// Robots by id.
using RobotDirectory = std::map<std::string, RobotFacts, std::less<>>;

class ComponentFiles final : public ComponentSource {
 public:
  explicit ComponentFiles(HomeFiles files) : files_(std::move(files)) {}

  // After load(): from memory while in use, else read again.
  Result<std::shared_ptr<const Component>> component(std::string_view file) override;
  Result<std::shared_ptr<const Component>> component_for(const AbstractReference& reference) override;

  // Reads every file that `root` names, directly or through others, and reports all errors; also of those that are not
  // loaded at the start. Between load() and release() everything stays in memory, faulty files as far as understood.
  void load(const Component& root, Diagnostics& diagnostics);
  void release();
  // The robots that are there at the start.
  [[nodiscard]] const RobotDirectory& robots() const { return robots_; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

 private:
  struct Entry {
    std::weak_ptr<const Component> used;
    std::shared_ptr<const Component> held;  // while loading
  };
  // A file is another component for each way in which its meshes are to collide.
  using Key = std::pair<std::string, std::optional<CollideAs>>;  // canonical path

  [[nodiscard]] std::shared_ptr<const Component> read(const std::filesystem::path& path,
                                                      std::optional<CollideAs> collide_as,
                                                      Diagnostics& diagnostics) const;
  void visit(const Component& component, bool loaded, std::size_t depth, Diagnostics& diagnostics);
  void visit_node(const Component& component, const ComponentNode& node, bool loaded, std::size_t depth,
                  Diagnostics& diagnostics);
  void note_robot(const Component& component, const AbstractReference& reference);

  HomeFiles files_;
  std::map<Key, Entry> entries_;
  std::map<std::string, bool> faulty_references_;
  RobotDirectory robots_;
  std::size_t visits_ = 0;
};

// Reads a component or URDF by its extension. The valid part, even with errors.
[[nodiscard]] std::shared_ptr<const Component> read_component_file(const std::filesystem::path& path,
                                                                   const FileFinder& files, Diagnostics& diagnostics);

}  // namespace cellmirror
