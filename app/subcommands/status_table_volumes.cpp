#include "app/subcommands/status_table_volumes.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/subcommands/status_words.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr double kBytesPerMiB = 1024.0 * 1024.0;

double volume_number(const json& value) { return value.get<double>(); }

std::string volume_head(const json& volume) {
  const json& voxels = volume.at("voxels");
  const json& spacing = volume.at("spacing_m");
  std::string out =
      fmt::format("\nvolume {}: {} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm, {:.0f} MiB",
                  text(volume.at("name")), count(voxels.at(0)), count(voxels.at(1)), count(voxels.at(2)),
                  mm_from_m(volume_number(spacing.at(0))), mm_from_m(volume_number(spacing.at(1))),
                  mm_from_m(volume_number(spacing.at(2))), volume_number(volume.at("bytes")) / kBytesPerMiB);
  if (const json& values = volume.at("values"); values.is_array())
    out += fmt::format(", {:g} to {:g}{}", volume_number(values.at(0)), volume_number(values.at(1)),
                       volume.at("hounsfield").get<bool>() ? " HU" : "");
  if (!volume.at("shown").get<bool>()) out += ", hidden";
  return out + "\n";
}

std::string table_line(const json& volume) {
  const std::string table = text(volume.at("table"));
  std::string out = "  " + table;
  for (const auto& [name, value] : volume.at("parameters").at(table).items())
    out += fmt::format(" {} {:g}", name, volume_number(value));
  if (volume.at("isosurface").get<bool>())
    out += fmt::format("; isosurface at {:g}", volume_number(volume.at("iso_value")));
  return out + "\n";
}

// A plane that is off is not worth a line.
std::string plane_line(const json& plane) {
  const std::string side = text(plane.at("side"));
  const bool framed = plane.at("framed").get<bool>();
  if (side == "off" && !framed) return {};
  const std::string mode = side == "off" ? "visible" : side + (framed ? ", visible" : "");
  return fmt::format("  {} {}: ELE {:g} AZI {:g} DIST {:g} mm\n", text(plane.at("plane")), mode,
                     deg_from_rad(volume_number(plane.at("elevation_rad"))),
                     deg_from_rad(volume_number(plane.at("azimuth_rad"))),
                     mm_from_m(volume_number(plane.at("distance_m"))));
}

}  // namespace

std::string volumes_table(const json& status) {
  std::string out;
  if (!status.contains("volumes")) return out;
  for (const json& volume : status.at("volumes")) {
    out += volume_head(volume) + table_line(volume);
    for (const json& plane : volume.at("planes")) out += plane_line(plane);
  }
  return out;
}

}  // namespace cellmirror::app
