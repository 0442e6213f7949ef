// Makes the folder of a new cell from a request: reads what it names, decides what can be guessed, writes the files,
// and checks the cell as `cellmirror check` does before the folder appears in its place.
#pragma once

#include <string>
#include <vector>

#include "app/new_cell/plan.hpp"
#include "app/new_cell/request.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// What can be said about a request without reading files; the error names the option.
[[nodiscard]] Result<void> check_request(const NewCellRequest& request);

// What the cell will consist of; nothing where there are errors. Reads files, writes none.
[[nodiscard]] std::optional<CellPlan> plan_new_cell(const NewCellRequest& request, Diagnostics& diagnostics);

// Writes the folder of a plan. With any error nothing is left behind and nothing that was there is changed. Warnings of
// the check are in `diagnostics`, with places as they are in the new folder. $kis_home is not looked at.
[[nodiscard]] bool write_new_cell(const NewCellRequest& request, const CellPlan& plan, const LoadProgress& progress,
                                  Diagnostics& diagnostics);

}  // namespace cellmirror::app
