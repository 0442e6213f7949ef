// The running gateway: everything joined. Only app/ knows all of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "config/cell_file.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {
class ForceGuard;
}

namespace cellmirror::app {

class PlayedRecording;

struct GatewayOptions {
  std::filesystem::path cell_file;
  std::optional<std::string> startup_script;  // instead of the cell file's own
  std::filesystem::path state;                // folder of what is written; empty: the cell folder
  std::optional<double> rate_hz;              // instead of the cell file's own
  std::string instance = "default";
  bool headless = false;        // no pictures
  bool web = true;              // the monitor page
  std::optional<int> port;      // of the monitor page, instead of the cell file's; 0: a free one
  std::function<void()> bell;   // rings with messages while BEEP is on (SET_MODE); may be empty
  ForceGuard* guard = nullptr;  // of the shared memories; outlives the gateway; null: none
  LoadProgress progress;        // told while the cell is loaded; may be empty
  // Takes the place of the loop and of all devices: nothing is opened but the control socket and the monitor page.
  // Outlives the gateway; null: a gateway of real robots.
  PlayedRecording* playback = nullptr;
  bool publish = false;  // of a recording that is played: SENSOR records and DDS as well
  // True if the cell file came with a recording. Its network settings are ignored, so that a recording cannot connect
  // the gateway to other machines.
  bool foreign_cell = false;
};

class Gateway {
 public:
  // Loads the cell, takes the instance and its queues, starts all threads. Nothing is left behind where it fails.
  static Result<std::unique_ptr<Gateway>> start(const GatewayOptions& options);
  // Stops all threads in the reverse order and removes queues and sockets.
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  // One line for the person who started it: cell, robots, rate, keys.
  [[nodiscard]] std::string greeting() const;
  // Periods that the loop has run. Any thread.
  [[nodiscard]] std::uint64_t ticks() const;

 private:
  struct Parts;
  explicit Gateway(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace cellmirror::app
