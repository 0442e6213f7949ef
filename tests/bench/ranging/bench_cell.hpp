// A cell for benchmarks of ranging: four arms of seven links, a floor, tables, pipes and 64 sensors; 100,000 triangles.
// Made by formulas, so that it is the same everywhere.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror {

inline constexpr std::size_t kBenchArms = 4;
inline constexpr std::size_t kBenchLinks = 7;
inline constexpr std::size_t kBenchSensors = 64;

// Half-angles 7.5, 15 and 30 degrees in turn, range 3 m; a quarter of the sensors ride on the arms.
[[nodiscard]] std::shared_ptr<const CompiledCell> bench_cell();
[[nodiscard]] std::size_t triangles_of(const CompiledCell& cell);
// The posture at tick `tick` of 1 ms, all joints moving at up to 1 rad/s.
[[nodiscard]] std::vector<JointValues> bench_posture(std::size_t tick);
// One mesh of 103,000 triangles, bumpy, about 2 m across.
[[nodiscard]] std::shared_ptr<const geometry::TriangleMesh> bench_rock();

}  // namespace cellmirror
