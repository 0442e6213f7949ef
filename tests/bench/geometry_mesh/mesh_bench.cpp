// Distances and touch of two meshes against FCL, on links of a robot of ../shared/data (or, without them, two tori of
// about the same size), in 128 random places at each of three gaps:
//   geometry_mesh_bench --benchmark_repetitions=3
// "moving" asks again after a motion of half a millimetre and a milliradian, with the hint of the last answer.
#include <benchmark/benchmark.h>

#include <fcl/fcl.h>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "rt_core/geometry/proximity.hpp"
#include "tests/unit/geometry_tree/shapes.hpp"

namespace cellmirror::geometry {
namespace {

using Eigen::Vector3d;
using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kPlaces = 128;  // a power of two

// Empty where the file is missing or none that we read.
test::MeshPointer read_binary_stl(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  constexpr std::size_t kHeader = 84;
  constexpr std::size_t kRecord = 50;
  std::vector<Vector3d> vertices;
  std::vector<TriangleIndices> triangles;
  for (std::size_t at = kHeader; at + kRecord <= bytes.size(); at += kRecord) {
    std::array<float, 12> numbers;
    std::memcpy(numbers.data(), bytes.data() + at, sizeof numbers);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (std::size_t k = 3; k < 12; k += 3) vertices.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
    triangles.push_back({first, first + 1, first + 2});
  }
  MeshFindings findings;
  auto mesh = make_mesh(path.filename(), std::move(vertices), std::move(triangles), findings);
  return mesh ? test::share(std::move(*mesh)) : nullptr;
}

std::filesystem::path shared_data() {
  if (const char* given = std::getenv("CELLMIRROR_SHARED_DATA"); given != nullptr) return given;
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return std::filesystem::path(source != nullptr ? source : ".") / "../shared/data";
}

std::shared_ptr<FclMesh> fcl_mesh(const TriangleMesh& mesh) {
  auto out = std::make_shared<FclMesh>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  out->beginModel();
  out->addSubModel(mesh.vertices, triangles);
  out->endModel();
  return out;
}

struct Place {
  Pose X_WB;
  Pose X_WB_moved;
};

struct Bodies {
  explicit Bodies(const char* a_file, const char* b_file, double ring) {
    const std::filesystem::path folder = shared_data() / "robots";
    test::MeshPointer mesh_a = read_binary_stl(folder / a_file);
    test::MeshPointer mesh_b = read_binary_stl(folder / b_file);
    if (!mesh_a || !mesh_b) {
      mesh_a = test::share(test::torus(ring, 0.3 * ring, 40, 25));
      mesh_b = test::share(test::torus(0.8 * ring, 0.2 * ring, 32, 16));
    }
    a = make_mesh_solid(mesh_a);
    b = make_mesh_solid(mesh_b);
    fcl_a = std::make_unique<fcl::CollisionObjectd>(fcl_mesh(*mesh_a));
    fcl_b = std::make_unique<fcl::CollisionObjectd>(fcl_mesh(*mesh_b));
  }

  const std::vector<Place>& places(double gap) const {
    std::vector<Place>& known = places_[gap];
    if (known.empty()) known = find_places(gap);
    return known;
  }

  // Random directions and turns, moved until the gap is as given.
  std::vector<Place> find_places(double gap) const {
    std::mt19937_64 random(5);
    std::vector<Place> out;
    while (out.size() < kPlaces) {
      Pose X = test::random_pose(random, 1.0);
      const Vector3d way = X.translation().normalized();
      double near = 0;
      double far = 2 * (a.radius + b.radius) + gap + a.centre.norm() + b.centre.norm();
      for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (near + far);
        X.translation() = middle * way;
        ProximityHint hint;
        (separation(a, Pose::Identity(), b, X, gap, hint).beyond ? far : near) = middle;
      }
      X.translation() = far * way;
      Pose moved = X;
      moved.translation() += 5e-4 * test::random_pose(random, 1.0).translation().normalized();
      moved.linear() = X.linear() * Eigen::AngleAxisd(1e-3, Vector3d::UnitY()).toRotationMatrix();
      out.push_back({X, moved});
    }
    return out;
  }

  Solid a;
  Solid b;
  std::unique_ptr<fcl::CollisionObjectd> fcl_a;
  std::unique_ptr<fcl::CollisionObjectd> fcl_b;
  mutable std::map<double, std::vector<Place>> places_;  // google benchmark calls each function several times
};

const Bodies& bodies(std::int64_t which) {
  static const Bodies kArm("ur5e/meshes/collision/upperarm.stl", "ur5e/meshes/collision/forearm.stl", 0.2);
  static const Bodies kLinks("lrmate200id/meshes/collision/link_3.stl", "lrmate200id/meshes/collision/link_1.stl", 0.2);
  return which == 0 ? kArm : kLinks;
}

void describe(benchmark::State& state, const Bodies& pair) {
  state.counters["triangles"] = static_cast<double>(pair.a.tree->triangles().size() + pair.b.tree->triangles().size());
}

double gap_of(const benchmark::State& state) { return 1e-3 * static_cast<double>(state.range(1)); }

void distance_anew(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  const std::vector<Place>& places = pair.places(gap_of(state));
  std::size_t i = 0;
  for (auto _ : state) {
    ProximityHint hint;
    benchmark::DoNotOptimize(separation(pair.a, Pose::Identity(), pair.b, places[i++ % kPlaces].X_WB, kInfinity, hint));
  }
  describe(state, pair);
}

void distance_moving(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  const std::vector<Place>& places = pair.places(gap_of(state));
  std::vector<ProximityHint> hints(kPlaces);
  for (std::size_t i = 0; i < kPlaces; ++i) {
    (void)separation(pair.a, Pose::Identity(), pair.b, places[i].X_WB, kInfinity, hints[i]);
  }
  std::size_t i = 0;
  for (auto _ : state) {
    ProximityHint hint = hints[i % kPlaces];
    benchmark::DoNotOptimize(
        separation(pair.a, Pose::Identity(), pair.b, places[i++ % kPlaces].X_WB_moved, kInfinity, hint));
  }
  describe(state, pair);
}

void distance_beyond(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  const std::vector<Place>& places = pair.places(gap_of(state));
  std::size_t i = 0;
  for (auto _ : state) {
    ProximityHint hint;
    benchmark::DoNotOptimize(
        separation(pair.a, Pose::Identity(), pair.b, places[i++ % kPlaces].X_WB, 0.5 * gap_of(state), hint));
  }
  describe(state, pair);
}

void touch_missed(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  const std::vector<Place>& places = pair.places(gap_of(state));
  std::vector<ProximityHint> hints(kPlaces);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(touch(pair.a, Pose::Identity(), pair.b, places[i % kPlaces].X_WB, hints[i % kPlaces]));
    ++i;
  }
  describe(state, pair);
}

void contact_overlapping(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  std::vector<Place> places = pair.places(0.0);
  for (Place& place : places) place.X_WB.translation() *= 0.95;
  Contact out;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(contact(pair.a, Pose::Identity(), pair.b, places[i++ % kPlaces].X_WB, 8, out));
  }
  describe(state, pair);
}

void fcl_distance(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  const std::vector<Place>& places = pair.places(gap_of(state));
  std::size_t i = 0;
  for (auto _ : state) {
    pair.fcl_b->setTransform(places[i++ % kPlaces].X_WB);
    fcl::DistanceRequestd request(true);
    fcl::DistanceResultd result;
    benchmark::DoNotOptimize(fcl::distance(pair.fcl_a.get(), pair.fcl_b.get(), request, result));
  }
  describe(state, pair);
}

void fcl_collide_missed(benchmark::State& state) {
  const Bodies& pair = bodies(state.range(0));
  const std::vector<Place>& places = pair.places(gap_of(state));
  std::size_t i = 0;
  for (auto _ : state) {
    pair.fcl_b->setTransform(places[i++ % kPlaces].X_WB);
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    benchmark::DoNotOptimize(fcl::collide(pair.fcl_a.get(), pair.fcl_b.get(), request, result));
  }
  describe(state, pair);
}

void build(benchmark::State& state) {
  const test::MeshPointer mesh = test::share(test::torus(1, 0.3, static_cast<int>(state.range(0)) / 250, 125));
  for (auto _ : state) benchmark::DoNotOptimize(MeshTree(mesh));
}

void gaps(benchmark::internal::Benchmark* of) {
  of->ArgNames({"links", "gap_mm"})->Unit(benchmark::kMicrosecond);
  for (const std::int64_t links : {0, 1}) {
    for (const std::int64_t gap : {2, 20, 100}) of->Args({links, gap});
  }
}

BENCHMARK(distance_anew)->Apply(gaps);
BENCHMARK(distance_moving)->Apply(gaps);
BENCHMARK(distance_beyond)->Apply(gaps);
BENCHMARK(touch_missed)->Apply(gaps);
BENCHMARK(contact_overlapping)->ArgNames({"links"})->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
BENCHMARK(fcl_distance)->Apply(gaps);
BENCHMARK(fcl_collide_missed)->Apply(gaps);
BENCHMARK(build)->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cellmirror::geometry

BENCHMARK_MAIN();
