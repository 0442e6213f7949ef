// Plays a candump log file as if it came from a bus.
#pragma once

#include <memory>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

struct LogChannelOptions {
  std::string file;
  bool as_fast_as_possible = false;  // ignores the stamps; else the first frame comes at once and the others by theirs
  bool repeat = false;               // from the start again, for ever
};

// Fails if the file cannot be read or its first lines show another log format (log_format.hpp). Other lines that are
// not frames are counted as malformed and reported with file:line; send() is refused. All interfaces of the log are
// played as one bus.
[[nodiscard]] Result<std::unique_ptr<CanChannel>> open_log_channel(const LogChannelOptions& options);

}  // namespace cellmirror::can
