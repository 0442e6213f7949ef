#include "config/volume_file.hpp"

#include <fmt/format.h>

#include <system_error>
#include <tuple>
#include <utility>

#include "config/tables_file.hpp"
#include "config/volume/data_files.hpp"
#include "config/volume/dicom_series.hpp"
#include "config/volume/nrrd_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

constexpr Range kSlope{-1e6, 1e6};
constexpr Range kSpacingMm{kLeastSpacing * 1e3, kMostSpacing * 1e3};
constexpr long long kMostHeaderBytes = 1LL << 40;
constexpr long long kMostFileNumber = 1'000'000;

void read_files(TableReader& top, RawVolumeHead& head) {
  const auto name = top.text("file");
  const auto pattern = top.text("pattern");
  const auto first = top.integer("first", 0, kMostFileNumber);
  const auto last = top.integer("last", 0, kMostFileNumber);
  if (name.has_value() == pattern.has_value())
    return top.error("pattern", "the data are one file, or a file a slice", "write file, or pattern, first and last");
  if (name) {
    if (first || last) top.error("first", "first and last belong to a pattern");
    head.files = {*name};
    return;
  }
  if (!first || !last) {
    top.require("first");
    top.require("last");
    return;
  }
  auto names = names_of_pattern(*pattern, *first, *last, *last < *first ? -1 : 1);
  if (!names) return top.error("pattern", names.error().what, names.error().remedy);
  head.files = std::move(*names);
}

void read_raw_size(TableReader& top, RawVolumeHead& head) {
  top.require("size");
  const auto numbers = top.numbers("size", 3, {0.0, kMostVoxelsAlong});
  if (!numbers) return;
  std::array<std::uint64_t, 3> size{};
  for (std::size_t i = 0; i < 3; ++i) {
    size[i] = static_cast<std::uint64_t>((*numbers)[i]);
    if (static_cast<double>(size[i]) != (*numbers)[i]) return top.error("size", "the size is not three integers");
    head.format.size[i] = static_cast<std::uint32_t>(size[i]);
  }
  if (const auto fits = check_voxels(size, bytes_of(head.format.type)); !fits)
    return top.error("size", fits.error().what, fits.error().remedy);
  if (head.files.size() > 1 && head.files.size() != size[2]) {
    top.error("size", fmt::format("there are {} files for {} slices", head.files.size(), size[2]),
              "a pattern names a file a slice");
  }
}

void read_head(TableReader& top, RawVolumeHead& head) {
  static_cast<void>(top.text("description"));
  read_files(top, head);
  top.require("type");
  head.format.type =
      top.choice<VoxelType>("type", {{"u8", VoxelType::u8}, {"s16", VoxelType::s16}, {"u16", VoxelType::u16}})
          .value_or(VoxelType::u8);
  head.format.big_endian = top.choice<bool>("endian", {{"little", false}, {"big", true}}).value_or(false);
  head.gzip = top.choice<bool>("encoding", {{"raw", false}, {"gzip", true}}).value_or(false);
  head.header_bytes = static_cast<std::uint64_t>(top.integer("header_bytes", 0, kMostHeaderBytes).value_or(0));
  if (bytes_of(head.format.type) > 1) top.require("endian");
  read_raw_size(top, head);
  top.require("spacing_mm");
  if (const auto spacing = top.vector3("spacing_mm", kSpacingMm)) head.spacing_m = 1e-3 * *spacing;
  head.slope = top.number("slope", kSlope).value_or(1);
  if (head.slope == 0) top.error("slope", "the slope is 0");
  head.intercept = top.number("intercept").value_or(0);
  head.hounsfield = top.boolean("hounsfield").value_or(false);
  if (head.gzip && head.files.size() > 1)
    top.error("encoding", "several compressed files are not read", "put the slices into one file");
  if (head.gzip && head.header_bytes > 0)
    top.error("header_bytes", "compressed data with bytes before them are not read");
}

std::optional<VolumeData> read_raw(const fs::path& path, Diagnostics& diagnostics) {
  const std::string file = path.string();
  const auto text = text_of_file(path, kLargestRawHead, file, diagnostics);
  if (!text) return std::nullopt;
  const auto head = parse_raw_volume_head(*text, file, diagnostics);
  if (!head) return std::nullopt;
  auto volume = read_raw_volume(*head, path);
  if (!volume) {
    diagnostics.error({file, 0, 0}, volume.error().what, volume.error().remedy);
    return std::nullopt;
  }
  return std::move(*volume);
}

std::optional<VolumeData> read_any(const fs::path& path, const VolumeRequest& request, Diagnostics& diagnostics) {
  std::error_code error;
  if (fs::is_directory(path, error)) return read_dicom_series(path, request.series, diagnostics);
  const std::string extension = lower_case(path.extension().string());
  const bool nrrd = extension == ".nrrd" || extension == ".nhdr";
  if (!nrrd && extension != ".toml") {
    diagnostics.error({path.string(), 0, 0}, fmt::format("{} is no volume", printable(path.filename().string())),
                      "volumes are folders of DICOM slices, .nrrd and .nhdr files, and .toml heads of raw data");
    return std::nullopt;
  }
  if (!request.series.empty()) {
    diagnostics.error({path.string(), 0, 0}, "only folders of DICOM slices have series");
    return std::nullopt;
  }
  return nrrd ? read_nrrd(path, diagnostics) : read_raw(path, diagnostics);
}

}  // namespace

bool VolumeRequest::operator<(const VolumeRequest& other) const {
  return std::tie(series, hounsfield, name) < std::tie(other.series, other.hounsfield, other.name);
}

std::optional<RawVolumeHead> parse_raw_volume_head(std::string_view text, const std::string& file,
                                                   Diagnostics& diagnostics) {
  return parse_tables<RawVolumeHead>(text, file, diagnostics, read_head);
}

std::optional<VolumeData> read_volume(const fs::path& path, const VolumeRequest& request, Diagnostics& diagnostics) {
  auto volume = read_any(path, request, diagnostics);
  if (!volume) return std::nullopt;
  volume->grid.name = request.name;
  if (request.hounsfield) volume->grid.hounsfield = *request.hounsfield;
  return volume;
}

}  // namespace cellmirror
