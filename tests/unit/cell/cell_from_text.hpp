// Makes cells from texts in memory.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "config/parse.hpp"
#include "rt_core/cell/cell.hpp"

namespace cellmirror {

// Component files by name. Counts how often each was asked for.
class TextFiles final : public ComponentSource {
 public:
  void add(const std::string& name, std::string text) { texts_[name] = "format = 1\n" + std::move(text); }
  void remove(const std::string& name) { texts_.erase(name); }

  Result<std::shared_ptr<const Component>> component(std::string_view file) override {
    const auto text = texts_.find(std::string(file));
    if (text == texts_.end()) return fail("the file " + std::string(file) + " does not exist");
    ++asked[text->first];
    Diagnostics diagnostics;
    auto component = parse_component(text->second, text->first, AnyFile(), diagnostics);
    if (!component || !diagnostics.ok()) return fail(diagnostics.text());
    return std::make_shared<const Component>(std::move(*component));
  }

  std::map<std::string, int> asked;

 private:
  std::map<std::string, std::string> texts_;
};

// The text of a cell file's nodes. Its nodes are read like those of a component; the predecessor is set afterwards.
inline std::optional<Cell> build_cell(const std::string& nodes, std::shared_ptr<TextFiles> files,
                                      Diagnostics& diagnostics,
                                      const std::map<std::string, std::string>& predecessors = {}) {
  auto root = parse_component("format = 1\n" + nodes, "cell.toml", AnyFile(), diagnostics);
  if (!root) return std::nullopt;
  for (ComponentNode& node : root->nodes) {
    const auto predecessor = predecessors.find(node.name);
    if (predecessor != predecessors.end()) node.predecessor = predecessor->second;
  }
  return Cell::build(std::make_shared<const Component>(std::move(*root)), std::move(files), diagnostics);
}

// Three axes: up along z, about z, about y, each 1 m after the other; the flange TIP 1 m beyond the last.
inline constexpr const char* kArm = R"(
[[node]]
name = "LIFT"
joint = { type = "prismatic", axis = [0, 0, 1], range_m = [0.0, 2.0], velocity_m_s = 1.5, acceleration_m_s2 = 3.0 }
[[node]]
name = "TURN"
parent = "LIFT"
xyz_m = [1.0, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3.0, 3.0], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "BEND"
parent = "TURN"
xyz_m = [1.0, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 1, 0], range_rad = [-2.0, 1.0], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "TIP"
parent = "BEND"
xyz_m = [1.0, 0.0, 0.0]
[robot]
id = "ARM"
flange = "TIP"
)";

}  // namespace cellmirror
