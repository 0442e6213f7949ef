// The time of a millisecond of soft tissue over the number of elements, beside an implicit method on the same
// tetrahedra, and the time of a cut. Processor time of the thread. Writes a table (CSV) and a figure (PNG).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "app/plot/figure.hpp"
#include "rt_core/tissue/body/element_kernel.hpp"
#include "rt_core/tissue/body/lattice.hpp"
#include "tests/bench/tissue/scenes.hpp"

namespace {

using namespace cellmirror;
using tissue_bodies::made;
using tissue_bodies::state_of;

constexpr std::array<double, 9> kElements = {1'000, 2'000, 4'000, 7'000, 10'000, 16'000, 24'000, 35'000, 50'000};
constexpr double kMostImplicit = 16'500;  // beyond it a step takes far longer than it lasts
constexpr int kSteps = 1'000;
constexpr int kWarmUp = 50;
constexpr int kImplicitSteps = 40;
constexpr int kStrokes = 2'000;

struct Times {
  double median_us = 0;
  double p99_us = 0;
};

std::int64_t processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

template <class Work>
Times measure(int count, int warm_up, Work&& work) {
  std::vector<double> us;
  for (int i = 0; i < count + warm_up; ++i) {
    const std::int64_t begun = processor_ns();
    work(i);
    if (i >= warm_up) us.push_back(1e-3 * static_cast<double>(processor_ns() - begun));
  }
  std::ranges::sort(us);
  return {.median_us = us[us.size() / 2], .p99_us = us[us.size() * 99 / 100]};
}

// On the tetrahedra of the lattice, as if all of each were material.
Times measure_implicit(const tissue::ObjectDescription& d, double& iterations) {
  const Result<tissue::RestMesh> mesh = tissue::fill_with_lattice(d.name, d.surface, d.element_size_m);
  if (!mesh) return {};
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  for (const tissue::RestTetrahedron& t : mesh->tetrahedra) tetrahedra.push_back(t.nodes);
  std::vector<std::uint8_t> fixed;
  for (const Eigen::Vector3d& p : mesh->nodes) fixed.push_back(p.z() < d.fixed[0].high.z() ? 1 : 0);
  tissue_bench::Corotational body(mesh->nodes, tetrahedra, d.material, fixed);
  int sum = 0;
  const Times times =
      measure(kImplicitSteps, 10, [&](int) { sum += body.step(tissue::kStep_s, tissue_bench::kGravity); });
  iterations = static_cast<double>(sum) / (kImplicitSteps + 10);
  return times;
}

// Strokes of scissors: a blade of 12 mm advances by 3 mm, anywhere in the body.
Times measure_cuts(tissue::Body& body, double radius) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random);
    const double y = normal(random);
    return Eigen::Vector3d(x, y, normal(random)).normalized();
  };
  std::vector<tissue::BladeSweep> strokes(kStrokes);
  for (tissue::BladeSweep& stroke : strokes) {
    stroke.along = 0.012 * direction();
    stroke.across = 0.003 * direction();
    stroke.corner = 0.6 * radius * direction();
  }
  std::vector<double> us;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (i % 200 == 0) body.reset();
    const std::int64_t begun = processor_ns();
    body.cut(strokes[i]);
    us.push_back(1e-3 * static_cast<double>(processor_ns() - begun));
  }
  std::ranges::sort(us);
  return {.median_us = us[us.size() / 2], .p99_us = us[us.size() * 99 / 100]};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: tissue_steps CSV PNG\n", stderr);
    return 2;
  }
  fmt::print("instruction set {}\n", tissue::simd_target());
  std::string table =
      "elements,nodes,substeps,step_median_us,step_p99_us,implicit_median_us,implicit_p99_us,cut_median_us,cut_p99_"
      "us\n";
  plot::Line median{.label = "explicit, median", .x = {}, .y = {}};
  plot::Line p99{.label = "explicit, p99", .x = {}, .y = {}};
  plot::Line implicit{.label = "implicit, median", .x = {}, .y = {}};
  for (const double elements : kElements) {
    const tissue::ObjectDescription d = tissue_bench::ball_of(elements);
    tissue::Body body = made(d);
    const TissueObjectState figures = state_of(body);
    const int substeps = static_cast<int>(figures.substeps);
    const Times times = measure(kSteps, kWarmUp, [&](int) { tissue_bench::step(body, substeps); });
    const Times cuts = measure_cuts(body, d.surface.vertices[0].norm());
    double iterations = 0;
    const bool compared = figures.elements < kMostImplicit;
    const Times other = compared ? measure_implicit(d, iterations) : Times{};
    const double per_element = 1e3 * times.median_us / figures.elements / substeps;
    fmt::print(
        "{:5} elements, {} substeps: median {:.0f} us, p99 {:.0f} us, {:.1f} ns an element and substep; cut {:.0f} "
        "us, p99 {:.0f} us",
        figures.elements, substeps, times.median_us, times.p99_us, per_element, cuts.median_us, cuts.p99_us);
    if (compared) fmt::print("; implicit {:.0f} us, {:.1f} iterations", other.median_us, iterations);
    fmt::print("\n");
    const std::string others = compared ? fmt::format("{:.1f},{:.1f}", other.median_us, other.p99_us) : ",";
    table += fmt::format("{},{},{},{:.1f},{:.1f},{},{:.1f},{:.1f}\n", figures.elements, figures.nodes, substeps,
                         times.median_us, times.p99_us, others, cuts.median_us, cuts.p99_us);
    const double x = figures.elements;
    median.x.push_back(x);
    median.y.push_back(1e-3 * times.median_us);
    p99.x.push_back(x);
    p99.y.push_back(1e-3 * times.p99_us);
    if (compared) {
      implicit.x.push_back(x);
      implicit.y.push_back(1e-3 * other.median_us);
    }
  }
  plot::Panel panel;
  panel.x = {.label = "elements", .logarithmic = true};
  panel.y = {.label = "time for a millisecond [ms]", .logarithmic = true};
  panel.lines = {median, p99, implicit};
  plot::Figure figure;
  figure.title = "Time for a millisecond of soft tissue over the number of elements";
  figure.subtitle = fmt::format("5 kPa, lattice of 7 mm, one core, {}, processor time", tissue::simd_target());
  figure.panels.push_back(panel);
  figure.columns = 1;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr || std::fputs(table.c_str(), file) < 0 || std::fclose(file) != 0) {
    fmt::print(stderr, "{} cannot be written\n", arguments[1]);
    return 1;
  }
  if (auto written = plot::write_png(figure, arguments[2]); !written) {
    fmt::print(stderr, "{}\n", written.error().text());
    return 1;
  }
  return 0;
}
