// A loaded cell whose robots all move along smooth paths within their ranges and velocities; the same seed, the same
// paths. For the stress test and the benchmark.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/cell/cell.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror {

// <source>/config/cells/transfer_cell/cell.toml.
[[nodiscard]] std::filesystem::path transfer_cell_file();

class MovingCell {
 public:
  // Throws where the cell cannot be loaded.
  // `share`: how much of the ranges the paths cover, about their middle.
  explicit MovingCell(const std::filesystem::path& cell_file, unsigned seed = 1, double share = 1.0);

  // Every triangle of every colliding mesh becomes n * n, in the same surface.
  void subdivide(unsigned n);

  [[nodiscard]] const std::shared_ptr<const CompiledCell>& compiled() const { return compiled_; }
  // Poses of all nodes at a time, s. Valid until the next call.
  const CellPoses& at(double seconds);
  // At random within the ranges of the joints.
  const CellPoses& anywhere(std::uint64_t number);
  [[nodiscard]] const std::vector<JointValues>& positions() const { return q_; }

 private:
  struct Swing {
    std::size_t slot = 0;
    std::size_t joint = 0;
    double lower = 0;
    double upper = 0;
    double speed = 0;  // rad/s of the phase
    double phase = 0;
  };

  std::shared_ptr<const CompiledCell> compiled_;
  std::vector<Swing> swings_;
  std::vector<JointValues> q_;
  CellPoses poses_;
};

// A folder with a cell.toml that holds nothing but one robot of ../shared/data/robots, removed with the object.
class SharedRobotCell {
 public:
  explicit SharedRobotCell(const std::string& id);
  ~SharedRobotCell();
  SharedRobotCell(const SharedRobotCell&) = delete;
  SharedRobotCell& operator=(const SharedRobotCell&) = delete;

  // Empty where the data is not on this machine.
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
};

}  // namespace cellmirror
