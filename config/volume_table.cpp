#include "config/volume_table.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

namespace cellmirror {

namespace {

enum class VolumeOrigin { middle, corner, patient };

constexpr Range kFraction{0.0, 1.0};
constexpr Range kTableOpacity{0.0, kMostVolumeOpacity};
constexpr Range kTableGain{0.0, kMostVolumeGain};
constexpr Range kTableLevel{kLeastVolumeLevel, kMostVolumeLevel};
constexpr Range kTableWindow{0.0, kMostVolumeWindow};
constexpr Range kQuarterTurn{-std::numbers::pi / 2, std::numbers::pi / 2};
constexpr Range kVolumePlace{-1000.0, 1000.0};

template <std::size_t kCount>
std::optional<std::size_t> index_of_word(TableReader& table, std::string_view key,
                                         const std::array<std::string_view, kCount>& words) {
  const auto word = table.text(key);
  if (!word) return std::nullopt;
  const auto at = std::ranges::find(words, *word);
  if (at != words.end()) return static_cast<std::size_t>(at - words.begin());
  std::string known;
  for (const std::string_view one : words) known += (known.empty() ? "" : ", ") + std::string(one);
  table.error(key, std::string(key) + " is not one of its words", "write one of " + known);
  return std::nullopt;
}

void read_medical(TableReader& volume, MedicalTableParameters& medical) {
  auto table = volume.table("medical");
  if (!table) return;
  medical.air = table->number("air", kFraction).value_or(medical.air);
  medical.fat = table->number("fat", kFraction).value_or(medical.fat);
  medical.tissue = table->number("tissue", kFraction).value_or(medical.tissue);
  medical.bone = table->number("bone", kFraction).value_or(medical.bone);
  table->finish();
}

void read_parameters(TableReader& volume, VolumeSettings& settings) {
  std::set<std::size_t> known;
  for (TableReader& table : volume.tables("parameters", kVolumeTables)) {
    table.require("table");
    const auto which = index_of_word(table, "table", kVolumeTableWords);
    if (which == static_cast<std::size_t>(VolumeTable::medical))
      table.error("table", "MEDICAL_LUT has other parameters", "write medical = { air, fat, tissue, bone }");
    if (which && !known.insert(*which).second) table.error("table", "the table has parameters already");
    VolumeTableParameters parameters;
    parameters.opacity = table.number("opacity", kTableOpacity).value_or(parameters.opacity);
    parameters.gain = table.number("gain", kTableGain).value_or(parameters.gain);
    parameters.level = table.number("level", kTableLevel).value_or(parameters.level);
    parameters.window = table.number("window_rad", kTableWindow).value_or(parameters.window);
    table.finish();
    if (which) settings.parameters[*which] = parameters;
  }
}

void read_planes(TableReader& volume, VolumeSettings& settings) {
  std::set<std::size_t> known;
  for (TableReader& table : volume.tables("plane", kVolumePlanes)) {
    table.require("plane");
    const auto which = index_of_word(table, "plane", kVolumePlaneWords);
    if (which && !known.insert(*which).second) table.error("plane", "the plane is given already");
    VolumePlane plane;
    plane.side = table
                     .choice<VolumePlaneSide>("clip", {{"active", VolumePlaneSide::beyond},
                                                       {"reverse", VolumePlaneSide::before},
                                                       {"off", VolumePlaneSide::none}})
                     .value_or(plane.side);
    plane.framed = table.boolean("visible").value_or(plane.framed);
    plane.elevation_rad = table.number("elevation_rad", kQuarterTurn).value_or(plane.elevation_rad);
    plane.azimuth_rad = table.number("azimuth_rad", kQuarterTurn).value_or(plane.azimuth_rad);
    plane.distance_m = table.number("distance_m", kVolumePlace).value_or(plane.distance_m);
    table.finish();
    if (which) settings.planes[*which] = plane;
  }
}

VolumeSettings read_settings(TableReader& volume) {
  VolumeSettings settings;
  if (const auto table = index_of_word(volume, "table", kVolumeTableWords))
    settings.table = static_cast<VolumeTable>(*table);
  read_medical(volume, settings.medical);
  read_parameters(volume, settings);
  read_planes(volume, settings);
  if (const auto value = volume.number("isosurface")) {
    settings.isosurface = true;
    settings.iso_value = *value;
  }
  return settings;
}

// Frame V in the frame that `origin` names.
Pose pose_of_origin(TableReader& table, VolumeOrigin origin, const VolumeData& volume) {
  Pose X = Pose::Identity();
  if (origin == VolumeOrigin::corner) X.translation() = volume.grid.half_extent_m();
  if (origin == VolumeOrigin::patient) {
    if (volume.X_PV) return *volume.X_PV;
    table.error("origin", "the source has no coordinates of its own", "write origin = \"middle\" or \"corner\"");
  }
  return X;
}

}  // namespace

std::optional<ComponentVolume> read_volume_table(TableReader& component, const FileFinder& files,
                                                 Diagnostics& of_source) {
  auto table = component.table("volume");
  if (!table) return std::nullopt;
  ComponentVolume out;
  table->require("source");
  VolumeRequest request;
  request.source = table->text("source").value_or("");
  request.series = table->text("series").value_or("");
  request.hounsfield = table->boolean("hounsfield");
  request.name = std::filesystem::path(component.file()).stem().string();
  const auto origin = table
                          ->choice<VolumeOrigin>("origin", {{"middle", VolumeOrigin::middle},
                                                            {"corner", VolumeOrigin::corner},
                                                            {"patient", VolumeOrigin::patient}})
                          .value_or(VolumeOrigin::middle);
  const Eigen::Vector3d xyz = table->vector3("xyz_m", kVolumePlace).value_or(Eigen::Vector3d::Zero());
  const Pose X = pose_from_xyz_rpy(xyz, table->vector3("rpy_rad").value_or(Eigen::Vector3d::Zero()));
  out.settings = read_settings(*table);
  if (!request.source.empty()) {
    if (const auto volume = files.volume(request, table->place("source"), of_source);
        volume && volume->grid.count() > 0) {
      out.X_CV = X * pose_of_origin(*table, origin, *volume);
      out.grid = std::shared_ptr<const VoxelGrid>(volume, &volume->grid);
    }
  }
  table->finish();
  return out;
}

}  // namespace cellmirror
