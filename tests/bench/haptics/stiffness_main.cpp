// The largest stiffness of a virtual wall that a simulated hand bears, with and without the passivity controller, over
// the hand's damping and mass. Stable: in a press of 10 mm for three seconds no more than 3 mJ were generated, and no
// fault. Writes a table (CSV) and a figure (PNG).
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "app/plot/figure.hpp"
#include "hand.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::haptics;

constexpr double kBound = 3e-3;             // J
constexpr double kLargestTried = 10'000.0;  // N/m
constexpr double kStep = 250.0;             // N/m

bool stable(double stiffness, const test_rig::HandParameters& hand, bool control) {
  HapticSettings settings;
  settings.stiffness = stiffness;
  settings.passivity_control = control;
  const test_rig::HandRun run = test_rig::press_wall(settings, hand, 0.01, 3.0);
  return run.least_energy > -kBound && !run.faulted;
}

// Upwards from below, so that a lucky stiffness above an unstable one does not count.
double largest_stable(const test_rig::HandParameters& hand, bool control) {
  double largest = 0;
  for (double stiffness = kStep; stiffness <= kLargestTried && stable(stiffness, hand, control); stiffness += kStep) {
    largest = stiffness;
  }
  return largest;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: haptics_stiffness CSV PNG\n", stderr);
    return 2;
  }
  std::string table = "mass_kg,damping_n_s_m,controller,largest_stable_stiffness_n_m\n";
  plot::Figure figure;
  figure.title = "Largest stable stiffness of a virtual wall at 1 kHz";
  figure.subtitle = fmt::format("one sample of delay, encoder 20 um; up to {:.0f} N/m tried", kLargestTried);
  for (const double mass : {0.05, 0.1, 0.2, 0.5}) {
    plot::Panel panel;
    panel.title = fmt::format("hand and device: {} kg", mass);
    panel.x.label = "damping of the hand [Ns/m]";
    panel.y = {.label = "stiffness [N/m]", .low = 0, .high = kLargestTried * 1.05};
    for (const bool control : {false, true}) {
      plot::Line line;
      line.label = control ? "with passivity controller" : "without";
      for (const double damping : {0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0}) {
        const double largest = largest_stable({.mass = mass, .damping = damping}, control);
        line.x.push_back(damping);
        line.y.push_back(largest);
        table += fmt::format("{},{},{},{}\n", mass, damping, control ? "on" : "off", largest);
      }
      panel.lines.push_back(line);
    }
    figure.panels.push_back(panel);
  }
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
