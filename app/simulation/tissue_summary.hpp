// Deformable objects in what `cellmirror simulate` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/simulation/simulation_result.hpp"

namespace cellmirror::app {

// The key `tissue` of docs/simulate.md; null where the cell has no deformable objects.
[[nodiscard]] nlohmann::json tissue_json(const SimulationResult& result);
// Empty where the cell has none.
[[nodiscard]] std::string tissue_text(const SimulationResult& result);

}  // namespace cellmirror::app
