// What `cellmirror simulate` shows of a result: text for people, a JSON document (docs/simulate.md), a time chart.
#pragma once

#include <string>

#include "app/plot/figure.hpp"
#include "app/simulation/simulation_result.hpp"

namespace cellmirror::app {

[[nodiscard]] std::string simulation_text(const SimulationResult& result);
// One line.
[[nodiscard]] std::string simulation_json(const SimulationResult& result);
// Who moves when, the joints of every robot that moved as shares of their ranges, the smallest distance.
[[nodiscard]] plot::Figure simulation_figure(const SimulationResult& result);

// "finished", "time limit", "stands still".
[[nodiscard]] const char* end_word(SimulationEnd end);

}  // namespace cellmirror::app
