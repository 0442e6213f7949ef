// cellmirror replay F.mcap: a gateway that the recording drives.
#pragma once

#include <optional>
#include <string>

#include "ipc/record/record_stream.hpp"

namespace cellmirror::app {

struct ReplayGateway {
  std::string file;
  std::string recorded_cell;  // empty: that of the recording
  std::string instance = "replay";
  double from_s = 0;
  std::optional<double> to_s;
  double speed = 1;
  bool paused = false;
  bool page = false;
  bool wait = false;  // at the end, for a signal
  bool publish = false;
  bool headless = false;
  std::optional<int> port;
  mcap::Limits limits;  // of the recording

  [[nodiscard]] bool with_page() const { return page || port; }
};

// Its exit status. Until the end of the recording, or a signal.
int play_recording(const ReplayGateway& options);

}  // namespace cellmirror::app
