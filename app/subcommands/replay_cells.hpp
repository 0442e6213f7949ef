// replay --cell: the recorded joint states in another cell.
#pragma once

#include <string>

#include "ipc/record/reader.hpp"

namespace cellmirror::app {

struct ReplayCells {
  std::string other;
  std::string recorded;  // empty: where the recording says that it was
  bool json = false;
};

// Prints the report; gives the exit status.
int compare_cells(mcap::Reader& reader, const mcap::Filter& filter, const ReplayCells& cells);

}  // namespace cellmirror::app
