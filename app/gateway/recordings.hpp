// The recordings of the running gateway: what joins the recorder with the gateway's parts and with the control socket.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/io/can_tap.hpp"
#include "app/io/payload_tap.hpp"
#include "app/live/live_topics.hpp"
#include "app/recorder/recorder.hpp"
#include "app/recorder/recording_hub.hpp"
#include "config/record_settings.hpp"
#include "ipc/control/control_request.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/commands/host.hpp"

namespace cellmirror::app {

class Recordings {
 public:
  struct About {
    std::string instance;
    std::string cell;
    double rate_hz = 0;  // of the loop
    CellFiles files;
    std::string cell_file;  // where it is
  };

  // `clock` outlives it. From now on lines of the log are recorded, where a recording goes on.
  explicit Recordings(const Clock& clock);
  ~Recordings();
  Recordings(const Recordings&) = delete;
  Recordings& operator=(const Recordings&) = delete;

  void describe(About about) { about_ = std::move(about); }
  // The black box of the cell file, in the folder of `place`; where that cannot be written, an error is logged. After
  // describe().
  void begin_ring(const RecordSettings& settings, const Result<std::filesystem::path>& place);
  // RECORD.
  Result<void> switch_ring(RecordAction action);
  void fault() {
    if (settings_.keep_on_fault) static_cast<void>(hub_.keep_ring());
  }
  // What is recorded from now on; the sources live until stop().
  void watch(Recorder::Sources sources);
  // No source is looked at any more; what was recorded is written by and by.
  void stop();

  // One JSON document for {"request":"record", ...}: docs/recording.md.
  [[nodiscard]] std::string answer(const ControlRequest& request);
  void command(const CommandRecord& record) { texts_.command(record); }
  void switch_changed(const FootSwitchChange& change) { texts_.switch_changed(change); }
  [[nodiscard]] RecordingHub& hub() { return hub_; }
  // What clients watch; lives as long as this.
  [[nodiscard]] LiveTopics& live() { return *live_; }
  [[nodiscard]] CanTap& can_tap() { return can_tap_; }
  [[nodiscard]] PayloadTap& payload_tap() { return payload_tap_; }
  [[nodiscard]] const RecordingHub& hub() const { return hub_; }

 private:
  [[nodiscard]] Result<RecordingOptions> options_of(const ControlRequest& request) const;
  void fill_about(RecordingOptions& options) const;

  About about_;
  RecordSettings settings_;
  std::shared_ptr<LiveTopics> live_ = std::make_shared<LiveTopics>();
  RecordingHub hub_;
  RecordedTexts texts_;
  CanTap can_tap_;
  PayloadTap payload_tap_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace cellmirror::app
