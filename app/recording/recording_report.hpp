// What is in a recording, and whether it is whole: as a table for people and as JSON for programs (docs/recording.md).
// None of it is for the tick.
#pragma once

#include <string>

#include "app/recording_layout/recording_names.hpp"
#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

[[nodiscard]] std::string recording_info_text(const std::string& file, std::uint64_t bytes, const mcap::Reader& reader);
[[nodiscard]] std::string recording_info_json(const std::string& file, std::uint64_t bytes, const mcap::Reader& reader);

// The command that repairs `file`, as a user can enter it.
[[nodiscard]] std::string recover_command(const std::string& file);

struct RecordingCheck {
  mcap::ScanReport scan;
  mcap::Faults summary_faults;  // where the summary differs from what is in the file
  std::uint64_t bytes = 0;

  [[nodiscard]] bool whole() const { return scan.faults.count() == 0 && summary_faults.count() == 0; }
};

// Reads every byte. Fails where the file is no recording at all.
[[nodiscard]] Result<RecordingCheck> check_recording(const mcap::Source& source, const mcap::Limits& limits = {});
[[nodiscard]] std::string recording_check_text(const std::string& file, const RecordingCheck& check);
[[nodiscard]] std::string recording_check_json(const std::string& file, const RecordingCheck& check);

}  // namespace cellmirror::app
