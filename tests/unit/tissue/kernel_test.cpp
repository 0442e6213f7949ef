// The vectorized forces of elements against the formulas of the energy in doubles, one element at a time.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rt_core/tissue/body/element_kernel.hpp"

namespace cellmirror::tissue {
namespace {

constexpr double kLeastJ = 0.1;

struct Sample {
  Eigen::Matrix3d b;
  Eigen::Matrix3d x;     // edges
  Eigen::Matrix3d last;  // strain before
  double mu = 0;
  double bulk = 0;
  double viscous_mu = 0;
  double viscous_lambda = 0;
  double elastic_factor = 0;
  double viscous_factor = 0;
};

struct Forces {
  Eigen::Matrix3d f;  // by node, columns
  Eigen::Matrix3d strain;
  double measure = 0;
  double load = 0;
  double scale = 0;  // of the terms that add up to the forces
};

// (omega step / 2)^2 by the largest eigenvalue of the acoustic tensor, term by term.
double load(const Sample& s, const Eigen::Matrix3d& f) {
  const Eigen::Vector3d stretch =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(f.transpose() * f).eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const double j = f.determinant();
  const double i1 = f.squaredNorm();
  const double kept = std::max(j, kLeastJ);
  const double isochoric = j > kLeastJ ? s.mu / 3.0 * i1 * std::pow(kept, -5.0 / 3.0) : 0.0;
  const double area = stretch[1] * stretch[2];
  const double elastic = (s.bulk + 5.0 / 3.0 * isochoric / kept) * area * area + s.mu * std::pow(kept, -2.0 / 3.0) +
                         std::abs(s.bulk * (j - 1.0) - isochoric) * stretch[2];
  return s.elastic_factor * elastic + s.viscous_factor * stretch[2] * stretch[2];
}

Forces plain(const Sample& s) {
  const Eigen::Matrix3d f = s.x * s.b;
  const double j = f.determinant();
  const double i1 = f.squaredNorm();
  Eigen::Matrix3d cofactors;
  for (int c = 0; c < 3; ++c) cofactors.col(c) = f.col((c + 1) % 3).cross(f.col((c + 2) % 3));
  const double kept = std::max(j, kLeastJ);
  const double factor = s.mu * std::pow(kept, -2.0 / 3.0);
  Eigen::Matrix3d p = factor * f + s.bulk * (j - 1.0) * cofactors;
  if (j > kLeastJ) p -= factor * i1 / (3.0 * j) * cofactors;
  Forces out;
  out.strain = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d change = out.strain - s.last;
  p += f * (s.viscous_mu * change + s.viscous_lambda * change.trace() * Eigen::Matrix3d::Identity());
  out.f = -p * s.b.transpose();
  out.measure = i1 * std::pow(kept, -2.0 / 3.0) - 3.0;
  out.load = load(s, f);
  const double largest =
      std::max({factor * f.norm(), s.bulk * std::abs(j - 1.0) * cofactors.norm(),
                j > kLeastJ ? factor * i1 / (3.0 * j) * cofactors.norm() : 0.0,
                f.norm() * (s.viscous_mu + s.viscous_lambda) * (out.strain.norm() + s.last.norm() + 1.0)});
  // F itself comes of products that cancel each other.
  out.scale = largest * s.b.norm() * std::max(1.0, s.x.norm() * s.b.norm() / 3.0);
  return out;
}

constexpr std::array<std::array<int, 2>, 6> kStrainAt{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

std::vector<Sample> random_samples(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Sample> samples;
  while (samples.size() < count) {
    Sample s;
    // Elements of a few millimetres, not too flat, and any deformation: stretched, squeezed, turned inside out.
    Eigen::Matrix3d rest;
    for (double& v : rest.reshaped()) v = 0.005 * normal(random);
    if (std::abs(rest.determinant()) < 0.1 * std::pow(0.005, 3)) continue;
    s.b = rest.inverse();
    Eigen::Matrix3d f;
    const double wild = std::pow(10.0, -3.0 * uniform(random)) * 1.5;
    for (double& v : f.reshaped()) v = wild * normal(random);
    f += Eigen::AngleAxisd(6.0 * uniform(random), Eigen::Vector3d(normal(random), normal(random), 1.0).normalized())
             .toRotationMatrix();
    if (std::abs(f.determinant() - kLeastJ) < 1e-3) continue;  // the stress leaps there
    s.x = f * rest;
    s.mu = 1e-4 * uniform(random);
    s.bulk = 1e-3 * uniform(random);
    s.viscous_mu = samples.size() % 3 == 0 ? 0.0 : 1e-4 * uniform(random);
    s.viscous_lambda = 2.0 * s.viscous_mu;
    s.elastic_factor = 0.3 * uniform(random) / (s.bulk + 4.0 / 3.0 * s.mu);
    s.viscous_factor = 0.1 * uniform(random);
    Eigen::Matrix3d last;
    for (double& v : last.reshaped()) v = 0.1 * normal(random);
    s.last = 0.5 * (last + last.transpose());
    samples.push_back(s);
  }
  return samples;
}

ElementBlocks blocks_of(const std::vector<Sample>& samples) {
  ElementBlocks blocks;
  blocks.resize(samples.size());
  for (std::size_t e = 0; e < samples.size(); ++e) {
    const Sample& s = samples[e];
    const auto put = [&](std::size_t v, double value) {
      lane_value(blocks.material, ElementBlocks::kMaterialValues, e, v) = static_cast<float>(value);
    };
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) put(static_cast<std::size_t>(3 * r + c), s.b(r, c));
    }
    put(9, s.mu);
    put(10, s.bulk);
    put(11, s.viscous_mu);
    put(12, s.viscous_lambda);
    put(13, s.elastic_factor);
    put(14, s.viscous_factor);
    for (std::uint32_t n = 0; n < 4; ++n) blocks.nodes[e][n] = 4 * static_cast<std::uint32_t>(e) + n;
    for (std::size_t v = 0; v < 6; ++v) {
      lane_value(blocks.last_strain, 6, e, v) = static_cast<float>(s.last(kStrainAt[v][0], kStrainAt[v][1]));
    }
  }
  return blocks;
}

// Every element has four nodes of its own. Returns their forces.
std::vector<NodeVector> forces_of(const std::vector<Sample>& samples, ElementBlocks& blocks,
                                  KernelSums* sums = nullptr) {
  std::vector<NodeVector> x;
  for (const Sample& s : samples) {
    x.push_back({{0.1, 0.2, 0.3, 0.0}});
    for (int n = 0; n < 3; ++n) x.push_back({{0.1 + s.x(0, n), 0.2 + s.x(1, n), 0.3 + s.x(2, n), 0.0}});
  }
  std::vector<NodeVector> f(x.size());
  const KernelSums result = compute_element_forces(blocks, x, f);
  if (sums != nullptr) *sums = result;
  return f;
}

std::vector<std::string> targets() {
  std::vector<std::string> found;
  for (const char* name : {"SSE2", "SSSE3", "SSE4", "AVX2", "AVX3", "AVX3_DL", "NEON", "EMU128"}) {
    if (force_simd_target(name)) found.emplace_back(name);
  }
  force_simd_target({});
  return found;
}

void compare(const std::vector<Sample>& samples, const std::string& target) {
  ElementBlocks blocks = blocks_of(samples);
  KernelSums sums;
  const std::vector<NodeVector> forces = forces_of(samples, blocks, &sums);
  std::uint32_t inverted = 0;
  double largest = 0;
  std::size_t loaded = 0;
  for (std::size_t e = 0; e < samples.size(); ++e) {
    const Forces expected = plain(samples[e]);
    inverted += (samples[e].x * samples[e].b).determinant() < 0 ? 1U : 0U;
    largest = std::max(largest, expected.measure);
    for (int r = 0; r < 3; ++r) {
      for (int n = 0; n < 3; ++n) {
        const double force = forces[4 * e + 1 + static_cast<std::size_t>(n)].xyz0[static_cast<std::size_t>(r)];
        ASSERT_NEAR(force, expected.f(r, n), 5e-5 * expected.scale) << target << ", element " << e;
      }
      double sum = 0;
      for (std::size_t n = 0; n < 4; ++n) sum += forces[4 * e + n].xyz0[static_cast<std::size_t>(r)];
      ASSERT_NEAR(sum, 0.0, 1e-12 * expected.scale);
    }
    for (std::size_t v = 0; v < 6; ++v) {
      ASSERT_NEAR(static_cast<double>(lane_value(blocks.last_strain, 6, e, v)),
                  expected.strain(kStrainAt[v][0], kStrainAt[v][1]), 1e-5 * (1.0 + expected.strain.norm()));
    }
    ASSERT_NEAR(static_cast<double>(lane_value(blocks.strain, 1, e, 0)), expected.measure,
                3e-5 * (3.0 + expected.measure));
    // From above, and where it asks for more mass, close.
    const double found = static_cast<double>(lane_value(blocks.load, 1, e, 0));
    ASSERT_GT(found, (1.0 - 1e-4) * expected.load) << target << ", element " << e;
    if (expected.load > static_cast<double>(kMostLoad)) {
      ++loaded;
      ASSERT_LT(found, 1.15 * expected.load) << target << ", element " << e << "\n" << samples[e].x * samples[e].b;
    }
  }
  EXPECT_GT(loaded, samples.size() / 20);
  EXPECT_GT(inverted, samples.size() / 20);
  EXPECT_NEAR(sums.inverted, inverted, 2);  // some are all but flat
  EXPECT_NEAR(static_cast<double>(sums.largest_strain), largest, 1e-4 * largest);
}

TEST(ElementKernel, EqualsTheFormulasForAnyDeformationOnEveryInstructionSet) {
  const std::vector<Sample> samples = random_samples(3001, 1);  // no multiple of the lanes
  ASSERT_FALSE(targets().empty());
  for (const std::string& target : targets()) {
    ASSERT_TRUE(force_simd_target(target));
    EXPECT_EQ(simd_target(), target);
    compare(samples, target);
  }
  force_simd_target({});
}

TEST(ElementKernel, RepeatsToTheBitAndAgreesBetweenInstructionSets) {
  const std::vector<Sample> samples = random_samples(999, 2);
  const std::vector<std::string> names = targets();
  ASSERT_TRUE(force_simd_target(names.front()));
  ElementBlocks blocks = blocks_of(samples);
  const std::vector<NodeVector> first = forces_of(samples, blocks);
  blocks = blocks_of(samples);
  const std::vector<NodeVector> again = forces_of(samples, blocks);
  for (std::size_t n = 0; n < first.size(); ++n) ASSERT_EQ(first[n].xyz0, again[n].xyz0);
  for (const std::string& name : names) {
    ASSERT_TRUE(force_simd_target(name));
    blocks = blocks_of(samples);
    const std::vector<NodeVector> other = forces_of(samples, blocks);
    for (std::size_t n = 0; n < first.size(); ++n) {
      const double scale = plain(samples[n / 4]).scale;
      for (std::size_t r = 0; r < 3; ++r) {
        ASSERT_NEAR(other[n].xyz0[r], first[n].xyz0[r], 1e-6 * 20 * 3 * scale) << names.front() << " and " << name;
      }
    }
  }
  force_simd_target({});
}

TEST(ElementKernel, AnInstructionSetThatTheProcessorLacksIsRefused) {
  const std::string best(simd_target());
  EXPECT_FALSE(force_simd_target("no such set"));
  EXPECT_EQ(simd_target(), best);
  EXPECT_TRUE(force_simd_target({}));
  EXPECT_EQ(simd_target(), best);
}

TEST(ElementKernel, ForcesAreTheSlopeOfTheEnergy) {
  // Elastic part alone, by central differences of the energy in doubles.
  for (Sample s : random_samples(200, 3)) {
    s.viscous_mu = s.viscous_lambda = 0;
    const auto energy = [&](const Eigen::Matrix3d& x) {
      const Eigen::Matrix3d f = x * s.b;
      const double j = f.determinant();
      return 0.5 * s.mu * (std::pow(std::max(j, kLeastJ), -2.0 / 3.0) * f.squaredNorm() - 3.0) +
             0.5 * s.bulk * (j - 1.0) * (j - 1.0);
    };
    const Forces expected = plain(s);
    for (int i = 0; i < 9; ++i) {
      constexpr double kStep = 1e-9;
      Eigen::Matrix3d more = s.x;
      Eigen::Matrix3d less = s.x;
      more(i) += kStep;
      less(i) -= kStep;
      EXPECT_NEAR(-(energy(more) - energy(less)) / (2.0 * kStep), expected.f(i), 1e-3 * expected.scale);
    }
  }
}

}  // namespace
}  // namespace cellmirror::tissue
