// The cell in a recording: which of its files are attached, and their extraction into a folder. From any bytes. Not for
// the tick.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct RecordedCell {
  std::string cell_file;                     // its place in the cell folder; empty: the recording has no cell
  std::map<std::string, std::string> files;  // by place: the attachment that has its content
  std::vector<std::string> missing;          // "PLACE: why"

  [[nodiscard]] bool complete() const { return !cell_file.empty() && missing.empty(); }
};

// From the metadata; of a recording without these (by an older version) the attachments as they are.
[[nodiscard]] RecordedCell recorded_cell(const mcap::Reader& reader);

// Whether the name of a file stays below a folder that it is written to or read from: relative, printable, no "..".
[[nodiscard]] bool is_below_a_folder(std::string_view place);
// What the recording says about its gateway (kGatewayName); empty: nothing.
[[nodiscard]] std::string gateway_value(const mcap::Reader& reader, std::string_view key);
// Where the cell file was when it was recorded; empty: the recording does not say.
[[nodiscard]] std::filesystem::path recorded_cell_path(const mcap::Reader& reader);

// Remedy that names the option for the cell file and the recorded path. The path is untrusted: for display only.
[[nodiscard]] std::string recorded_cell_remedy(const mcap::Reader& reader);

struct ExtractedCell {
  std::filesystem::path cell_file;
  std::vector<std::string> missing;  // as above
};

// Writes the attached files of the cell into `folder`: an existing, empty folder of this user that nobody else may
// enter (mode 0700), and no link. Files get mode 0600, folders 0700. Refused as a whole: names that are absolute, that
// have "..", a character that is not printable or more than 16 folders; more than `most_bytes` or 10,000 files
// together. After an error the folder may have some of the files. Mind $kis_home where the cell is loaded: it goes
// before the folder.
[[nodiscard]] Result<ExtractedCell> extract_cell(const mcap::Reader& reader, const std::filesystem::path& folder,
                                                 std::uint64_t most_bytes = std::uint64_t{2} << 30);

// A new folder of this user alone (mode 0700) below the one for temporary files ($TMPDIR, /tmp); removed with it.
class TemporaryFolder {
 public:
  [[nodiscard]] static Result<TemporaryFolder> make();
  ~TemporaryFolder();
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace cellmirror::app
