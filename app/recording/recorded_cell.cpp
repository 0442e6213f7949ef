#include "app/recording/recorded_cell.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostFiles = 10'000;
constexpr std::size_t kMostFolders = 16;
constexpr std::size_t kLongestPart = 255;  // NAME_MAX

Error failed(const std::string& place, std::string_view what) {
  return {fmt::format("{} cannot be {}: {}", printable(place), what, std::strerror(errno)), {}};
}

// The parts of a place below a folder; none where it is not safe.
std::optional<std::vector<std::string>> parts_of(std::string_view place) {
  std::vector<std::string> out;
  for (;;) {
    const std::size_t slash = place.find('/');
    const std::string_view part = place.substr(0, slash);
    const bool is_printable = std::ranges::all_of(part, [](char c) {
      const auto code = static_cast<unsigned char>(c);
      return code >= 0x20 && code != 0x7F && c != '\\';
    });
    if (part.empty() || part == "." || part == ".." || part.size() > kLongestPart || !is_printable) return std::nullopt;
    out.emplace_back(part);
    if (out.size() > kMostFolders + 1) return std::nullopt;
    if (slash == std::string_view::npos) return out;
    place.remove_prefix(slash + 1);
  }
}

// Of this user alone, and empty.
Result<Descriptor> open_private_folder(const fs::path& folder) {
  Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat info{};
  if (!opened.valid() || ::fstat(opened.get(), &info) != 0)
    return std::unexpected(failed(folder.string(), "opened as a folder"));
  if (info.st_uid != ::geteuid() || (info.st_mode & 077U) != 0) {
    return fail(fmt::format("{} is not a folder of this user alone", printable(folder.string())),
                "make one with mktemp -d");
  }
  std::error_code error;
  if (!fs::is_empty(folder, error) || error)
    return fail(fmt::format("{} is not empty", printable(folder.string())), "give an empty folder");
  return opened;
}

Result<void> write_all(const Descriptor& file, std::string_view content, const std::string& place) {
  while (!content.empty()) {
    const ssize_t written = ::write(file.get(), content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return std::unexpected(failed(place, "written"));
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

// Every step from the folder on is a name without a slash, and no link is followed.
Result<void> write_below(const Descriptor& folder, const std::string& place, std::string_view content) {
  const auto parts = parts_of(place);
  if (!parts) {
    return fail(fmt::format("the recording has a file {}, whose name may lead out of a folder", printable(place)),
                "do not trust this recording");
  }
  Descriptor at(::dup(folder.get()));
  for (std::size_t i = 0; i + 1 < parts->size(); ++i) {
    const std::string& part = (*parts)[i];
    if (::mkdirat(at.get(), part.c_str(), 0700) != 0 && errno != EEXIST) return std::unexpected(failed(place, "made"));
    Descriptor next(::openat(at.get(), part.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!next.valid()) return std::unexpected(failed(place, "made"));
    at = std::move(next);
  }
  const Descriptor file(
      ::openat(at.get(), parts->back().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!file.valid()) return std::unexpected(failed(place, "made"));
  return write_all(file, content, place);
}

// Of versions that attached small files only, and did not list them.
RecordedCell cell_without_list(const mcap::Reader& reader) {
  RecordedCell out;
  const std::string name = recorded_cell_path(reader).filename().string();
  if (name.empty()) return out;
  for (const mcap::AttachmentIndex& index : reader.attachments()) out.files[index.name] = index.name;
  if (out.files.contains(name)) out.cell_file = name;
  out.missing.emplace_back("the recording does not list the files of its cell: an older version made it");
  return out;
}

}  // namespace

bool is_below_a_folder(std::string_view place) { return parts_of(place).has_value(); }

std::string gateway_value(const mcap::Reader& reader, std::string_view key) {
  const auto about = reader.metadata(kGatewayName);
  if (!about) return {};
  const auto found = about->values.find(key);
  return found == about->values.end() ? std::string() : found->second;
}

fs::path recorded_cell_path(const mcap::Reader& reader) { return gateway_value(reader, kCellFileKey); }

std::string recorded_cell_remedy(const mcap::Reader& reader) {
  const fs::path recorded = recorded_cell_path(reader);
  if (recorded.empty()) return "name the cell file with --recorded-cell";
  return fmt::format("name the cell file with --recorded-cell; the recorded gateway used {}",
                     printable(recorded.string()));
}

RecordedCell recorded_cell(const mcap::Reader& reader) {
  const auto list = reader.metadata(kCellFilesName);
  if (!list) return cell_without_list(reader);
  RecordedCell out;
  if (const auto root = list->values.find(kCellFileRoot); root != list->values.end()) out.cell_file = root->second;
  const auto is_attached = [&](const std::string& name) {
    return std::ranges::find(reader.attachments(), name, &mcap::AttachmentIndex::name) != reader.attachments().end();
  };
  for (const auto& [key, value] : list->values) {
    if (!key.starts_with(kCellFileListed)) continue;
    const std::string place = key.substr(kCellFileListed.size());
    const bool same = value.starts_with(kSameAs);
    const std::string name = same ? value.substr(kSameAs.size()) : place;
    if (!same && value != kAttached) {
      out.missing.push_back(place + ": " + (value.starts_with(kLeftOut) ? value.substr(kLeftOut.size()) : value));
    } else if (!is_attached(name)) {
      out.missing.push_back(place + ": its attachment is not in the recording");
    } else {
      out.files[place] = name;
    }
  }
  return out;
}

Result<ExtractedCell> extract_cell(const mcap::Reader& reader, const fs::path& folder, std::uint64_t most_bytes) {
  RecordedCell cell = recorded_cell(reader);
  if (!cell.files.contains(cell.cell_file))
    return fail("the recording has no cell file", "name the cell file of the recorded gateway");
  if (cell.files.size() > kMostFiles) return fail(fmt::format("the cell has more than {} files", kMostFiles));
  const auto opened = open_private_folder(folder);
  if (!opened) return std::unexpected(opened.error());
  std::uint64_t total = 0;
  for (const auto& [place, name] : cell.files) {
    const auto content = reader.attachment(name);
    if (!content) {
      cell.missing.push_back(place + ": its attachment is not whole");
      continue;
    }
    total += content->size();
    if (total > most_bytes) return fail(fmt::format("the files of the cell have more than {} bytes", most_bytes));
    if (auto written = write_below(*opened, place, *content); !written) return std::unexpected(written.error());
  }
  return ExtractedCell{folder / cell.cell_file, std::move(cell.missing)};
}

Result<TemporaryFolder> TemporaryFolder::make() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  std::string pattern = ((error ? fs::path("/tmp") : parent) / "cellmirror-cell-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    return fail(fmt::format("{} cannot be made: {}", pattern, std::strerror(errno)),
                "set TMPDIR to a folder that can be written to");
  }
  return TemporaryFolder(pattern);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
}

}  // namespace cellmirror::app
