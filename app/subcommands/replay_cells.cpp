#include "app/subcommands/replay_cells.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "app/console/put.hpp"
#include "app/proximity/cell_comparison.hpp"
#include "app/recording/recorded_cell.hpp"
#include "app/recording/recording_export.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "app/subcommands/subcommand.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

namespace fs = std::filesystem;

// Removed with it. Of the user alone (0600).
class TemporaryFile {
 public:
  TemporaryFile() : path_((fs::temp_directory_path() / "cellmirror-postures-XXXXXX").string()) {
    const int made = ::mkstemp(path_.data());
    file_ = made < 0 ? nullptr : ::fdopen(made, "w");
  }
  ~TemporaryFile() {
    close();
    std::remove(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] std::FILE* file() { return file_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  // False where not all of it could be written.
  bool close() { return file_ == nullptr || std::fclose(std::exchange(file_, nullptr)) == 0; }

 private:
  std::string path_;
  std::FILE* file_ = nullptr;
};

// Attached files that are others in the folder of the cell now, or are no longer there.
std::vector<std::string> changed_files(const mcap::Reader& reader, const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& [place, attachment] : recorded_cell(reader).files) {
    const auto recorded = reader.attachment(attachment);
    if (!recorded || !is_below_a_folder(place)) continue;
    std::ostringstream now;
    now << std::ifstream(folder / place, std::ios::binary).rdbuf();
    if (now.view() != *recorded) out.push_back(printable(place));
  }
  return out;
}

// Returns the file that the operator names, else the cell file extracted from the recording into `folder`. Never opens
// a path from the recording: its author could make this process read any file.
Result<std::string> find_recorded_cell(const mcap::Reader& reader, const ReplayCells& cells,
                                       std::optional<TemporaryFolder>& folder) {
  if (!cells.recorded.empty()) return cells.recorded;
  auto made = TemporaryFolder::make();
  if (!made) return std::unexpected(made.error());
  folder.emplace(*std::move(made));
  const auto extracted = extract_cell(reader, folder->path());
  if (!extracted) {
    return fail(fmt::format("the cell in the recording cannot be used: {}", extracted.error().text()),
                recorded_cell_remedy(reader));
  }
  for (const std::string& one : extracted->missing)
    put(stderr, "cellmirror: not in the recording: {}\n", printable(one));
  return extracted->cell_file.string();
}

// Seconds after the start of the recording, of the last `count` messages of joint states.
std::vector<double> times_of(mcap::Reader& reader, const mcap::Filter& filter, std::uint64_t count) {
  std::vector<double> out;
  const std::uint64_t start = reader.statistics().start_time;
  static_cast<void>(reader.read(filter, [&](const mcap::Message& message, const mcap::Channel& /*channel*/) {
    out.push_back(1e-9 * static_cast<double>(message.log_time - std::min(start, message.log_time)));
    return true;
  }));
  if (out.size() > count) out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(count));
  return out;
}

}  // namespace

int compare_cells(mcap::Reader& reader, const mcap::Filter& filter, const ReplayCells& cells) {
  std::optional<TemporaryFolder> folder;
  const auto file = find_recorded_cell(reader, cells, folder);
  if (!file) return refuse(file.error().text());
  TemporaryFile postures;
  if (postures.file() == nullptr) return refuse(postures.path() + " cannot be written; set TMPDIR to another folder");
  const auto rows = export_postures(reader, std::string(kJointsTopic), filter, postures.file());
  if (!rows) return refuse(rows.error().text());
  if (!postures.close()) return refuse(postures.path() + " cannot be written; set TMPDIR to another folder");
  if (rows->messages == 0) return refuse("the recording has no joint states in this time");
  mcap::Filter of_joints = filter;
  of_joints.topics = {std::string(kJointsTopic)};
  const std::vector<double> times = times_of(reader, of_joints, rows->messages);
  const std::vector<std::string> changed = changed_files(reader, fs::path(*file).parent_path());
  const auto before_cell = load_proximity_cell(*file);
  const auto after_cell = before_cell ? load_proximity_cell(cells.other) : std::nullopt;
  if (!after_cell) return kExitRefused;
  const auto before = over_postures(*before_cell, postures.path());
  const auto after = before ? over_postures(*after_cell, postures.path()) : std::nullopt;
  if (!after) return kExitRefused;
  if (!cells.json) {
    for (const std::string& name : changed)
      put(stderr, "cellmirror: {} of the recorded cell was changed since, or is gone\n", name);
  }
  put(stdout, "{}{}",
      cells.json ? comparison_json(*before, *after, times, changed) : comparison_text(*before, *after, times),
      cells.json ? "\n" : "");
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? kExitDone : refuse("standard output cannot be written");
}

}  // namespace cellmirror::app
