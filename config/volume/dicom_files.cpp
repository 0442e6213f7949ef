#include "config/volume/dicom_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "config/volume/voxel_stream.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFirstBytes = std::size_t{32} << 10U;  // where heads of slices end, usually

// What was left out, with the first name of each kind.
class LeftOut {
 public:
  void add(const char* why, const std::string& name) {
    auto& [count, first] = kinds_[why];
    if (count++ == 0) first = name;
  }
  void report(Diagnostics& diagnostics) const {
    for (const auto& [why, kind] : kinds_) {
      const auto& [count, first] = kind;
      diagnostics.warning({}, count == 1 ? fmt::format("{} is not read: {}", first, why)
                                         : fmt::format("{} and {} more are not read: {}", first, count - 1, why));
    }
  }

 private:
  std::map<std::string, std::pair<std::size_t, std::string>> kinds_;
};

// False, with an error, where the folder cannot be listed or is too large.
bool list_folder(const fs::path& folder, std::vector<SliceFile>& files, LeftOut& left_out, Diagnostics& diagnostics) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  std::size_t seen = 0;
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    if (++seen > kMostFolderFiles) {
      diagnostics.error({}, fmt::format("the folder has more than {} entries", kMostFolderFiles),
                        "put the series into a folder of its own");
      return false;
    }
    std::error_code ignored;
    const fs::path& path = entries->path();
    const std::string raw = path.filename().string();
    const std::string name = printable(raw);
    if (raw.starts_with('.')) continue;
    if (entries->is_symlink(ignored)) {
      left_out.add("links are not followed", name);
    } else if (entries->is_directory(ignored)) {
      left_out.add("it is a folder", name);
    } else if (!entries->is_regular_file(ignored)) {
      left_out.add("it is no regular file", name);
    } else if (equal_ignoring_case(raw, "DICOMDIR")) {
      left_out.add("a DICOMDIR is not needed, and the files that it names are not opened", name);
    } else {
      files.push_back({path, name, {}});
    }
  }
  if (error) {
    diagnostics.error({}, fmt::format("the folder cannot be read: {}", error.message()));
    return false;
  }
  std::ranges::sort(files, {}, &SliceFile::path);
  return true;
}

// `first_bytes`: as many are tried first. None once a head was longer: those of a series are alike, and GDCM does not
// read a part of a head safely.
Result<SliceHeadRead> read_head(const SliceFile& file, VolumeProcess& process, std::size_t& first_bytes) {
  if (first_bytes > 0) {
    const auto first = read_part_of_file(file.path, 0, first_bytes);
    if (!first) return std::unexpected(first.error());
    const bool is_whole = first->size() < first_bytes;
    auto head = process.head(*first, is_whole);
    if (is_whole || (head && head->kind != SliceAnswerKind::incomplete)) return head;
    first_bytes = 0;
  }
  const auto all = read_part_of_file(file.path, 0, kLargestSliceFile + 1);
  if (!all) return std::unexpected(all.error());
  if (all->size() > kLargestSliceFile)
    return fail(fmt::format("the file has more than {} MiB", kLargestSliceFile >> 20U), "export single-frame files");
  return process.head(*all, true);
}

bool is_localizer(const SliceHead& head) {
  return head.image_type.find("LOCALIZER") != std::string::npos || head.image_type.find("SCOUT") != std::string::npos;
}

// Those that are images, in place.
bool read_heads(std::vector<SliceFile>& files, VolumeProcess& process, LeftOut& left_out, Diagnostics& diagnostics) {
  std::vector<SliceFile> kept;
  constexpr std::size_t kMostUnread = 3;
  std::size_t unread = 0;
  std::size_t first_bytes = kFirstBytes;
  for (SliceFile& file : files) {
    auto read = read_head(file, process, first_bytes);
    if (!read) {
      if (++unread <= kMostUnread)
        diagnostics.error({}, fmt::format("{}: {}", file.name, read.error().what), read.error().remedy);
      // Each may have cost the time of a process that had to be ended.
      if (unread > kMostUnread) break;
    } else if (read->kind != SliceAnswerKind::head) {
      left_out.add("it is no DICOM file", file.name);
    } else if (read->head.rows == 0 || read->head.columns == 0) {
      left_out.add("it has no image", file.name);
    } else if (is_localizer(read->head)) {
      left_out.add("it is a localizer", file.name);
    } else {
      file.head = std::move(read->head);
      kept.push_back(std::move(file));
    }
  }
  files = std::move(kept);
  if (unread > kMostUnread) diagnostics.error({}, "and more files that cannot be read");
  return unread == 0;
}

using SeriesCounts = std::map<std::string, std::pair<std::size_t, const SliceFile*>>;

void refuse_several(const SeriesCounts& all, Diagnostics& diagnostics) {
  constexpr std::size_t kMostShown = 8;
  std::size_t shown = 0;
  std::string list;
  for (const auto& [uid, counted] : all) {
    if (++shown > kMostShown) break;
    list += fmt::format("{}{} ({}, {} files, the first is {})", shown == 1 ? "" : ", ", printable(uid),
                        printable(counted.second->head.description), counted.first, counted.second->name);
  }
  if (all.size() > kMostShown) list += fmt::format(" and {} more", all.size() - kMostShown);
  diagnostics.error({}, fmt::format("the folder has {} series: {}", all.size(), list),
                    "name one with series = \"UID\", or put it into a folder of its own");
}

// Patients are not named: messages reach logs.
bool check_patients(const std::vector<SliceFile>& files, Diagnostics& diagnostics) {
  const auto other = std::ranges::find_if(
      files, [&](const SliceFile& file) { return file.head.patient != files.front().head.patient; });
  if (other == files.end()) return true;
  diagnostics.error({}, fmt::format("{} and {} are of different patients", files.front().name, other->name),
                    "keep the slices of one patient in the folder");
  return false;
}

// A copy of a file under another name.
void drop_copies(std::vector<SliceFile>& files, LeftOut& left_out) {
  std::map<std::string, std::string> known;
  std::erase_if(files, [&](const SliceFile& file) {
    if (file.head.instance.empty() || known.emplace(file.head.instance, file.name).second) return false;
    left_out.add("it is a copy of another one (the same SOP instance UID)", file.name);
    return true;
  });
}

}  // namespace

std::vector<SliceFile> find_series(const fs::path& folder, const std::string& series, VolumeProcess& process,
                                   Diagnostics& diagnostics) {
  std::vector<SliceFile> files;
  LeftOut left_out;
  if (!list_folder(folder, files, left_out, diagnostics)) return {};
  const bool all_read = read_heads(files, process, left_out, diagnostics);
  SeriesCounts counts;
  for (const SliceFile& file : files) {
    auto& [count, first] = counts[file.head.series];
    if (count++ == 0) first = &file;
  }
  if (counts.empty()) {
    left_out.report(diagnostics);
    if (all_read)
      diagnostics.error({}, "the folder has no DICOM images", "name the folder that holds the slices themselves");
    return {};
  }
  if (series.empty() && counts.size() > 1) {
    refuse_several(counts, diagnostics);
    return {};
  }
  if (!series.empty() && !counts.contains(series)) {
    refuse_several(counts, diagnostics);
    diagnostics.error({}, fmt::format("the folder has no series {}", printable(series)));
    return {};
  }
  if (!series.empty()) std::erase_if(files, [&](const SliceFile& file) { return file.head.series != series; });
  drop_copies(files, left_out);
  left_out.report(diagnostics);
  if (!all_read || !check_patients(files, diagnostics)) return {};
  return files;
}

}  // namespace cellmirror
