#include "config/volume/nrrd_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/volume/data_files.hpp"
#include "config/volume/nrrd_head.hpp"
#include "config/volume/voxel_stream.hpp"
#include "config/volume/voxel_values.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

// The bytes of the first `lines` lines from `offset` on.
Result<std::uint64_t> bytes_of_lines(const fs::path& path, std::uint64_t offset, std::uint32_t lines) {
  constexpr std::size_t kAtOnce = std::size_t{64} << 10U;
  std::uint64_t bytes = 0;
  while (lines > 0) {
    const auto part = read_part_of_file(path, offset + bytes, kAtOnce);
    if (!part) return std::unexpected(part.error());
    if (part->empty()) return fail("\"line skip\" is beyond the end of the data file");
    std::size_t at = 0;
    while (lines > 0 && at < part->size()) {
      const std::size_t end = part->find('\n', at);
      if (end == std::string::npos) {
        at = part->size();
      } else {
        at = end + 1;
        --lines;
      }
    }
    bytes += at;
  }
  return bytes;
}

Result<VoxelSource> source_of(const NrrdHead& head, const fs::path& path) {
  VoxelSource source;
  source.gzip = head.gzip;
  source.at_end = head.at_end;
  source.skip_bytes = head.skip_bytes;
  if (head.data_files.empty()) {
    source.files = {path};
    source.skip_bytes += head.data_offset;
  }
  for (const std::string& name : head.data_files) {
    auto file = file_beside(path, name);
    if (!file) return std::unexpected(file.error());
    source.files.push_back(std::move(*file));
  }
  if (head.skip_lines > 0) {
    const auto bytes =
        bytes_of_lines(source.files.front(), head.data_files.empty() ? head.data_offset : 0, head.skip_lines);
    if (!bytes) return std::unexpected(bytes.error());
    source.skip_bytes += *bytes;
  }
  return source;
}

}  // namespace

std::optional<VolumeData> read_nrrd(const fs::path& path, Diagnostics& diagnostics) {
  const std::string file = path.string();
  const auto refuse = [&](const Error& error) {
    diagnostics.error({file, 0, 0}, error.what, error.remedy);
    return std::nullopt;
  };
  const auto text = read_part_of_file(path, 0, kLargestNrrdHead);
  if (!text) return refuse(text.error());
  const auto head = parse_nrrd_head(*text, file, diagnostics);
  if (!head) return std::nullopt;
  const auto source = source_of(*head, path);
  if (!source) return refuse(source.error());
  auto values = read_voxels(*source, head->format);
  if (!values) return refuse(values.error());
  VolumeData out;
  out.grid.size = head->format.size;
  out.grid.spacing_m = head->spacing_m;
  out.grid.values = std::move(values->values);
  out.grid.slope = values->slope;
  out.grid.intercept = values->intercept;
  out.X_PV = head->X_PV;
  out.facts.kind = "NRRD";
  out.facts.encoding = head->gzip ? "gzip" : "raw";
  out.facts.stored = text_of(head->format.type);
  if (bytes_of(head->format.type) > 1) out.facts.stored += head->format.big_endian ? ", big endian" : ", little endian";
  out.facts.order =
      head->format.last_slice_first ? "the last slice of the file first: its axes are left-handed" : "as in the file";
  for (const fs::path& data : source->files) out.facts.files.push_back(data.filename().string());
  if (values->rounded) {
    diagnostics.warning({file, 0, 0},
                        fmt::format("values of {} are rounded to steps of {:g}", out.facts.stored, values->slope));
  }
  return out;
}

}  // namespace cellmirror
