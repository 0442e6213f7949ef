// The cell folder (the manual's KISMET home): the only folder whose files may be named in cell files and SCRIPT.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror {

class KismetHome {
 public:
  // `root` is the cell's folder, or $kis_home where that is set. Fails where it is no readable folder.
  static Result<KismetHome> open(const std::filesystem::path& root);
  // The cell folder of the cell file at `cell_file`: $kis_home if set, else the file's own folder.
  static Result<KismetHome> of_cell(const std::filesystem::path& cell_file);

  // The same cell folder, but what is written goes into `state`, in folders of the same names, and files there go
  // before those of the cell folder, which may then be read-only. Makes `state` where missing.
  [[nodiscard]] Result<KismetHome> with_state(const std::filesystem::path& state) const;

  // The regular, readable file `name` in `folder` ("scripts", "envlib", "robots", "" for the home itself), with
  // `extension` (".spt") added if the name has none and no file without it exists. Refused: absolute names, names that
  // leave the cell folder (also through links), folders, missing and unreadable files; the message gives the reason,
  // and the nearest names for missing files.
  [[nodiscard]] Result<std::filesystem::path> file(std::string_view folder, std::string_view name,
                                                   std::string_view extension = {}) const;
  // The same, but folders are found too: for what may be a folder of files.
  [[nodiscard]] Result<std::filesystem::path> file_or_folder(std::string_view folder, std::string_view name) const;
  // Something of that name is there, and is no folder.
  [[nodiscard]] bool has(std::string_view folder, std::string_view name) const;
  // "did you mean a or b?" of the files in `folder` with one of `extensions` (none given: with any), or empty if none
  // is near. Examines at most 512 entries.
  [[nodiscard]] std::string nearest_files(std::string_view folder, std::string_view name,
                                          std::span<const std::string_view> extensions) const;
  // A path for a file that will be written; the same rules, but the file need not exist. Makes `folder` where missing.
  [[nodiscard]] Result<std::filesystem::path> file_to_write(std::string_view folder, std::string_view name) const;

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  // How a file of this home is named to people: relative to the folder that it is in.
  [[nodiscard]] std::string shown_name(const std::filesystem::path& file) const;

 private:
  [[nodiscard]] const std::filesystem::path& root_of(std::string_view folder, std::string_view name,
                                                     std::string_view extension) const;
  [[nodiscard]] Result<std::filesystem::path> find(std::string_view folder, std::string_view name,
                                                   std::string_view extension, bool folders) const;
  explicit KismetHome(std::filesystem::path root) : root_(std::move(root)) {}
  std::filesystem::path root_;   // canonical
  std::filesystem::path state_;  // canonical; empty: root_ is written to
};

// The whole content of a regular file, at most `limit` bytes; larger, missing, unreadable and other kinds are refused.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t limit);

}  // namespace cellmirror
