// The CiA 402 drives of a new cell: what their EDS or DCF files say about mapping and scale.
#pragma once

#include <vector>

#include "app/new_cell/plan.hpp"
#include "app/new_cell/request.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::app {

// A drive for each node, in their order; `robot` has as many joints. The files that they need are appended.
[[nodiscard]] std::vector<PlannedDrive> read_drive_sources(const NewCellRequest& request, const PlannedRobot& robot,
                                                           std::vector<PlannedFile>& files, Diagnostics& diagnostics);

// The name of a copy in robots/ that no other file has yet; the same for the same source.
[[nodiscard]] std::string add_description(const std::filesystem::path& source, std::vector<PlannedFile>& files);

}  // namespace cellmirror::app
