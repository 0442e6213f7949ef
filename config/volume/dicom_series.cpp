#include "config/volume/dicom_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "config/volume/dicom_files.hpp"
#include "config/volume/dicom_geometry.hpp"
#include "config/volume/dicom_slices.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

struct NamedSyntax {
  std::string_view uid;
  std::string_view name;
};
constexpr std::array kSyntaxes{NamedSyntax{"1.2.840.10008.1.2", "implicit little endian"},
                               NamedSyntax{"1.2.840.10008.1.2.1", "explicit little endian"},
                               NamedSyntax{"1.2.840.10008.1.2.1.99", "deflated explicit little endian"},
                               NamedSyntax{"1.2.840.10008.1.2.2", "explicit big endian"},
                               NamedSyntax{"1.2.840.10008.1.2.4.50", "JPEG baseline"},
                               NamedSyntax{"1.2.840.10008.1.2.4.51", "JPEG extended"},
                               NamedSyntax{"1.2.840.10008.1.2.4.57", "JPEG lossless"},
                               NamedSyntax{"1.2.840.10008.1.2.4.70", "JPEG lossless, first-order prediction"},
                               NamedSyntax{"1.2.840.10008.1.2.4.80", "JPEG-LS lossless"},
                               NamedSyntax{"1.2.840.10008.1.2.4.81", "JPEG-LS"},
                               NamedSyntax{"1.2.840.10008.1.2.4.90", "JPEG 2000 lossless"},
                               NamedSyntax{"1.2.840.10008.1.2.4.91", "JPEG 2000"},
                               NamedSyntax{"1.2.840.10008.1.2.5", "RLE"}};

std::string syntax_text(std::string_view uid) {
  const auto* const known = std::ranges::find(kSyntaxes, uid, &NamedSyntax::uid);
  return known == kSyntaxes.end() ? printable(uid) : fmt::format("{} ({})", known->name, uid);
}

// What cannot be a slice of a volume of scalars. Empty: it can.
Error why_unfit(const SliceHead& head) {
  if (head.frames > 1) return {fmt::format("it has {} frames", head.frames), "export the series as single-frame files"};
  if (head.samples != 1 || !head.photometric.starts_with("MONOCHROME"))
    return {fmt::format("its pixels are {}", printable(head.photometric)), "export it in shades of grey"};
  if (head.bits_allocated != 8 && head.bits_allocated != 16)
    return {fmt::format("its pixels have {} bits", head.bits_allocated), "export it with 8 or 16 bits"};
  if (head.bits_stored < 1 || head.bits_stored > head.bits_allocated)
    return {fmt::format("its pixels store {} of {} bits", head.bits_stored, head.bits_allocated), {}};
  if (!head.position || !head.orientation)
    return {"it has no position and orientation in the patient", "export the original slices"};
  if (!head.spacing) return {"it has no pixel spacing", "export the original slices"};
  return {};
}

bool check_slices(const std::vector<SliceFile>& files, Diagnostics& diagnostics) {
  const auto refuse = [&](const SliceFile& file, const std::string& what, const std::string& remedy) {
    diagnostics.error({}, fmt::format("{}: {}", file.name, what), remedy);
    return false;
  };
  const SliceHead& first = files.front().head;
  for (const SliceFile& file : files) {
    const SliceHead& head = file.head;
    if (const Error why = why_unfit(head); !why.what.empty()) return refuse(file, why.what, why.remedy);
    if (head.columns != first.columns || head.rows != first.rows)
      return refuse(file,
                    fmt::format("it has {} x {} pixels, {} has {} x {}", head.columns, head.rows, files.front().name,
                                first.columns, first.rows),
                    "keep slices of one size in the folder");
    if (head.bits_allocated != first.bits_allocated || head.is_signed != first.is_signed)
      return refuse(file, fmt::format("its pixels have another type than those of {}", files.front().name), {});
  }
  return true;
}

SlicePlace place_of(const SliceFile& file) {
  const auto& position = *file.head.position;
  const auto& direction = *file.head.orientation;
  SlicePlace out;
  out.file = file.name;
  out.position = {position[0], position[1], position[2]};
  out.row = {direction[0], direction[1], direction[2]};
  out.column = {direction[3], direction[4], direction[5]};
  out.row_spacing = (*file.head.spacing)[0];
  out.column_spacing = (*file.head.spacing)[1];
  return out;
}

std::string joined(const std::set<std::string>& all) {
  std::string out;
  for (const std::string& one : all) out += (out.empty() ? "" : ", ") + one;
  return out;
}

VolumeFacts facts_of(const std::vector<SliceFile>& files, const SeriesGeometry& geometry) {
  const SliceHead& first = files[geometry.order.front()].head;
  VolumeFacts facts;
  facts.kind = "DICOM series";
  std::set<std::string> syntaxes;
  for (const SliceFile& file : files) syntaxes.insert(syntax_text(file.head.transfer_syntax));
  facts.encoding = joined(syntaxes);
  facts.stored =
      fmt::format("{} of {} bit {}", first.bits_stored, first.bits_allocated, first.is_signed ? "signed" : "unsigned");
  facts.modality = printable(first.modality);
  facts.manufacturer = printable(first.manufacturer);
  if (!first.model.empty()) facts.manufacturer += (facts.manufacturer.empty() ? "" : ", ") + printable(first.model);
  facts.series = printable(first.series);
  facts.series_description = printable(first.description);
  const Eigen::Vector3d normal = geometry.X_PV.linear().col(2);
  facts.order =
      fmt::format("by position along the normal ({:.3f}, {:.3f}, {:.3f})", normal.x(), normal.y(), normal.z());
  for (const std::size_t i : geometry.order) facts.files.push_back(files[i].name);
  return facts;
}

// The volume that holds all slices of a tilted gantry has another middle.
Pose pose_with_shear(const SeriesGeometry& geometry) {
  const ShearedExtent extent = sheared_extent(geometry);
  Pose X = geometry.X_PV;
  for (int axis = 0; axis < 2; ++axis) {
    const double pixels = extent.first[axis] + 0.5 * extent.more[static_cast<std::size_t>(axis)];
    X.translation() += X.linear().col(axis) * pixels * geometry.spacing_m[axis];
  }
  return X;
}

}  // namespace

std::optional<VolumeData> read_dicom_series(const std::filesystem::path& folder, const std::string& series,
                                            Diagnostics& diagnostics, const VolumeReader& reader) {
  VolumeProcess process(reader);
  const std::vector<SliceFile> files = find_series(folder, series, process, diagnostics);
  if (files.empty() || !check_slices(files, diagnostics)) return std::nullopt;
  std::vector<SlicePlace> places;
  places.reserve(files.size());
  for (const SliceFile& file : files) places.push_back(place_of(file));
  SeriesGeometry geometry;
  const SliceHead& first = files.front().head;
  if (!find_series_geometry(places, first.columns, first.rows, geometry, diagnostics)) return std::nullopt;
  if (!geometry.shear.empty()) {
    diagnostics.warning({}, fmt::format("the gantry was tilted by {:.1f} degrees: slices are moved to their places",
                                        geometry.tilt_rad * 180 / std::numbers::pi));
  }
  if (first.photometric == "MONOCHROME1")
    diagnostics.warning({}, "MONOCHROME1: low values are meant to be shown bright; the values stay as they are");
  VolumeData out;
  if (!read_slices(files, geometry, process, out.grid, diagnostics)) return std::nullopt;
  out.grid.spacing_m = geometry.spacing_m;
  const bool all_rescaled = std::ranges::all_of(files, [](const SliceFile& file) {
    return file.head.rescaled && (file.head.rescale_type.empty() || file.head.rescale_type == "HU");
  });
  out.grid.hounsfield = first.modality == "CT" && all_rescaled;
  out.facts = facts_of(files, geometry);
  out.X_PV = pose_with_shear(geometry);
  return out;
}

}  // namespace cellmirror
