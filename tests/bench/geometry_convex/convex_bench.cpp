// Distances of primitives and triangles, and depths, beside FCL's distance of the same bodies in the same poses:
//   geometry_convex_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
// Bodies are apart: FCL's distance() may end the program where they touch.
#include <benchmark/benchmark.h>
#include <fcl/narrowphase/distance.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/geometry/triangle.hpp"
#include "tests/unit/geometry_convex/shapes.hpp"

namespace cellmirror::geometry {
namespace {

constexpr std::size_t kPoses = 1024;  // a power of two

enum class Kind : std::uint8_t { sphere, capsule, box, cylinder, triangle };
constexpr Kind kKinds[] = {Kind::sphere, Kind::capsule, Kind::box, Kind::cylinder, Kind::triangle};

std::string kind_name(Kind kind) {
  static const std::map<Kind, std::string> kNames{{Kind::sphere, "sphere"},
                                                  {Kind::capsule, "capsule"},
                                                  {Kind::box, "box"},
                                                  {Kind::cylinder, "cylinder"},
                                                  {Kind::triangle, "triangle"}};
  return kNames.at(kind);
}

ConvexCore core_of(Kind kind) {
  switch (kind) {
    case Kind::sphere:
      return sphere(0.2);
    case Kind::capsule:
      return capsule(0.15, 0.3);
    case Kind::box:
      return box(0.2, 0.3, 0.15);
    case Kind::cylinder:
      return cylinder(0.2, 0.3);
    case Kind::triangle:
      break;
  }
  return triangle({-0.2, -0.1, 0}, {0.3, 0, 0.1}, {0, 0.3, -0.1});
}

std::shared_ptr<fcl::CollisionGeometryd> peer_of(Kind kind) {
  switch (kind) {
    case Kind::sphere:
      return std::make_shared<fcl::Sphered>(0.2);
    case Kind::capsule:
      return std::make_shared<fcl::Capsuled>(0.15, 0.6);
    case Kind::box:
      return std::make_shared<fcl::Boxd>(0.4, 0.6, 0.3);
    case Kind::cylinder:
      return std::make_shared<fcl::Cylinderd>(0.2, 0.6);
    case Kind::triangle:
      break;
  }
  return nullptr;
}

using Poses = std::vector<std::pair<Pose, Pose>>;

// All of them apart, or all of them overlapping.
Poses poses_of(const ConvexCore& a, const ConvexCore& b, bool apart) {
  AnyShapes any(41);
  Poses out;
  while (out.size() < kPoses) {
    const Pose X_WA = any.pose(apart ? 0.6 : 0.2);
    const Pose X_WB = any.pose(apart ? 0.6 : 0.2);
    const double distance = convex_distance(a, X_WA, b, X_WB).points.distance;
    if (apart ? distance > 0.02 : distance <= 0.0) out.emplace_back(X_WA, X_WB);
  }
  return out;
}

void distance_ours(benchmark::State& state, Kind kind_a, Kind kind_b) {
  const ConvexCore a = core_of(kind_a);
  const ConvexCore b = core_of(kind_b);
  const Poses poses = poses_of(a, b, true);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [X_WA, X_WB] = poses[i++ % kPoses];
    benchmark::DoNotOptimize(convex_distance(a, X_WA, b, X_WB));
  }
}

// As trees ask: most pairs are farther apart than the nearest one so far.
void distance_bounded(benchmark::State& state, Kind kind_a, Kind kind_b) {
  const ConvexCore a = core_of(kind_a);
  const ConvexCore b = core_of(kind_b);
  const Poses poses = poses_of(a, b, true);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [X_WA, X_WB] = poses[i++ % kPoses];
    benchmark::DoNotOptimize(convex_distance(a, X_WA, b, X_WB, 0.05));
  }
}

void distance_fcl(benchmark::State& state, Kind kind_a, Kind kind_b) {
  const Poses poses = poses_of(core_of(kind_a), core_of(kind_b), true);
  fcl::CollisionObjectd a(peer_of(kind_a));
  fcl::CollisionObjectd b(peer_of(kind_b));
  const fcl::DistanceRequestd request(true);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [X_WA, X_WB] = poses[i++ % kPoses];
    a.setTransform(X_WA);
    b.setTransform(X_WB);
    fcl::DistanceResultd result;
    benchmark::DoNotOptimize(fcl::distance(&a, &b, request, result));
  }
}

void depth_ours(benchmark::State& state, Kind kind_a, Kind kind_b) {
  const ConvexCore a = core_of(kind_a);
  const ConvexCore b = core_of(kind_b);
  const Poses poses = poses_of(a, b, false);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [X_WA, X_WB] = poses[i++ % kPoses];
    benchmark::DoNotOptimize(convex_penetration(a, X_WA, b, X_WB));
  }
}

std::vector<std::pair<Triangle, Triangle>> triangle_pairs() {
  AnyShapes any(42);
  std::vector<std::pair<Triangle, Triangle>> out;
  for (std::size_t i = 0; i < kPoses; ++i) {
    const Eigen::Vector3d offset = 0.8 * any.vector();
    out.push_back({{0.3 * any.vector(), 0.3 * any.vector(), 0.3 * any.vector()},
                   {offset + 0.3 * any.vector(), offset + 0.3 * any.vector(), offset + 0.3 * any.vector()}});
  }
  return out;
}

void triangles(benchmark::State& state) {
  const auto pairs = triangle_pairs();
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [a, b] = pairs[i++ % kPoses];
    benchmark::DoNotOptimize(triangle_triangle(a, b));
  }
}
BENCHMARK(triangles)->Name("distance/ours/triangles_in_one_frame");

void triangles_bounded(benchmark::State& state) {
  const auto pairs = triangle_pairs();
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [a, b] = pairs[i++ % kPoses];
    benchmark::DoNotOptimize(triangle_triangle(a, b, 0.05));
  }
}
BENCHMARK(triangles_bounded)->Name("distance/bounded/triangles_in_one_frame");

const bool kRegistered = [] {
  for (const Kind a : kKinds) {
    for (const Kind b : kKinds) {
      if (b < a) continue;
      const std::string pair = kind_name(a) + "_" + kind_name(b);
      benchmark::RegisterBenchmark(("distance/ours/" + pair).c_str(), distance_ours, a, b);
      benchmark::RegisterBenchmark(("distance/bounded/" + pair).c_str(), distance_bounded, a, b);
      if (b != Kind::triangle) benchmark::RegisterBenchmark(("distance/fcl/" + pair).c_str(), distance_fcl, a, b);
      benchmark::RegisterBenchmark(("depth/ours/" + pair).c_str(), depth_ours, a, b);
    }
  }
  return true;
}();

}  // namespace
}  // namespace cellmirror::geometry

BENCHMARK_MAIN();
