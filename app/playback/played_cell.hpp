// The cell of a recording, from the files that are attached to it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// Of the user alone (0700); removed with all that is in it.
class PrivateFolder {
 public:
  // In the folder for temporary files.
  [[nodiscard]] static Result<PrivateFolder> make();
  PrivateFolder(PrivateFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  PrivateFolder& operator=(PrivateFolder&&) = delete;
  ~PrivateFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit PrivateFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

inline constexpr std::size_t kMostCellFiles = 10'000;
inline constexpr std::uint64_t kMostCellBytes = std::uint64_t{1} << 30;

// Whether the name of an attachment stays below the folder that it is written to: relative, no "..", no control
// characters, of bounded length.
[[nodiscard]] bool is_place_below(std::string_view name);
// Writes the attached files below `folder`, which is empty; gives the path of the cell file. Fails where there is none,
// where a name would leave the folder, and where they are too many or too large.
[[nodiscard]] Result<std::filesystem::path> write_cell(const mcap::Reader& reader, const std::filesystem::path& folder);
// Where the cell file was when it was recorded; empty: the recording does not say it.
[[nodiscard]] std::filesystem::path recorded_cell_file(const mcap::Reader& reader);

}  // namespace cellmirror::app
