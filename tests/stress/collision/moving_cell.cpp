#include "tests/stress/collision/moving_cell.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "config/cell_file.hpp"

namespace cellmirror {

namespace {

namespace fs = std::filesystem;

fs::path source_folder() {
  if (const char* folder = std::getenv("CELLMIRROR_SOURCE_DIR")) return folder;
  return fs::path(__FILE__).parent_path().parent_path().parent_path().parent_path();
}

fs::path shared_data() {
  if (const char* folder = std::getenv("CELLMIRROR_SHARED_DATA")) return folder;
  return source_folder() / ".." / "shared" / "data";
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1.0p-53; }

using geometry::TriangleMesh;

// n * n triangles for each, on shared vertices.
std::shared_ptr<const TriangleMesh> subdivided(const TriangleMesh& mesh, unsigned n) {
  TriangleMesh fine;
  fine.name = mesh.name;
  fine.closed = mesh.closed;
  fine.convex = mesh.convex;
  std::map<std::array<double, 3>, std::uint32_t> known;
  // Points of an edge are computed from its lower corner on, whichever triangle asks.
  const auto vertex = [&](const geometry::TriangleIndices& t, unsigned i, unsigned k) {
    std::array<std::pair<std::uint32_t, unsigned>, 3> weights{{{t[0], n - i - k}, {t[1], i}, {t[2], k}}};
    std::ranges::sort(weights);
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (const auto& [corner, weight] : weights) p += static_cast<double>(weight) * mesh.vertices[corner];
    p /= static_cast<double>(n);
    const auto [place, is_new] =
        known.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(p);
    return place->second;
  };
  for (const auto& t : mesh.triangles) {
    for (unsigned i = 0; i < n; ++i) {
      for (unsigned k = 0; i + k < n; ++k) {
        fine.triangles.push_back({vertex(t, i, k), vertex(t, i + 1, k), vertex(t, i, k + 1)});
        if (i + k + 1 < n)
          fine.triangles.push_back({vertex(t, i + 1, k), vertex(t, i + 1, k + 1), vertex(t, i, k + 1)});
      }
    }
  }
  return std::make_shared<const TriangleMesh>(std::move(fine));
}

}  // namespace

fs::path transfer_cell_file() { return source_folder() / "config/cells/transfer_cell/cell.toml"; }

MovingCell::MovingCell(const fs::path& cell_file, unsigned seed, double share) {
  Diagnostics diagnostics;
  auto loaded = load_cell(cell_file, diagnostics);
  if (!loaded) throw std::runtime_error(diagnostics.text());
  compiled_ = loaded->cell.compile();
  q_ = loaded->cell.start_positions();
  std::mt19937_64 random(seed);
  for (const CompiledRobot& robot : compiled_->robots) {
    const RobotModel* model = loaded->cell.robot(robot.slot);
    for (std::size_t joint = 0; joint < robot.joint_names.size(); ++joint) {
      Swing swing;
      swing.slot = robot.slot;
      swing.joint = joint;
      swing.lower = std::max(robot.min_range[joint], -std::numbers::pi);
      swing.upper =
          std::min(robot.max_range[joint],
                   robot.joint_kinds[joint] == JointKind::prismatic ? robot.max_range[joint] : std::numbers::pi);
      if (robot.joint_kinds[joint] == JointKind::prismatic) swing.lower = robot.min_range[joint];
      const double middle = 0.5 * (swing.lower + swing.upper);
      const double half = 0.5 * share * (swing.upper - swing.lower);
      swing.lower = middle - half;
      swing.upper = middle + half;
      // 30 to 90 % of the greatest velocity at the middle of the swing.
      const double hurry = 0.3 + 0.6 * uniform(random);
      swing.speed = half > 0 ? hurry * model->parameters().max_velocity[joint] / half : 0.0;
      swing.phase = 2.0 * std::numbers::pi * uniform(random);
      swings_.push_back(swing);
    }
  }
}

void MovingCell::subdivide(unsigned n) {
  auto finer = std::make_shared<CompiledCell>(*compiled_);
  ++finer->revision;
  std::map<const TriangleMesh*, std::shared_ptr<const TriangleMesh>> done;
  const auto fine = [&](const std::shared_ptr<const TriangleMesh>& mesh) {
    auto& known = done[mesh.get()];
    if (!known) known = subdivided(*mesh, n);
    return known;
  };
  for (CompiledGeometry& item : finer->geometry) {
    if (item.geometry->shape != Shape::mesh || !item.geometry->mesh) continue;
    auto geometry = std::make_shared<Geometry>(*item.geometry);
    geometry->mesh = fine(geometry->mesh);
    for (auto& piece : geometry->pieces) piece = fine(piece);
    item.geometry = std::move(geometry);
  }
  compiled_ = std::move(finer);
}

const CellPoses& MovingCell::at(double seconds) {
  for (const Swing& swing : swings_) {
    const double along = 0.5 + 0.5 * std::sin(swing.speed * seconds + swing.phase);
    q_[swing.slot][swing.joint] = swing.lower + along * (swing.upper - swing.lower);
  }
  compute_poses(*compiled_, q_, poses_);
  return poses_;
}

const CellPoses& MovingCell::anywhere(std::uint64_t number) {
  std::mt19937_64 random(number);
  for (const Swing& swing : swings_)
    q_[swing.slot][swing.joint] = swing.lower + uniform(random) * (swing.upper - swing.lower);
  compute_poses(*compiled_, q_, poses_);
  return poses_;
}

SharedRobotCell::SharedRobotCell(const std::string& id) {
  const fs::path robot = shared_data() / "robots" / id;
  if (!fs::exists(robot)) return;
  folder_ = fs::temp_directory_path() / ("cellmirror_robot_" + std::to_string(getpid()) + "_" + id);
  fs::create_directories(folder_ / "robots");
  fs::copy(robot, folder_ / "robots" / id, fs::copy_options::recursive);
  file_ = folder_ / "cell.toml";
  std::ofstream(file_) << "format = 1\nname = \"" << id << "\"\n[[node]]\nname = \"Robot\"\nabstract = \"" << id << '/'
                       << id << ".urdf\"\n";
}

SharedRobotCell::~SharedRobotCell() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

}  // namespace cellmirror
