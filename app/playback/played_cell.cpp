#include "app/playback/played_cell.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "app/recording/recording_names.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLongestPlace = 1024;

}  // namespace

Result<PrivateFolder> PrivateFolder::make() {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "cellmirror-replay-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr)
    return fail(fmt::format("no folder {} can be made for the recorded cell", name), "set TMPDIR to another folder");
  return PrivateFolder(name);
}

PrivateFolder::~PrivateFolder() {
  if (path_.empty()) return;
  std::error_code error;
  fs::remove_all(path_, error);
}

bool is_place_below(std::string_view name) {
  if (name.empty() || name.size() > kLongestPlace) return false;
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '\\'; }))
    return false;
  const fs::path place(name);
  return place.is_relative() && place.has_filename() &&
         std::ranges::none_of(place, [](const fs::path& part) { return part == ".." || part == "."; });
}

fs::path recorded_cell_file(const mcap::Reader& reader) {
  const auto about = reader.metadata(kGatewayName);
  if (!about) return {};
  const auto file = about->values.find(kCellFileKey);
  return file == about->values.end() ? fs::path() : fs::path(file->second);
}

Result<fs::path> write_cell(const mcap::Reader& reader, const fs::path& folder) {
  const std::string cell = recorded_cell_file(reader).filename().string();
  if (reader.attachments().size() > kMostCellFiles)
    return fail(fmt::format("more than {} files are attached to the recording", kMostCellFiles));
  fs::path found;
  std::uint64_t total = 0;
  for (const mcap::AttachmentIndex& index : reader.attachments()) {
    if (!is_place_below(index.name))
      return fail(fmt::format("the attached file {} would not be below the folder of the cell", printable(index.name)));
    const auto content = reader.attachment(index.name);
    if (!content) return fail(fmt::format("the attached file {} cannot be read", printable(index.name)));
    total += content->size();
    if (total > kMostCellBytes) return fail("the files that are attached to the recording are too large");
    const fs::path path = folder / index.name;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(content->data(), static_cast<std::streamsize>(content->size()));
    out.close();
    if (!out) return fail(fmt::format("{} cannot be written", path.string()));
    if (index.name == cell) found = path;
  }
  if (found.empty()) return fail("the recording has no cell file among its attachments");
  return found;
}

}  // namespace cellmirror::app
