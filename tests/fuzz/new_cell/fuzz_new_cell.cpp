// A DBC of any bytes: what `cellmirror new` guesses of it stays within the limits of a robot, and the texts that it
// would write are TOML whatever names and units the DBC has.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "app/new_cell/cell_text.hpp"
#include "app/new_cell/names.hpp"
#include "app/new_cell/signal_source.hpp"
#include "app/new_cell/simulation_text.hpp"
#include "config/table_reader.hpp"
#include "rt_core/base/capacity.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  app::GuessedSignals guessed = app::guess_signals(can::parse_dbc(text, "fuzz.dbc", diagnostics));
  if (guessed.joints > kMaxJointsPerRobot || guessed.others.size() > app::kMostOthers) std::abort();
  for (const app::PlannedSignal& signal : guessed.signals) {
    if (signal.joint >= guessed.joints || !(signal.scale > 0)) std::abort();
  }
  app::CellPlan plan;
  plan.name = "fuzz";
  plan.channel = text.substr(0, 40);
  app::PlannedRobot robot;
  robot.node = "Axes";
  robot.id = "AXES";
  robot.file = "axes.mpc";
  robot.joints = app::made_up_joints(guessed.joints > 0 ? guessed.joints : 1);
  robot.dbc = app::plain_file_name(text.substr(0, 200));
  robot.signals = std::move(guessed.signals);
  robot.other_signals = std::move(guessed.others);
  if (robot.signals.empty()) robot.topic = "/joint_states";
  plan.robots.push_back(robot);
  static_cast<void>(app::readme_text(plan));
  Diagnostics found;
  const std::string file = "cell.toml";
  if (!parse_toml(app::cell_text(plan), file, found) || !parse_toml(app::axes_text(robot), file, found)) std::abort();
  return 0;
}
