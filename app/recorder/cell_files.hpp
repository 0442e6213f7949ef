// The files of a cell as attachments of a recording, so that it can be replayed where the cell folder is not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/record/layout.hpp"
#include "ipc/record/writer.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct CellFile {
  std::string place;           // below the cell folder: the attachment's name
  std::filesystem::path path;  // where it is
  std::uint64_t bytes = 0;     // when the cell was loaded, as the next one
  std::filesystem::file_time_type changed;
};

struct CellFiles {
  std::vector<CellFile> files;  // the cell file first
  mcap::Texts left_out = {};    // by path: why it is not among them
};

// `files` of the cell whose folder is `root`; the first is the cell file, which may be elsewhere. Other files outside
// the folder are left out.
[[nodiscard]] CellFiles cell_files(const std::filesystem::path& root, const std::vector<std::filesystem::path>& files);

// Attaches them, each content once, and writes the metadata kCellFilesName: which are there, and which are not and why.
// Left out: what makes more than `most_bytes` together, and what was changed since the cell was loaded. `wall_ns`: UTC.
// Gives the files that are left out ("PLACE: why").
[[nodiscard]] Result<std::vector<std::string>> attach_cell_files(mcap::Writer& writer, const CellFiles& cell,
                                                                 std::uint64_t most_bytes, std::uint64_t wall_ns);

}  // namespace cellmirror::app
