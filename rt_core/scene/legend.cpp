#include "rt_core/scene/legend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/words.hpp"

namespace cellmirror::scene {

namespace {

bool any_marked(const Scene& scene, Mark mark) {
  const auto has = [mark](const auto& thing) { return thing.mark == mark; };
  return std::ranges::any_of(scene.bodies, has);
}

std::string warning_text(const SceneInput& input) {
  const double warning = input.proximity == nullptr ? 0.0 : input.proximity->warning_distance_m;
  return warning > 0.0 ? "nearer than " + distance_text(warning) : std::string("near");
}

}  // namespace

void write_legend(const SceneInput& input, const ForceArrows& arrows, const TissueMarks& tissue, Scene& scene) {
  if (!input.display->legend || input.display->full_screen) return;
  const auto add = [&](bool there, const Colour& colour, std::string text) {
    if (there) scene.legend.push_back({palette::opaque(colour), std::move(text)});
  };
  add(any_marked(scene, Mark::touching), palette::kTouching, "touching");
  add(any_marked(scene, Mark::near), palette::kNear, warning_text(input));
  add(any_marked(scene, Mark::ghost), palette::kGhost, "old data");
  add(!scene.cones.empty(), palette::kRange, "range sensor");
  const auto beam = [&input](bool interrupted) {
    const auto shown = [interrupted](const BarrierReading& one) {
      return one.placed && one.interrupted == interrupted;
    };
    return std::ranges::any_of(input.barriers, shown);
  };
  add(beam(false), palette::kBeam, "light barrier");
  add(beam(true), palette::kBeamInterrupted, "light barrier, interrupted");
  add(!scene.traces.empty(), palette::kTrace, "trace of the TCP");
  const double force = arrows.newton_per_metre();
  const double torque = arrows.newton_metre_per_metre();
  // For 100 mm of arrow.
  add(force > 0.0, palette::kForce, fmt::format("force, 100 mm = {}", quantity_text(0.1 * force, "N")));
  add(torque > 0.0, palette::kTorque, fmt::format("torque, 100 mm = {}", quantity_text(0.1 * torque, "Nm")));
  if (input.tissue != nullptr) write_network_legend(*input.tissue, tissue, scene);
}

}  // namespace cellmirror::scene
