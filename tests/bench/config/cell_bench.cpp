// The figures of the cell model: 200 components with 20 robots of 7 joints, 2,200 nodes.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "config/cell_file.hpp"

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
