// What TissueService is made of, from what the files of a cell say.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/tissue/tissue_objects.hpp"
#include "app/snapshot/tissue_port.hpp"
#include "config/tissue_setup.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/command.hpp"

namespace cellmirror::app {

// Find and read the files that commands name. An error says which file and what is wrong with it; for a missing one
// also the nearest names. Empty: such commands are refused.
struct TissueReaders {
  // Its connections are between objects of the cell.
  std::function<Result<tissue::HyperDescription>(std::string_view name)> hyper;
  // Name and shape; the pose in the tool is the command's.
  std::function<Result<tissue::ClipDefinition>(std::string_view name)> clip;
};

struct TissueParts {
  std::vector<TissueObject> objects;  // in the order of the simulation
  std::string hyper_file;             // whose connections the simulation has from the start; empty: none
  std::size_t connections = 0;
  TissueReaders readers;
  TissuePort* port = nullptr;  // outlives the service; null: nothing is simulated, only settings are kept
};

// `port` may be null. The readers look for files in `home`, which they copy.
[[nodiscard]] TissueParts tissue_parts(const TissueSetup& setup, const KismetHome& home, TissuePort* port);

}  // namespace cellmirror::app
