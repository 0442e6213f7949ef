#include "config/volume/raw_file.hpp"

#include <utility>

#include "config/volume/data_files.hpp"
#include "config/volume/voxel_stream.hpp"

namespace cellmirror {

Result<VolumeData> read_raw_volume(const RawVolumeHead& head, const std::filesystem::path& head_file) {
  VoxelSource source;
  source.skip_bytes = head.header_bytes;
  source.gzip = head.gzip;
  VolumeData out;
  for (const std::string& name : head.files) {
    auto file = file_beside(head_file, name);
    if (!file) return std::unexpected(file.error());
    source.files.push_back(std::move(*file));
    out.facts.files.push_back(name);
  }
  auto values = read_voxels(source, head.format);
  if (!values) return std::unexpected(values.error());
  out.grid.size = head.format.size;
  out.grid.spacing_m = head.spacing_m;
  out.grid.values = std::move(values->values);
  out.grid.slope = head.slope;
  out.grid.intercept = head.intercept;
  out.grid.hounsfield = head.hounsfield;
  out.facts.kind = "raw";
  out.facts.encoding = head.gzip ? "gzip" : "raw";
  out.facts.stored = text_of(head.format.type);
  if (bytes_of(head.format.type) > 1) out.facts.stored += head.format.big_endian ? ", big endian" : ", little endian";
  out.facts.order = head.files.size() > 1 ? "as the files are numbered" : "as in the file";
  return out;
}

}  // namespace cellmirror
