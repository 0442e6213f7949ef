#include "app/volume_info/volume_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

namespace {

constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};

const char* type_text(const VoxelGrid& grid) {
  static constexpr std::array kNames{"8 bit unsigned", "16 bit signed", "16 bit unsigned"};
  return kNames.at(grid.values.index());
}

std::size_t bytes_of_grid(const VoxelGrid& grid) { return grid.count() * (grid.values.index() == 0 ? 1 : 2); }

const char* unit_text(const VoxelGrid& grid) { return grid.hounsfield ? " HU" : ""; }

std::string files_text(const VolumeFacts& facts) {
  if (facts.files.empty()) return "-";
  if (facts.files.size() == 1) return facts.files.front();
  return fmt::format("{}: {} ... {}", facts.files.size(), facts.files.front(), facts.files.back());
}

void add_row(std::string& out, const char* name, const std::string& value) {
  if (!value.empty()) out += fmt::format("{:<14}{}\n", name, value);
}

}  // namespace

std::string volume_text(const VolumeData& volume, const VolumeSummary& summary) {
  const VoxelGrid& grid = volume.grid;
  const VolumeFacts& facts = volume.facts;
  const Eigen::Vector3d spacing = 1e3 * grid.spacing_m;
  const Eigen::Vector3d extent = 2e3 * grid.half_extent_m();
  const char* unit = unit_text(grid);
  std::string out;
  add_row(out, "kind", facts.kind);
  add_row(out, "size", size_text(grid.size) + " voxels");
  add_row(out, "spacing", fmt::format("{:.6g} x {:.6g} x {:.6g} mm", spacing.x(), spacing.y(), spacing.z()));
  add_row(out, "extent", fmt::format("{:.5g} x {:.5g} x {:.5g} mm", extent.x(), extent.y(), extent.z()));
  add_row(out, "in the file", fmt::format("{}; {}", facts.stored, facts.encoding));
  add_row(out, "in memory",
          fmt::format("{}, {:.1f} MiB", type_text(grid), static_cast<double>(bytes_of_grid(grid)) / (1U << 20U)));
  add_row(out, "rescale", fmt::format("value = {:g} * stored {:+g}", grid.slope, grid.intercept));
  add_row(
      out, "values",
      fmt::format("{:g} to {:g}{}, mean {:.5g}; 1 % are below {:g}, half below {:g}, 99 % below {:g}", summary.least,
                  summary.most, unit, summary.mean, summary.percent_1, summary.percent_50, summary.percent_99));
  if (grid.hounsfield) {
    const MaterialShares shares = material_shares(grid, summary);
    add_row(out, "materials",
            fmt::format("air {:.1f} %, fat {:.1f} %, tissue {:.1f} %, bone {:.1f} % of the voxels", 100 * shares.air,
                        100 * shares.fat, 100 * shares.tissue, 100 * shares.bone));
  }
  add_row(out, "modality", facts.modality);
  add_row(out, "manufacturer", facts.manufacturer);
  add_row(out, "series", facts.series);
  add_row(out, "description", facts.series_description);
  add_row(out, "order", facts.order);
  add_row(out, "files", files_text(facts));
  if (volume.X_PV) {
    const Eigen::Vector3d middle = 1e3 * volume.X_PV->translation();
    add_row(
        out, "middle",
        fmt::format("({:.4g}, {:.4g}, {:.4g}) mm in the coordinates of the file", middle.x(), middle.y(), middle.z()));
  }
  return out;
}

std::string volume_json(const std::string& file, const VolumeData& volume, const VolumeSummary& summary,
                        const Diagnostics& diagnostics) {
  const VoxelGrid& grid = volume.grid;
  const VolumeFacts& facts = volume.facts;
  JsonWriter json;
  json.begin_object().member("file", file).member("kind", facts.kind);
  json.key("size").begin_array();
  for (const std::uint32_t along : grid.size) json.value(along);
  json.end_array().member("spacing_m", grid.spacing_m).member("bytes", bytes_of_grid(grid));
  json.member("stored", facts.stored).member("encoding", facts.encoding).member("type", type_text(grid));
  json.member("slope", grid.slope).member("intercept", grid.intercept).member("hounsfield", grid.hounsfield);
  json.key("values").begin_object();
  json.member("least", summary.least).member("most", summary.most).member("mean", summary.mean);
  json.member("percent_1", summary.percent_1).member("percent_50", summary.percent_50);
  json.member("percent_99", summary.percent_99).end_object();
  if (grid.hounsfield) {
    const MaterialShares shares = material_shares(grid, summary);
    json.key("materials").begin_object().member("air", shares.air).member("fat", shares.fat);
    json.member("tissue", shares.tissue).member("bone", shares.bone).end_object();
  }
  json.member("modality", facts.modality).member("manufacturer", facts.manufacturer);
  json.member("series", facts.series).member("series_description", facts.series_description);
  json.member("order", facts.order).key("files").value(std::span<const std::string>(facts.files));
  if (volume.X_PV) {
    json.key("X_PV").begin_object().member("xyz_m", Eigen::Vector3d(volume.X_PV->translation()));
    for (int axis = 0; axis < 3; ++axis)
      json.member(kAxisNames.at(static_cast<std::size_t>(axis)), Eigen::Vector3d(volume.X_PV->linear().col(axis)));
    json.end_object();
  }
  json.key("warnings").begin_array();
  for (const Diagnostic& diagnostic : diagnostics.all()) json.value(diagnostic.message);
  json.end_array().end_object();
  return json.take();
}

namespace {

plot::Panel slice_panel(const VoxelGrid& grid, std::size_t axis, const GreyWindow& window) {
  MiddleSlice slice = middle_slice(grid, axis, window);
  const Eigen::Vector3d half = 1e3 * grid.half_extent_m();
  const auto axis_of = [&](std::size_t i) {
    const double reach = half[static_cast<Eigen::Index>(i)];
    return plot::Axis{fmt::format("{} [mm]", kAxisNames.at(i)), false, -reach, reach};
  };
  plot::Panel panel;
  panel.title = fmt::format("slice {} of {} along {}", grid.size[axis] / 2 + 1, grid.size[axis], kAxisNames.at(axis));
  panel.x = axis_of(slice.across);
  panel.y = axis_of(slice.up);
  panel.image = {slice.width, slice.height, std::move(slice.grey)};
  return panel;
}

// Over the values that occur, in steps wide enough to be seen.
plot::Panel histogram_panel(const VoxelGrid& grid, const VolumeSummary& summary, const GreyWindow& window) {
  constexpr std::size_t kBins = 200;
  plot::Panel panel;
  panel.title = "voxels by value";
  panel.x.label = grid.hounsfield ? "value [HU]" : "value";
  panel.y = {"voxels", true};
  const double width = std::max(summary.most - summary.least, 1.0) / kBins;
  plot::Line line;
  line.x.assign(2 * kBins, 0);
  line.y.assign(2 * kBins, 0);
  for (std::size_t i = 0; i < summary.counts.size(); ++i) {
    if (summary.counts[i] == 0) continue;
    const double value = grid.slope * (static_cast<double>(i) + summary.first_stored) + grid.intercept;
    const auto bin = std::min(static_cast<std::size_t>(std::max((value - summary.least) / width, 0.0)), kBins - 1);
    line.y[2 * bin] += static_cast<double>(summary.counts[i]);
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    line.x[2 * bin] = summary.least + width * static_cast<double>(bin);
    line.x[2 * bin + 1] = line.x[2 * bin] + width;
    // No logarithm of nothing: a gap.
    if (line.y[2 * bin] == 0) line.y[2 * bin] = std::numeric_limits<double>::quiet_NaN();
    line.y[2 * bin + 1] = line.y[2 * bin];
  }
  panel.lines.push_back(std::move(line));
  panel.marks = {{window.middle - 0.5 * window.width, "black"}, {window.middle + 0.5 * window.width, "white"}};
  return panel;
}

}  // namespace

plot::Figure volume_figure(const std::string& file, const VolumeData& volume, const VolumeSummary& summary,
                           const GreyWindow& window) {
  const VoxelGrid& grid = volume.grid;
  plot::Figure figure;
  figure.title = fmt::format("{}: {}", file, volume.facts.kind);
  figure.subtitle = fmt::format("{} voxels of {:.4g} x {:.4g} x {:.4g} mm; window {:g} around {:g}{}",
                                size_text(grid.size), 1e3 * grid.spacing_m.x(), 1e3 * grid.spacing_m.y(),
                                1e3 * grid.spacing_m.z(), window.width, window.middle, unit_text(grid));
  figure.panel_width = 620;
  figure.panel_height = 560;
  for (const std::size_t axis : {2U, 1U, 0U}) figure.panels.push_back(slice_panel(grid, axis, window));
  figure.panels.push_back(histogram_panel(grid, summary, window));
  return figure;
}

}  // namespace cellmirror::app
