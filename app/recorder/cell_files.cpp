#include "app/recorder/cell_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

std::string_view media_type_of(const std::string& place) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kTypes{{
      {".toml", "application/toml"},
      {".mpc", "application/toml"},
      {".urdf", "application/xml"},
      {".stl", "model/stl"},
      {".obj", "model/obj"},
      {".dae", "model/vnd.collada+xml"},
      {".gltf", "model/gltf+json"},
      {".glb", "model/gltf-binary"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
  }};
  const std::string extension = lower_case(fs::path(place).extension().string());
  const auto* const found =
      std::ranges::find(kTypes, std::string_view(extension), &std::pair<std::string_view, std::string_view>::first);
  return found == kTypes.end() ? std::string_view("application/octet-stream") : found->second;
}

// Contents that are attached already, by size and checksum.
class Attached {
 public:
  // The place of a file with this content; null: there is none yet, and `file` is it from now on.
  const CellFile* same_as(const CellFile& file, const std::string& content) {
    auto& candidates = by_sum_[{content.size(), mcap::crc32(mcap::view_of(content))}];
    for (const CellFile* other : candidates) {
      const auto read = read_text_file(other->path, content.size());
      if (read && *read == content) return other;
    }
    candidates.push_back(&file);
    return nullptr;
  }

 private:
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::vector<const CellFile*>> by_sum_;
};

// Nothing where it is no longer as it was when the cell was loaded.
std::optional<std::string> unchanged_content(const CellFile& file) {
  std::error_code error;
  if (fs::last_write_time(file.path, error) != file.changed || error) return std::nullopt;
  auto content = read_text_file(file.path, file.bytes);
  if (!content || content->size() != file.bytes) return std::nullopt;
  return *std::move(content);
}

}  // namespace

CellFiles cell_files(const fs::path& root, const std::vector<fs::path>& files) {
  CellFiles out;
  std::set<fs::path> seen;
  std::error_code error;
  const fs::path home = fs::weakly_canonical(root, error);
  for (const fs::path& named : files) {
    CellFile file;
    file.path = fs::weakly_canonical(named, error);
    if (error || !seen.insert(file.path).second) continue;
    const fs::path place = file.path.lexically_relative(home);
    const bool below = !place.empty() && *place.begin() != ".." && !place.is_absolute();
    file.place = below ? place.generic_string() : file.path.filename().string();
    if (!below && !out.files.empty()) {
      out.left_out[file.path.string()] = "it is outside the cell folder";
      continue;
    }
    file.bytes = fs::file_size(file.path, error);
    if (!error) file.changed = fs::last_write_time(file.path, error);
    if (error) {
      out.left_out[file.place] = error.message();
      continue;
    }
    // A cell file from elsewhere has the name of another one.
    if (std::ranges::find(out.files, file.place, &CellFile::place) != out.files.end()) continue;
    out.files.push_back(std::move(file));
  }
  return out;
}

Result<std::vector<std::string>> attach_cell_files(mcap::Writer& writer, const CellFiles& cell,
                                                   std::uint64_t most_bytes, std::uint64_t wall_ns) {
  mcap::Texts list;
  std::vector<std::string> left_out;
  const auto leave_out = [&](const std::string& place, const std::string& why) {
    list[std::string(kCellFileListed) + place] = std::string(kLeftOut) + why;
    left_out.push_back(place + ": " + why);
  };
  if (!cell.files.empty()) list[std::string(kCellFileRoot)] = cell.files.front().place;
  Attached attached;
  std::uint64_t total = 0;
  for (const CellFile& file : cell.files) {
    if (file.bytes > most_bytes - std::min(total, most_bytes)) {
      leave_out(file.place,
                fmt::format("{:.1f} MB, and at most {:.1f} MB are attached", 1e-6 * static_cast<double>(file.bytes),
                            1e-6 * static_cast<double>(most_bytes)));
      continue;
    }
    const auto content = unchanged_content(file);
    if (!content) {
      leave_out(file.place, "it was changed since the cell was loaded");
      continue;
    }
    if (const CellFile* same = attached.same_as(file, *content)) {
      list[std::string(kCellFileListed) + file.place] = std::string(kSameAs) + same->place;
      continue;
    }
    const auto written =
        writer.put({wall_ns, wall_ns, file.place, std::string(media_type_of(file.place)), mcap::view_of(*content)});
    if (!written) return std::unexpected(written.error());
    total += file.bytes;
    list[std::string(kCellFileListed) + file.place] = kAttached;
  }
  for (const auto& [path, why] : cell.left_out) leave_out(path, why);
  if (list.empty()) return left_out;
  const auto written = writer.put(mcap::Metadata{std::string(kCellFilesName), std::move(list)});
  if (!written) return std::unexpected(written.error());
  return left_out;
}

}  // namespace cellmirror::app
