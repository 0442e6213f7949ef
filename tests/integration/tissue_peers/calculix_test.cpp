// Equilibria against those of CalculiX (ccx), with the same tetrahedra and the same energy. Every node agrees within
// 0.1 % of the largest displacement.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

constexpr double kLength = 0.1;  // m
constexpr double kHeight = 0.02;

// A block that is held at its face at x = 0 and loaded at the opposite one.
struct LoadCase {
  std::string name;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, on the end, the same on each node
  double turn = 0;                                  // rad: or the end is turned about the middle axis, and shifted
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

void PrintTo(const LoadCase& load, std::ostream* out) { *out << load.name; }

bool at_start(const Eigen::Vector3d& p) { return p.x() < 1e-6; }
bool at_end(const Eigen::Vector3d& p) { return p.x() > kLength - 1e-6; }

Eigen::Vector3d turned(const LoadCase& load, const Eigen::Vector3d& p, double share) {
  const Eigen::Vector3d middle(0, kHeight / 2, kHeight / 2);
  return middle + Eigen::AngleAxisd(share * load.turn, Eigen::Vector3d::UnitX()) * (p - middle) + share * load.shift;
}

ObjectDescription description() {
  ObjectDescription d = block(Eigen::Vector3d(kLength, kHeight, kHeight), {10, 2, 2});
  d.material = {
      .youngs_modulus_pa = 5000, .poissons_ratio = 0.45, .density_kg_m3 = 1000, .damping_s = 1e-4, .drag_1_s = 15};
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1e-6, 1, 1)});
  return d;
}

std::string input_of(const ObjectDescription& d, const LoadCase& load) {
  const double e = d.material.youngs_modulus_pa;
  const double shear = e / (2.0 * (1.0 + d.material.poissons_ratio));
  const double bulk = e / (3.0 * (1.0 - 2.0 * d.material.poissons_ratio));
  std::string text = "*NODE, NSET=ALL\n";
  std::string held = "*BOUNDARY\n";
  std::string moved;
  std::string forces;
  std::size_t ends = 0;
  for (const Eigen::Vector3d& p : d.volume.nodes) ends += at_end(p) ? 1U : 0U;
  for (std::size_t n = 0; n < d.volume.nodes.size(); ++n) {
    const Eigen::Vector3d& p = d.volume.nodes[n];
    text += fmt::format("{}, {:.12e}, {:.12e}, {:.12e}\n", n + 1, p.x(), p.y(), p.z());
    if (at_start(p)) held += fmt::format("{}, 1, 3\n", n + 1);
    if (!at_end(p)) continue;
    const Eigen::Vector3d by = turned(load, p, 1.0) - p;
    for (int k = 0; k < 3; ++k) {
      moved += fmt::format("{}, {}, {}, {:.12e}\n", n + 1, k + 1, k + 1, by[k]);
      forces += fmt::format("{}, {}, {:.12e}\n", n + 1, k + 1, load.force[k] / static_cast<double>(ends));
    }
  }
  text += "*ELEMENT, TYPE=C3D4, ELSET=ALL\n";
  for (std::size_t t = 0; t < d.volume.tetrahedra.size(); ++t) {
    const auto& [n0, n1, n2, n3] = d.volume.tetrahedra[t];
    text += fmt::format("{}, {}, {}, {}, {}\n", t + 1, n0 + 1, n1 + 1, n2 + 1, n3 + 1);
  }
  text += fmt::format("*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n{:.12e}, {:.12e}\n", shear / 2, 2 / bulk);
  text +=
      "*SOLID SECTION, ELSET=ALL, MATERIAL=TISSUE\n" + held + "*STEP, NLGEOM, INC=2000\n*STATIC\n0.05, 1., 1e-6, 0.1\n";
  text += "*CONTROLS, PARAMETERS=FIELD\n1e-7, 1e-6, , , 1e-7\n";
  text += load.turn != 0 ? "*BOUNDARY\n" + moved : "*CLOAD\n" + forces;
  return text + "*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
}

// Displacements by node, of the last increment; empty where ccx has failed.
std::vector<Eigen::Vector3d> calculix(const ObjectDescription& d, const LoadCase& load) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("cellmirror_ccx_{}_{}", ::getpid(), load.name);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "job.inp") << input_of(d, load);
  const std::string command =
      fmt::format("cd '{}' && OMP_NUM_THREADS=1 timeout 60 ccx -i job > job.log 2>&1", folder.string());
  std::vector<Eigen::Vector3d> found;
  double time = 0;
  if (std::system(command.c_str()) == 0) {
    std::ifstream file(folder / "job.dat");
    for (std::string line; std::getline(file, line);) {
      if (const auto at = line.find("and time"); at != std::string::npos) {
        found.assign(d.volume.nodes.size(), Eigen::Vector3d::Zero());
        time = std::strtod(line.c_str() + at + 8, nullptr);
        continue;
      }
      std::istringstream words(line);
      std::size_t node = 0;
      Eigen::Vector3d u;
      if (words >> node >> u.x() >> u.y() >> u.z() && node >= 1 && node <= found.size()) found[node - 1] = u;
    }
  }
  std::filesystem::remove_all(folder);
  EXPECT_EQ(time, 1.0) << "ccx has not come to the end of the step";
  return time == 1.0 ? found : std::vector<Eigen::Vector3d>{};
}

// The body's equilibrium: the load comes within the first half second, and drag brings it to rest.
Body settled(const ObjectDescription& d, const LoadCase& load) {
  Body body = made(d);
  const double dt = step_of(body);
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  std::vector<std::uint32_t> ends;
  for (std::uint32_t n = 0; n < start.size(); ++n) {
    if (at_end(start[n])) ends.push_back(n);
  }
  constexpr double kLoading_s = 0.5;
  constexpr double kMost_s = 20;
  for (int i = 0; i < static_cast<int>(kMost_s / dt); ++i) {
    const double share = std::min(1.0, (i + 1) * dt / kLoading_s);
    for (const std::uint32_t n : ends) body.add_force(n, share * load.force / static_cast<double>(ends.size()));
    body.begin_step(dt, Eigen::Vector3d::Zero());
    if (load.turn != 0) {
      for (const std::uint32_t n : ends) {
        body.add_velocity(n, (turned(load, start[n], share) - body.positions()[n]) / dt - body.velocities()[n]);
      }
    }
    body.end_step(dt);
    if (i * dt > 3.0 && body.largest_speed() < 5e-6) break;
  }
  EXPECT_LT(body.largest_speed(), 1e-5);  // rounding of the forces keeps some um/s
  return body;
}

class CalculixTest : public testing::TestWithParam<LoadCase> {};

TEST_P(CalculixTest, FindsTheSameEquilibrium) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "skipped: CalculiX (ccx) is not installed; ./check --peers installs it";
  }
  const ObjectDescription d = description();
  const std::vector<Eigen::Vector3d> expected = calculix(d, GetParam());
  ASSERT_EQ(expected.size(), d.volume.nodes.size());
  const Body fresh = made(d);  // numbers its nodes by where they are
  const Body body = settled(d, GetParam());
  double largest = 0;
  double worst = 0;
  for (std::size_t n = 0; n < fresh.positions().size(); ++n) {
    const auto at = std::ranges::find_if(
        d.volume.nodes, [&](const Eigen::Vector3d& p) { return (p - fresh.positions()[n]).norm() < 1e-9; });
    ASSERT_NE(at, d.volume.nodes.end());
    const Eigen::Vector3d& u = expected[static_cast<std::size_t>(at - d.volume.nodes.begin())];
    largest = std::max(largest, u.norm());
    worst = std::max(worst, (body.positions()[n] - fresh.positions()[n] - u).norm());
  }
  fmt::print("{}: largest displacement {:.3f} mm, nodes differ by at most {:.5f} % of it\n", GetParam().name,
             1e3 * largest, 100 * worst / largest);
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(worst, 1e-3 * largest);
}

INSTANTIATE_TEST_SUITE_P(Loads, CalculixTest,
                         testing::Values(LoadCase{.name = "stretch", .force = Eigen::Vector3d(0.6, 0, 0)},
                                         LoadCase{.name = "bend", .force = Eigen::Vector3d(0, 0.01, -0.06)},
                                         LoadCase{.name = "twist",
                                                  .turn = 0.75 * std::numbers::pi,
                                                  .shift = Eigen::Vector3d(-0.01, 0.01, 0)}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace cellmirror::tissue
