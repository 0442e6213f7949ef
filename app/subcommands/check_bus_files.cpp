#include "app/subcommands/check_bus_files.hpp"

#include "drivers/can/canopen/eds.hpp"
#include "drivers/can/dbc/dbc.hpp"

namespace cellmirror::app {

bool is_bus_file(const std::filesystem::path& path) {
  const std::filesystem::path extension = path.extension();
  return extension == ".dbc" || extension == ".eds" || extension == ".dcf";
}

void check_bus_file(const std::filesystem::path& path, Diagnostics& diagnostics) {
  if (path.extension() == ".dbc") {
    static_cast<void>(can::read_dbc(path.string(), diagnostics));
    return;
  }
  // The node's number only fills in $NODEID, so any will do for a check.
  constexpr std::uint8_t kAnyNode = 1;
  static_cast<void>(can::read_eds(path.string(), kAnyNode, diagnostics));
}

}  // namespace cellmirror::app
