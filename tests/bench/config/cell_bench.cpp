// The figures of the cell model: 200 components with 20 robots of 7 joints, 2,200 nodes; and a cell with 100,000
// triangles in 20 STL files.
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "config/cell_file.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/geometry_mesh/shapes.hpp"

namespace cellmirror {
namespace {

namespace fs = std::filesystem;

class LargeCell {
 public:
  LargeCell() : root_(fs::temp_directory_path() / ("cellmirror_bench_" + std::to_string(getpid()))) {
    fs::create_directories(root_ / "envlib");
    std::string cell = "format = 1\nname = \"large\"\n";
    for (int i = 0; i < 200; ++i) {
      const std::string n = std::to_string(i);
      std::ofstream(root_ / ("envlib/c" + n + ".mpc")) << component(i);
      cell += "[[node]]\nname = \"C" + n + "\"\nabstract = \"c" + n + ".mpc\"\nxyz_m = [" + n + ", 0, 0]\n";
    }
    std::ofstream(root_ / "cell.toml") << cell;
  }
  ~LargeCell() { fs::remove_all(root_); }
  LargeCell(const LargeCell&) = delete;
  LargeCell& operator=(const LargeCell&) = delete;

  LoadedCell load() const {
    Diagnostics diagnostics;
    auto loaded = load_cell(root_ / "cell.toml", diagnostics);
    if (!loaded) std::fputs(diagnostics.text().c_str(), stderr);
    return std::move(loaded.value());
  }

 private:
  static std::string component(int i) {
    std::string text = "format = 1\ngeometry = [{ box_m = [1, 1, 1] }]\n";
    for (int k = 0; k < 10; ++k) {
      text += "[[node]]\nname = \"N" + std::to_string(k) + "\"\nxyz_m = [0, 0, 0.1]\n";
      if (k > 0) text += "parent = \"N" + std::to_string(k - 1) + "\"\n";
      text += "geometry = [{ box_m = [0.1, 0.1, 0.1] }, { sphere_m = 0.2, xyz_m = [0, 0, 0.1] }]\n";
      if (i < 20 && k < 7)
        text += "joint = { type = \"revolute\", axis = [0, 0, 1], range_rad = [-3, 3], velocity_rad_s = 1 }\n";
    }
    if (i < 20) text += "[robot]\nid = \"R" + std::to_string(i) + "\"\nflange = \"N9\"\n";
    return text;
  }
  fs::path root_;
};

const LargeCell& large_cell() {
  static const LargeCell cell;
  return cell;
}

// Rings of 5,000 triangles each, as binary STL.
class MeshCell {
 public:
  MeshCell() : root_(fs::temp_directory_path() / ("cellmirror_mesh_bench_" + std::to_string(getpid()))) {
    fs::create_directories(root_ / "envlib");
    std::string cell = "format = 1\nname = \"meshes\"\n";
    for (int i = 0; i < kFiles; ++i) {
      const std::string n = std::to_string(i);
      const geometry::Soup ring = geometry::torus(0.5, 0.1 + 0.001 * i, 50, 50);
      std::vector<std::array<std::array<float, 3>, 3>> triangles;
      for (const auto& triangle : ring.triangles) {
        auto& corners = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            corners[k][axis] = static_cast<float>(ring.vertices[triangle[k]][static_cast<Eigen::Index>(axis)]);
        }
      }
      std::ofstream(root_ / ("envlib/ring" + n + ".stl"), std::ios::binary) << binary_stl(triangles);
      cell +=
          "[[node]]\nname = \"R" + n + "\"\ngeometry = [{ mesh = \"ring" + n + ".stl\", xyz_m = [" + n + ", 0, 0] }]\n";
    }
    std::ofstream(root_ / "cell.toml") << cell;
  }
  ~MeshCell() { fs::remove_all(root_); }
  MeshCell(const MeshCell&) = delete;
  MeshCell& operator=(const MeshCell&) = delete;

  LoadedCell load() const {
    Diagnostics diagnostics;
    auto loaded = load_cell(root_ / "cell.toml", diagnostics);
    if (!loaded) std::fputs(diagnostics.text().c_str(), stderr);
    return std::move(loaded.value());
  }

 private:
  static constexpr int kFiles = 20;
  fs::path root_;
};

// Bytes that the process has from malloc.
double allocated_bytes() { return static_cast<double>(mallinfo2().uordblks + mallinfo2().hblkhd); }

void load_100000_triangles(benchmark::State& state) {
  static const MeshCell cell;
  double mesh_bytes = 0.0;
  for (auto _ : state) {
    const double before = allocated_bytes();
    const LoadedCell loaded = cell.load();
    mesh_bytes = allocated_bytes() - before;
  }
  state.counters["bytes_per_triangle"] = mesh_bytes / 1e5;
}
BENCHMARK(load_100000_triangles)->Unit(benchmark::kMillisecond);

void load_200_components(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(large_cell().load().cell.node_count());
}
BENCHMARK(load_200_components)->Unit(benchmark::kMillisecond);

void find_a_known_path(benchmark::State& state) {
  const LoadedCell loaded = large_cell().load();
  for (auto _ : state) benchmark::DoNotOptimize(loaded.cell.knows("C150.N9"));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(find_a_known_path);

void compute_all_poses(benchmark::State& state) {
  const LoadedCell loaded = large_cell().load();
  const auto picture = loaded.cell.compile();
  auto q = loaded.cell.start_positions();
  CellPoses poses;
  for (auto _ : state) {
    q[3][2] += 1e-6;
    compute_poses(*picture, q, poses);
    benchmark::DoNotOptimize(poses.X_WN.back());
  }
}
BENCHMARK(compute_all_poses)->Unit(benchmark::kMicrosecond);

void place_and_compile(benchmark::State& state) {
  LoadedCell loaded = large_cell().load();
  Pose X = Pose::Identity();
  for (auto _ : state) {
    X.translation().x() += 1e-6;
    if (!loaded.cell.set_placement("C150", X)) state.SkipWithError("refused");
    benchmark::DoNotOptimize(loaded.cell.compile());
  }
}
BENCHMARK(place_and_compile)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cellmirror

BENCHMARK_MAIN();
